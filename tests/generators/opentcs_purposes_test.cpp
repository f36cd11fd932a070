// What the words of a plant model say about its points, and the words that a user adds.
#include "generators/formats/opentcs_purposes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "generators/formats/opentcs.hpp"

namespace fleetproof::opentcs_purposes_test {
namespace {

struct Case {
  const char* name;
  const char* operations;  // a list of <allowedOperation>
  const char* symbol;
  const char* purposes;
  const char* sentence;  // "" for none
};

// Types of locations as real models have them.
const Case kCases[] = {
    {"PACK", "<allowedOperation name='LOAD'/><allowedOperation name='NOP'/><allowedOperation name='UNLOAD'/>",
     "LOAD_TRANSFER_GENERIC", "routing storage", ""},
    {"\u5145\u7535", "<allowedOperation name='CHARGE'/>", "", "routing charging", ""},
    {"26", "<allowedOperation name='Unload cargo'/>", "", "routing storage", ""},
    {"27", "<allowedOperation name='CHARGING'/>", "", "routing charging", ""},
    {"park", "<allowedOperation name='load'/>", "", "routing storage",
     "m.xml:4: the name of location type \"park\" says something else than its operations, which count"},
    {"28", "<allowedOperation name='load'/>", "RECHARGE_GENERIC", "routing storage",
     "m.xml:4: the symbol of location type \"28\" says something else than its operations, which count"},
    {"both", "<allowedOperation name='LOAD'/><allowedOperation name='Charge:50'/>", "", "routing storage charging", ""},
    {"Working station", "<allowedOperation name='Drill'/>", "RECHARGE_GENERIC", "routing storage",
     "m.xml:4: the operations of location type \"Working station\" say nothing that is known here; by its name it is "
     "taken to be for storage"},
    {"S7", "<allowedOperation name='NOP'/>", "RECHARGE_GENERIC", "routing charging",
     "m.xml:4: the operations of location type \"S7\" say nothing that is known here; by its symbol it is taken to be "
     "for charging"},
    {"Fire door", "", "NONE", "routing",
     "m.xml:4: location type \"Fire door\" says nothing that is known here; its points keep their purposes, unless you "
     "name one (--purposes \"Fire door=storage\")"},
    {"LoadingDock", "", "NONE", "routing storage",
     "m.xml:4: the operations of location type \"LoadingDock\" say nothing that is known here; by its name it is taken "
     "to "
     "be for storage"},
    {"29", "<allowedOperation name='unloadPallet'/><allowedOperation name='recharge2'/>", "",
     "routing storage charging", ""},
    {"30", "<allowedOperation name='AGVLoad'/><allowedOperation name='StationNo3Charge'/>", "",
     "routing storage charging", ""},
    {"31", "<allowedOperation name='Offload'/>", "", "routing storage", ""},
    {"32", "<allowedOperation name='Reload'/>", "", "routing storage", ""},
    {"Network check", "<allowedOperation name='DOWNLOAD_MAP'/><allowedOperation name='NO_LOAD_HERE'/>", "", "routing",
     "m.xml:4: location type \"Network check\" says nothing that is known here; its points keep their purposes, unless "
     "you name one (--purposes \"Network check=storage\")"},
};

struct Import {
  std::string purposes;  // of point a
  std::vector<std::string> warnings;
};

Import import(const Case& c, const std::string& link = "", const ReadChoice& choice = {}) {
  const auto text = fmt::format(
      "<model version='0.0.3' name='m'>\n<point name='a' xPosition='0' yPosition='0'/><point name='b' xPosition='9000' "
      "yPosition='0'/>\n<path name='ab' sourcePoint='a' destinationPoint='b' length='9000' "
      "maxVelocity='1000'/>\n<locationType "
      "name='{}'>{}<property name='tcs:defaultLocationTypeSymbol' value='{}'/></locationType>\n<location name='L' "
      "type='{}'><link point='a'>{}</link></location></model>",
      c.name, c.operations, c.symbol, c.name, link);
  Import result;
  result.purposes = purposes_text(parse_opentcs(text, "m.xml", result.warnings, choice).stations[0].purposes);
  std::erase_if(result.warnings, [](const std::string& w) {
    return w.find("stand beside") != std::string::npos || w.find("operations say nothing") != std::string::npos;
  });
  return result;
}

TEST(OpenTcsPurposes, FollowFromOperationsThenNamesThenSymbols) {
  for (const auto& c : kCases) {
    const auto [purposes, warnings] = import(c);
    EXPECT_EQ(purposes, c.purposes) << c.name;
    EXPECT_EQ(warnings, *c.sentence == 0 ? std::vector<std::string>{} : std::vector<std::string>{c.sentence});
  }
}

TEST(OpenTcsPurposes, ALinkMayAllowLess) {
  const Case& both = kCases[6];
  EXPECT_EQ(import(both, "<allowedOperation name='LOAD'/>").purposes, "routing storage");
  EXPECT_EQ(import(both, "<allowedOperation name='Charge:50'/>").purposes, "routing charging");
  const auto other = import(kCases[0], "<allowedOperation name='NOP'/>");
  EXPECT_EQ(other.purposes, "routing") << "the symbol of the type says nothing of this link";
  ASSERT_EQ(other.warnings.size(), 1U);
  EXPECT_NE(other.warnings[0].find("links of 1 locations allow no operation that is known here (\"L\")"),
            std::string::npos)
      << other.warnings[0];
  ReadChoice confirmed;
  confirmed.purposes = purpose_words_of("LOAD=storage", "--purposes");
  EXPECT_EQ(import(kCases[0], "<allowedOperation name='NOP'/>", confirmed).purposes, "routing");
}

TEST(OpenTcsPurposes, PackagesAndWorkersSayNothing) {
  for (const char* operation : {"PACKAGE_SCAN", "WORKER_SAFETY_CHECK", "Packet:1"}) {
    const auto list = fmt::format("<allowedOperation name='{}'/>", operation);
    EXPECT_EQ(import({"7", list.c_str(), "", "", ""}).purposes, "routing") << operation;
  }
  EXPECT_EQ(import({"7", "<allowedOperation name='Packing:1'/>", "", "", ""}).purposes, "routing storage");
}

TEST(OpenTcsPurposes, WordsOfTheUserComeFirst) {
  const auto with = [](const Case& c, const char* words) {
    ReadChoice choice;
    choice.purposes = purpose_words_of(words, "--purposes");
    return import(c, "", choice);
  };
  EXPECT_EQ(with(kCases[9], "fire DOOR=storage parking").purposes, "routing storage parking");
  EXPECT_TRUE(with(kCases[9], "fire DOOR=routing").warnings.empty()) << "the user says that nothing is done there";
  EXPECT_EQ(with(kCases[1], "\u5145\u7535=parking").purposes, "routing parking");
  EXPECT_EQ(with(kCases[0], "UNLOAD=charging,NOP=parking").purposes, "routing storage charging parking")
      << "the other operation is LOAD";
  EXPECT_EQ(with(kCases[0], "LOAD=routing,UNLOAD=charging").purposes, "routing charging");
  EXPECT_EQ(with(kCases[0], "LOAD_TRANSFER_GENERIC=parking").purposes, "routing parking");
  EXPECT_EQ(with({"Dock, left", "", "", "", ""}, "Dock, left=storage").purposes, "routing storage");
  EXPECT_EQ(with({"Dock, left", "", "", "", ""}, "7=parking,Dock, left=storage").purposes, "routing storage");
  EXPECT_EQ(with({"8", "<allowedOperation name='op=2'/>", "", "", ""}, "op=2=charging").purposes, "routing charging");
  EXPECT_EQ(with(kCases[0], "PAC=parking,oad=parking").purposes, "routing storage") << "a word is the whole name";
}

std::string refusal(const std::string& words) {
  try {
    purpose_words_of(words, "--purposes");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(OpenTcsPurposes, WordsWithoutSenseAreRefused) {
  EXPECT_EQ(refusal(""), "accepted");
  EXPECT_EQ(refusal("a=storage,b=charging parking"), "accepted");
  EXPECT_EQ(refusal("PACK"), "--purposes: \"PACK\" is not a word with its purpose; expected \"PACK=storage,...\"");
  EXPECT_EQ(refusal("a=storage,,b=parking").substr(0, 25), "--purposes: \"\" is not a w");
  EXPECT_EQ(refusal("=storage").substr(0, 33), "--purposes: \"=storage\" is not a w");
  EXPECT_EQ(
      refusal("PACK=storag"),
      "--purposes: \"PACK\" is said to be for \"storag\"; expected routing, storage, charging or parking; did you "
      "mean \"storage\"?");
  EXPECT_NE(refusal("PACK="), "accepted");
}

}  // namespace
}  // namespace fleetproof::opentcs_purposes_test
