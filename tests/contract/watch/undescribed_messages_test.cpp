// Software that does not describe its messages: traces and pages name a message by its size, never by its bytes, and
// say how to describe it.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::undescribed_messages_test {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kWorld = R"({"version": 1, "name": "plain", "horizon_s": 20,
    "vehicle_types": [{"name": "cart", "length_m": 1.6, "width_m": 1}],
    "agvs": [{"name": "M", "start": "a", "heading": [1, 0]}, {"name": "P", "start": "b", "heading": [1, 0]}],
    "layout": {"name": "road", "floor_low_m": [-3, -3], "floor_high_m": [20, 20],
      "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [9, 0]}],
      "segments": [{"name": "ab", "from": "a", "to": "b"}, {"name": "ba", "from": "b", "to": "a"}]}})";
// Each begins with a number of its own.
constexpr const char* kCalls =
    "0 1000 plain ask;0 2000 plain ask;0 3000 plain ask;1 1500 plain answer;1 2500 plain answer;1 4000 all GRANT";
// Each AGV sends with the whole second, and the server each half.
constexpr const char* kProgram = R"(import fleetproof
from fleetproof import Master

class Server(Master):
    tick_s = 0.5
    sent = 0
    def on_tick(self) -> None:
        for vehicle in self.vehicles:
            self.sent += 1
            self.computer.send(self.sent.to_bytes(8, "little") + b"go on", vehicle)

async def drive(agv) -> None:
    sent = 0
    while True:
        await agv.sleep(1.0)
        sent += 1
        agv.send(sent.to_bytes(8, "little") + b"here I am", len(agv.world.fleet))

fleetproof.serve("plain", vehicle=drive, computer=Server)
)";

class UndescribedMessages : public test::ProgramTest {
 protected:
  test::Finished talk(const std::string& words) const {
    write("talk.json", kWorld);
    return run("simulate talk.json --agent talker --plugin '" + std::string(FLEETPROOF_TALKING_AGENT) +
               "' --agent-config '" + kCalls + "' " + words);
  }
  // The kinds of messages in the data of the page, and the part about those that are not described.
  struct Page {
    std::set<std::string> kinds;
    std::string undescribed, all;
  };
  Page page_of(const std::string& file) const {
    Page page;
    page.all = read(path(file));
    pugi::xml_document document;
    EXPECT_TRUE(document.load_buffer(page.all.data(), page.all.size(), pugi::parse_full));
    const Json film = Json::parse(document.select_node("//script[@id='film']").node().text().get());
    for (const Json& message : film["messages_ms"])
      page.kinds.insert(film["words"][message[4].get<std::size_t>()].get<std::string>());
    for (const auto& found : document.select_nodes("//div[@id='undescribed']//text()"))
      page.undescribed += found.node().value();
    return page;
  }
};

TEST_F(UndescribedMessages, OfAPluginHaveTheirSizeForAKindInTraces) {
  ASSERT_TRUE(test::has_verdict(talk("--trace-output t.jsonl --trace-format json")));
  std::multiset<std::string> sent;
  std::istringstream lines(read(path("t.jsonl")));
  for (std::string line; std::getline(lines, line);) {
    const Json event = Json::parse(line);
    if (event["event"] != "sent") continue;
    sent.insert(event["message"]["kind"].get<std::string>());
    EXPECT_EQ(event["message"]["described"], event["message"]["kind"] == "GRANT");
    EXPECT_EQ(event["message"]["content"], nullptr);
  }
  EXPECT_THAT(sent, ElementsAre("10 bytes", "10 bytes", "7 bytes", "7 bytes", "7 bytes", "GRANT"));
  const std::string text = talk("--trace").err;
  EXPECT_THAT(text, HasSubstr("#1 7 bytes, 0x0000000061736b to all"));
  const std::string how = "host->describe(controller, \"GRANT: lane 3\")";
  ASSERT_THAT(text, HasSubstr(how));
  EXPECT_EQ(text.find(how), text.rfind(how)) << "once";
  EXPECT_THAT(talk("--trace --trace-kind sent --trace-from 3.5").err, Not(HasSubstr(how))) << "all are described";
}

TEST_F(UndescribedMessages, OfAPluginAreFewKindsOfAPageThatSaysHowToDescribeThem) {
  ASSERT_TRUE(test::has_verdict(talk("--html p.html")));
  const Page page = page_of("p.html");
  EXPECT_THAT(page.kinds, ElementsAre("10 bytes", "7 bytes", "GRANT"));
  EXPECT_THAT(page.all, Not(HasSubstr("0x0000")));
  EXPECT_THAT(page.undescribed, HasSubstr("The messages of M and P are not described"));
  EXPECT_THAT(page.undescribed, HasSubstr("(10 bytes and 7 bytes)"));
  for (const char* call : {"host->describe(controller, ", "[\"describe\", ", "agv.describe("})
    EXPECT_THAT(page.undescribed, HasSubstr(call));
}

TEST_F(UndescribedMessages, OfALockstepFleetAreFewKindsToo) {
  write("plain.py", kProgram);
  write("c.toml", "kind = \"search\"\nreplicates = 1\nhorizon_s = 10\n[factors]\nagents = [{ name = \"plain\", " +
                      std::string("vehicle = PROGRAM, computer = PROGRAM }]\nlayouts = [\"random-planar\"]\n") +
                      "fleet_sizes = [2]\n[[computers]]\nname = \"server\"\n");
  std::string campaign = read(path("c.toml"));
  const std::string program =
      "{ run = \"env 'PYTHONPATH=" + test::source("core/sdk/python") + "' python3 -B plain.py\", way = \"lockstep\" }";
  for (auto at = campaign.find("PROGRAM"); at != std::string::npos; at = campaign.find("PROGRAM"))
    campaign.replace(at, 7, program);
  write("c.toml", campaign);
  const auto finished = run("run c.toml --db c.db --jobs 1");
  ASSERT_TRUE(test::has_verdict(finished)) << finished.err;
  ASSERT_EQ(run("replay c.db 0 --html p.html").exit_code, 0);
  const Page page = page_of("p.html");
  EXPECT_THAT(page.kinds, ElementsAre("13 bytes", "17 bytes"));
  EXPECT_THAT(page.undescribed, HasSubstr("and server are not described"));
}

TEST_F(UndescribedMessages, AreNotMentionedWhereThereAreNone) {
  ASSERT_TRUE(test::has_verdict(
      run("simulate '" + test::source("tests/scenarios/figure4.json") + "' --agent hull-lock --trace --html p.html")));
  EXPECT_EQ(page_of("p.html").undescribed, "");
}

}  // namespace
}  // namespace fleetproof::undescribed_messages_test
