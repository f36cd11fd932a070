// Layout files of other programs, read by a parser of their own (tests/survey): what is imported is what is there.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::survey_test {
namespace {

using testing::HasSubstr;

class Survey : public test::ProgramTest {
 protected:
  test::Finished survey(const std::string& files, const std::string& program = "$FLEETPROOF") const {
    return shell("python3 -B '" + test::source("tests/survey/survey.py") + "' \"" + program + "\" " + files);
  }
  static std::string file(const std::string& name) { return "'" + test::source("tests/survey/files/" + name) + "'"; }
};

TEST_F(Survey, FindsWhatIsImported) {
  const auto finished = survey("'" + test::source("tests/survey/files") + "' '" + test::source("tests/layouts") + "'");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(finished.out.ends_with("\n\nno difference\n")) << finished.out;
  // As the survey counts them; today.xml was counted by hand, too. Stations, drives, metres, for storage, charging,
  // parking; drives with limits, backward, with permissions, in blocks; stations with headings, without turning.
  for (const char* row : {"today.xml | 5 | 8 | 57.18 | 2 | 1 | 1 | 7 | 3 | 0 | 5 | 1 | 0 |",
                          "polylines.xml | 2 | 2 | 39.57 | 0 | 0 | 0 | 2 | 0 | 0 | 0 | 0 | 0 |",
                          "polylines.lif.json | 2 | 2 | 39.57 | 2 | 0 | 0 | 0 | 0 | 0 | 0 | 1 | 0 |",
                          "rules.lif.json | 5 | 10 | 55.35 | 3 | 1 | 0 | 1 | 2 | 3 | 0 | 1 | 1 |",
                          "turn_on_a_spot.lif.json | 2 | 2 | 10.00 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 0 |",
                          "turntable.lif.json | 5 | 7 | 48.00 | 2 | 1 | 0 | 0 | 2 | 5 | 0 | 1 | 1 |",
                          "two@upper.lif.json | 3 | 5 | 35.00 | 0 | 0 | 0 | 2 | 2 | 2 | 0 | 0 | 0 |",
                          "graph.yaml | 3 | 4 | 26.50 | 1 | 1 | 1 | 1 | 1 | 0 | 2 | 0 | 0 |",
                          "house@L2@1.building.yaml | 5 | 8 | 32.73 | 2 | 1 | 1 | 2 | 1 | 0 | 2 | 0 | 0 |",
                          "depot.geojson | 4 | 5 | 30.00 | 1 | 1 | 0 | 1 | 0 | 0 | 0 | 0 | 0 |",
                          "hall.smap | 5 | 8 | 42.31 | 1 | 1 | 1 | 1 | 2 | 0 | 0 | 2 | 1 |",
                          "tables.csv | 4 | 7 | 47.85 | 1 | 1 | 1 | 4 | 3 | 5 | 5 | 1 | 1 |",
                          "cells.map | 17 | 44 | 52.80 | 2 | 0 | 0 |"})
    EXPECT_THAT(finished.out, HasSubstr(row));
}

// A program whose imports differ from the file in one thing.
TEST_F(Survey, NoticesOneThingThatIsOff) {
  struct Change {
    const char *file, *edit, *difference;
  };
  const Change changes[] = {
      {"today.xml", R"(s/"speed_limit_mps": 0.6/"speed_limit_mps": 0.7/)", "drive ('north', 'spur', 'forward', 0.6"},
      {"today.xml", R"(s/"back_travel": "backward"/"back_travel": "forward"/)", "drive ('north', 'east', 'backward'"},
      {"today.xml", R"(s/"name": "lane"/"name": "other"/; s/"lane"\]/"other"]/)",
       "('crossing', 'lane')) is not imported"},
      {"today.xml", R"(/"name": "dock-east"/d)", "drive ('dock', 'east', 'forward', 1.5"},
      {"today.xml", R"(s/\[8, 0\]/[8.01, 0]/)", "station east stands at 8.0 0.0"},
      {"today.xml", R"(s/"heading": \[1, 0\]/"heading": [0, 1]/)", "station spur is (['storage'], 0.0"},
      {"today.xml", R"(s/10\.2/10.6/)", "m, imported with"},
      {"rules.lif.json", R"(s/"vehicle_type": "fork", "load": "loaded"/"vehicle_type": "fork"/)", "('fork', 'loaded')"},
      {"rules.lif.json", R"(s/, "turning": false//)", "station rack is (['storage'], None, False)"},
      {"turntable.lif.json", R"(s/"storage", "charging"/"storage"/)", "station table out is (['charging', 'storage']"},
      {"turntable.lif.json", R"(s/"from": "stiff", "to": "table out"/"from": "apart", "to": "table out"/)",
       "drive ('stiff', 'table out', 'backward'"},
      {"graph.yaml", R"(s/"storage", "parking"/"storage"/)", "station p3"},
  };
  for (const auto& [name, edit, difference] : changes) {
    write("altered", "#!/bin/bash\n'" + std::string(FLEETPROOF_PROGRAM) +
                         "' \"$@\"\nended=$?\nif [ $1 = import ]; then sed -i '" + edit +
                         "' \"$5\"; fi\nexit $ended\n");
    ASSERT_EQ(shell("chmod +x altered").exit_code, 0);
    const auto finished = survey(file(name), path("altered"));
    EXPECT_EQ(finished.exit_code, 1) << edit << finished.out << finished.err;
    EXPECT_THAT(finished.out, HasSubstr(difference)) << edit;
  }
}

TEST_F(Survey, NoticesARefusalWithoutAFault) {
  write("refusing", "#!/bin/bash\necho 'error: it is Monday' >&2\nexit 2\n");
  ASSERT_EQ(shell("chmod +x refusing").exit_code, 0);
  const auto finished = survey(file("today.xml"), path("refusing"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.out, HasSubstr("today.xml: refused, and the survey finds no fault: error: it is Monday"));
}

}  // namespace
}  // namespace fleetproof::survey_test
