// The verb `import`, and layout files of other programs in campaigns.
#include <gmock/gmock.h>

#include "generators/formats/layout_file.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::import_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ImportTest : public test::ProgramTest {};

// LIF has no place for blocks.
std::string without_blocks(const std::string& text) {
  Layout layout = parse_layout(text, "l.json");
  layout.blocks.clear();
  for (Segment& segment : layout.segments) segment.blocks.clear();
  return to_text(layout);
}

const std::string kCrossdock = "'" + test::source("tests/layouts/crossdock.xml") + "'";

TEST_F(ImportTest, WritesLayoutsLifAndCsv) {
  EXPECT_EQ(run("import opentcs " + kCrossdock + " -o plain.json").exit_code, 0);
  const auto merged = run("import opentcs " + kCrossdock + " -o merged.json");
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(merged.out, "");
  EXPECT_THAT(merged.err,
              HasSubstr("12 pairs of one-way segments there and back on one track became two-way segments ("));
  EXPECT_EQ(run("import layout merged.json -o merged.lif.json").exit_code, 0);
  EXPECT_EQ(run("import lif merged.lif.json -o again.json").exit_code, 0);
  EXPECT_EQ(read(path("again.json")), without_blocks(read(path("merged.json"))));
  EXPECT_EQ(run("import lif merged.lif.json -o merged.csv").exit_code, 0);
  EXPECT_THAT(read(path("merged.csv")), StartsWith("layout\nSmall cross-dock\nid,x,y,purposes\n"));
  EXPECT_EQ(run("import lif merged.lif.json").out, without_blocks(read(path("merged.json"))))
      << "without -o the layout goes to standard output";
}

TEST_F(ImportTest, DrawsWhatItRead) {
  const auto finished = run("import opentcs " + kCrossdock + " -o plain.json --svg plain.svg");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(read(path("plain.svg")), StartsWith("<svg "));
  EXPECT_THAT(run("import opentcs " + kCrossdock + " --svg no/where.svg").err,
              HasSubstr("no/where.svg: cannot be written (No such file or directory); choose another path for --svg"));
}

// The picture of the layout inside a scenario file is that of the same layout in a file of its own.
TEST_F(ImportTest, DrawsTheLayoutOfAScenario) {
  const std::string figure4 = "'" + test::source("tests/scenarios/figure4.json") + "'";
  const auto finished = run("import " + figure4 + " --svg a.svg -o layout.json");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("figure4.json: 10 stations, 12 segments, 0 warnings"));
  EXPECT_THAT(read(path("a.svg")), HasSubstr(">Fig. 4: 10 stations, 12 segments</text>"));
  EXPECT_EQ(run("import scenario " + figure4 + " --svg b.svg").out, read(path("layout.json")));
  ASSERT_EQ(run("import layout.json --svg c.svg").exit_code, 0);
  EXPECT_EQ(read(path("a.svg")), read(path("b.svg")));
  EXPECT_EQ(read(path("a.svg")), read(path("c.svg")));
  write("poor.json", R"({"agvs": [], "layout": {"name": "x", "stations": []}})");
  EXPECT_THAT(run("import poor.json --svg d.svg").err, HasSubstr("poor.json:1"));
  EXPECT_FALSE(std::filesystem::exists(path("d.svg")));
  EXPECT_THAT(run("import opentcs").err, HasSubstr("FILE: is missing; name the file after \"opentcs\""));
  EXPECT_THAT(run("import plant.dwg").err, HasSubstr("plant.dwg: has no extension of a layout file"));
}

TEST_F(ImportTest, TellsWhatItGuessed) {
  write("m.map", "height 1\nwidth 3\nmap\n.S.\n");
  const auto finished = run("import grid m.map --cell-pitch 1.5");
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(
      finished.err,
      "warning: m.map: cells are taken to be 1.5 m apart; the map names no charging and no parking\n"
      "warning: m.map: cells S and E are taken for storage, as in maps of the League of Robot Runners; in maps of "
      "terrain, S is swamp\n"
      "m.map: 3 stations, 2 segments, 2 warnings\n"
      "size: 3 m x 0 m; segments of 1.5 m to 1.5 m, half of them up to 1.5 m, 3 m in all\n"
      "purposes: 1 storage, 0 charging, 0 parking\n"
      "reachability: all 3 stations can reach each other\n");
}

