// The verb `import`, and layout files of other programs in campaigns.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ImportTest : public test::ProgramTest {};

const std::string kCrossdock = "'" + test::source("tests/layouts/crossdock.xml") + "'";

TEST_F(ImportTest, WritesLayoutsLifAndCsv) {
  EXPECT_EQ(run("import opentcs " + kCrossdock + " -o plain.json").exit_code, 0);
  const auto merged = run("import opentcs " + kCrossdock + " --merge-antiparallel -o merged.json");
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(merged.out, "");
  EXPECT_THAT(merged.err, HasSubstr("30 stations, 31 segments, 0 warnings\n"));
  EXPECT_EQ(run("import layout merged.json -o merged.lif.json").exit_code, 0);
  EXPECT_EQ(run("import lif merged.lif.json -o again.json").exit_code, 0);
  EXPECT_EQ(read(path("again.json")), read(path("merged.json")));
  EXPECT_EQ(run("import lif merged.lif.json -o merged.csv").exit_code, 0);
  EXPECT_THAT(read(path("merged.csv")), StartsWith("id,x,y,purposes\n"));
  EXPECT_EQ(run("import lif merged.lif.json").out, read(path("merged.json")))
      << "without -o the layout goes to standard output";
}

TEST_F(ImportTest, DrawsWhatItRead) {
  const auto finished = run("import opentcs " + kCrossdock + " -o plain.json --svg plain.svg");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(read(path("plain.svg")), StartsWith("<svg "));
  EXPECT_THAT(run("import opentcs " + kCrossdock + " --svg no/where.svg").err,
              HasSubstr("no/where.svg: cannot be written (No such file or directory); choose another path for --svg"));
}

TEST_F(ImportTest, TellsWhatItGuessed) {
  write("m.map", "height 1\nwidth 3\nmap\n.S.\n");
  const auto finished = run("import grid m.map --cell-pitch 1.5");
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.err,
            "warning: m.map: cells are taken to be 1.5 m apart; the map names no charging and no parking\n"
            "m.map: 3 stations, 2 segments, 1 warnings\n");
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
              HasSubstr("--graph: has no meaning for format \"csv\"; it belongs to \"rmf\""));
  EXPECT_THAT(error_of("import csv none.csv"), HasSubstr("none.csv: there is no such file"));
  EXPECT_THAT(error_of("import opentcs " + kCrossdock + " -o no/where.json"),
              HasSubstr("no/where.json: cannot be written"));
}

TEST_F(ImportTest, CampaignsTakeLayoutFilesByTheirExtension) {
  EXPECT_EQ(run("import opentcs " + kCrossdock + " --merge-antiparallel -o dock.lif.json").exit_code, 0);
  EXPECT_EQ(run("import lif dock.lif.json -o tables.csv").exit_code, 0);
  write("c.toml",
        "horizon_s = 20\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"dock.lif.json\", "
        "\"tables.csv\"]\nfleet_sizes = [2]\n");
  const auto checked = run("check c.toml");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("2 cells"));
}

}  // namespace
}  // namespace fleetproof