// b can be reached from a and back; nobody comes back from the warehouse at the end.
const std::string kDeadEnd =
    "<model version='0.0.3' name='m'><point name='a' xPosition='0' yPosition='0'/><point name='b' xPosition='9000' "
    "yPosition='0'/><point name='\u4ED3\u5E93' xPosition='18000' yPosition='0'/><path name='ab' sourcePoint='a' "
    "destinationPoint='b' length='9000'/><path name='ba' sourcePoint='b' destinationPoint='a' length='9000'/><path "
    "name='bc' sourcePoint='b' destinationPoint='\u4ED3\u5E93' length='9000'/><locationType name='Dock 7'/><location "
    "name='L' type='Dock 7'><link point='a'/></location></model>";

TEST_F(ImportTest, CutsOffAndNamesWhatCannotBeReachedFromAll) {
  write("m.xml", kDeadEnd);
  const auto whole = run("import opentcs m.xml");
  EXPECT_THAT(whole.err,
              HasSubstr("reachability: 2 of 3 stations can all reach each other; cut off: \"\u4ED3\u5E93\"\n"));
  const auto core = run("import opentcs m.xml --core-only");
  EXPECT_THAT(core.err, HasSubstr("1 stations cannot be reached from all others and are cut off: \"\u4ED3\u5E93\"\n"));
  EXPECT_THAT(core.err, HasSubstr("reachability: all 2 stations can reach each other\n"));
  EXPECT_THAT(run("import opentcs m.xml --core-only --keep-antiparallel").err, HasSubstr(": 2 stations, 2 segments, "));
  write("one-way.csv", "id,x,y\na,0,0\nb,9,0\nfrom,to\na,b\n");
  EXPECT_THAT(run("import csv one-way.csv --core-only").err, HasSubstr("nothing is left of its core"));
}

TEST_F(ImportTest, TakesWordsForPurposes) {
  write("m.xml", kDeadEnd);
  EXPECT_THAT(run("import opentcs m.xml").err, HasSubstr("purposes: 0 storage, 0 charging, 0 parking\n"));
  EXPECT_THAT(run("import opentcs m.xml --purposes 'dock 7=storage parking'").err,
              HasSubstr("purposes: 1 storage, 0 charging, 1 parking\n"));
  EXPECT_THAT(run("import opentcs m.xml --purposes 'dock 7=stor'").err,
              HasSubstr("--purposes: \"dock 7\" is said to be for \"stor\""));
  EXPECT_THAT(run("import csv x.csv --purposes a=storage").err,
              HasSubstr("--purposes: has no meaning for format \"csv\"; it belongs to geojson, lif, opentcs, smap"));
}

TEST_F(ImportTest, NamesWordsThatTheFileDoesNotHave) {
  write("m.xml", kDeadEnd);
  const auto told = [&](const std::string& words) { return run("import m.xml --purposes '" + words + "'").err; };
  EXPECT_THAT(told("Dokc 7=storage"),
              HasSubstr("warning: --purposes: \"Dokc 7\" is no word of the layouts; did you mean \"Dock 7\"?\n"));
  EXPECT_THAT(told("Dock 7=storage,PACK=parking"),
              HasSubstr("warning: --purposes: \"PACK\" is no word of the layouts; their words: \"Dock 7\"\n"));
  EXPECT_THAT(told("dock 7=storage"), testing::Not(HasSubstr("is no word")));
  EXPECT_THAT(told("Dock 7=storage,dock 7=parking"),
              HasSubstr("error: --purposes: \"dock 7\" is there twice; remove one of them"));
  ASSERT_EQ(run("import m.xml -o l.lif.json").exit_code, 0);
  EXPECT_THAT(run("import l.lif.json --purposes 'pack=storage'").err,
              HasSubstr("--purposes: \"pack\" is no word of the layouts, which have none; remove it"));
}

// A word of one of several layouts is enough.
TEST_F(ImportTest, CampaignsRefuseWordsThatNoLayoutHas) {
  write("m.xml", kDeadEnd);
  write("plain.csv", "id,x,y\na,0,0\nb,9,0\nfrom,to,bidirectional\na,b,true\n");
  const auto checked = [&](const std::string& layouts, const std::string& words) {
    write("c.toml", "horizon_s = 20\n[factors]\nagents = [\"reckless\"]\nlayouts = [" + layouts +
                        "]\nfleet_sizes = [1]\n[purposes]\n" + words);
    return run("check c.toml");
  };
  const std::string core = "{ file = \"m.xml\", core_only = true }";
  const auto both = checked("\"plain.csv\", " + core + ", \"aisle-grid\"", "\"dock 7\" = \"storage\"\n");
  EXPECT_EQ(both.exit_code, 0) << both.err;
  const auto off = checked("\"plain.csv\", " + core, "\"Dock 7\" = \"storage\"\n\"Dock 77\" = \"storage\"\n");
  EXPECT_EQ(off.exit_code, 2);
  EXPECT_THAT(off.err, HasSubstr("c.toml:8:13: \"Dock 77\" is no word of the layouts; did you mean \"Dock 7\"?"));
  const auto none = checked("\"plain.csv\"", "\"Dock 7\" = \"storage\"\n");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("c.toml:7:12: \"Dock 7\" is no word of the layouts, which have none; remove it"));
}

TEST_F(ImportTest, CampaignsTakeWordsAndCores) {
  write("m.xml", kDeadEnd);
  const auto checked = [&](const std::string& layout, const std::string& tables) {
    write("c.toml", "horizon_s = 20\n[factors]\nagents = [\"reckless\"]\nlayouts = [" + layout +
                        "]\nfleet_sizes = [1]\n" + tables);
    const auto finished = run("check c.toml");
    return finished.out + finished.err;
  };
  const auto whole = checked("\"m.xml\"", "");
  EXPECT_THAT(whole,
              HasSubstr("only 2 of 3 stations can all reach each other; cut off: \"\u4ED3\u5E93\", less than 90 %"));
  const auto core = checked("{ file = \"m.xml\", core_only = true }", "[purposes]\n\"Dock 7\" = \"storage\"\n");
  EXPECT_THAT(core, HasSubstr("1 stations cannot be reached from all others and are cut off: \"\u4ED3\u5E93\""));
  EXPECT_THAT(core, testing::Not(HasSubstr("says nothing that is known")));
  EXPECT_THAT(checked("\"m.xml\"", "[purposes]\nPACK = \"stor\"\n"),
              HasSubstr("c.toml:7:8: \"PACK\" is said to be for \"stor\""));
  EXPECT_THAT(checked("\"m.xml\"", "[purposes]\nPACK = 7\n"), HasSubstr("purposes.PACK"));
}

// However much is said of the files, the stations that are cut off are named.
TEST_F(ImportTest, CampaignsNameWhatIsCutOffBeforeAllElse) {
  std::string talkative = kDeadEnd;
  for (const char* name : {"x", "y", "z"})
    talkative.insert(talkative.find("<location "), std::string("<locationType name='") + name + "'/>");
  write("m.xml", talkative);
  write("c.toml",
        "horizon_s = 20\n[factors]\nagents = [\"reckless\"]\nfleet_sizes = [1]\nlayouts = "
        "[{ file = \"m.xml\", name = \"a\", core_only = true }, { file = \"m.xml\", core_only = true }]\n");
  const auto checked = run("check c.toml");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  const std::string named =
      "warning: m.xml: 1 stations cannot be reached from all others and are cut off: \"\u4ED3\u5E93\"\n";
  EXPECT_THAT(checked.err, StartsWith(named + named)) << checked.err;
  EXPECT_THAT(checked.err, HasSubstr("more; fleetproof import shows all of one layout"));
}

TEST_F(ImportTest, RefusesWordsThatMeanNothing) {
  const auto error_of = [&](const std::string& words) {
    const auto finished = run(words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    EXPECT_EQ(finished.out, "");
    return finished.err;
  };
  EXPECT_THAT(error_of("import opentsc x.xml"), HasSubstr("did you mean \"opentcs\"?"));
  EXPECT_THAT(error_of("import csv x.csv --graph 1"),
              HasSubstr("--graph: has no meaning for format \"csv\"; it belongs to geojson, rmf"));
  EXPECT_THAT(error_of("import csv none.csv"), HasSubstr("none.csv: there is no such file"));
  EXPECT_THAT(error_of("import opentcs " + kCrossdock + " -o no/where.json"),
              HasSubstr("no/where.json: cannot be written"));
}

TEST_F(ImportTest, CampaignsTakeLayoutFilesByTheirExtension) {
  EXPECT_EQ(run("import opentcs " + kCrossdock + " -o dock.lif.json").exit_code, 0);
  EXPECT_EQ(run("import lif dock.lif.json -o tables.csv").exit_code, 0);
  write("c.toml",
        "horizon_s = 20\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"dock.lif.json\", "
        "\"tables.csv\"]\nfleet_sizes = [2]\n");
  const auto checked = run("check c.toml");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("2 cells"));
}

}  // namespace
}  // namespace fleetproof::import_test
