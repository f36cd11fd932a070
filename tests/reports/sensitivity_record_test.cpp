#include "reports/sensitivity/sensitivity_record.hpp"

#include <gmock/gmock.h>

#include "reports/sensitivity/sensitivity_section.hpp"

namespace fleetproof::sensitivity_record_test {
namespace {

SensitivityRecord sample() {
  SensitivityRecord record;
  record.worlds = "00ff";
  record.engine_version = "1";
  record.program_sha256 = "aa";
  record.seeds = {3, 4, 5};
  record.runs = 100;
  record.sound = {{"sound", 300, 0}};
  record.known_faults = 34;
  record.faults.resize(3);
  record.faults[0] = {"early", "releases early", 3, "contact", false, 12.5, 40, "grid, 2 AGVs", "crossing"};
  record.faults[1] = {"slow", "waits", 3, "stuck", true, {}, {}, "grid, 5 AGVs", ""};
  record.faults[2] = {"rare", "seldom", 2, "violation", false, 80.0, {}, "grid, 5 AGVs", "tight-gap"};
  return record;
}

TEST(SensitivityRecord, IsReadAsItWasWritten) {
  const auto text = sensitivity_text(sample());
  const auto read = parse_sensitivity(text);
  ASSERT_TRUE(read);
  EXPECT_EQ(sensitivity_text(*read), text);
  EXPECT_EQ(read->faults[2].median_runs, 80.0);
  EXPECT_EQ(read->faults[2].most_runs, std::nullopt);
  EXPECT_EQ(read->known_faults, 34U);
}

TEST(SensitivityRecord, SaysHowManyFaultsWereNotMeasured) {
  SensitivityRecord record = sample();
  EXPECT_EQ(sensitivity_sentence(record),
            "detects 2 of 3 planted faults within 100 runs; misses rare; 31 more were not measured");
  record.known_faults = 3;
  EXPECT_EQ(sensitivity_sentence(record), "detects 2 of 3 planted faults within 100 runs; misses rare");
}

TEST(SensitivityRecord, AFaultIsDetectedByNineOfTenSeeds) {
  SensitivityRecord record = sample();
  EXPECT_EQ(sensitivity_sentence(record),
            "detects 2 of 3 planted faults within 100 runs; misses rare; 31 more were not measured");
  record.seeds.resize(20, 1);
  for (PlantedFault& fault : record.faults) fault.seeds = 18;
  record.faults[1].seeds = 17;
  EXPECT_EQ(sensitivity_sentence(record),
            "detects 2 of 3 planted faults within 100 runs; misses slow; 31 more were not measured");
}

TEST(SensitivityRecord, SaysWhatWasNeverTried) {
  SensitivityRecord record = sample();
  PlantedFault& fault = record.faults.emplace_back();
  fault.agent = "boots";
  fault.tried = false;
  EXPECT_EQ(sensitivity_sentence(record),
            "detects 2 of 4 planted faults within 100 runs; misses rare; never tries boots; 30 more were not measured");
  EXPECT_EQ(sensitivity_table(record).rows[3][5], "never tried");
  const auto read = parse_sensitivity(sensitivity_text(record));
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->faults[3].tried);
  EXPECT_TRUE(read->faults[2].tried);
}

TEST(SensitivityRecord, WorldsAreWhatDecidesInWhichWorldsAgentsAreTried) {
  const auto plan = [](const std::string& more) { return "{\"horizon_s\":60" + more + "}"; };
  const std::string worlds = worlds_of(plan(""));
  EXPECT_EQ(worlds_of(plan(R"(,"name":"a","seed":3,"replicates":5,"gates":[],"factors":{"agents":["x"]})")),
            worlds_of(plan(R"(,"name":"b","seed":4,"replicates":6,"gates":[1],"factors":{"agents":["y"]})")));
  EXPECT_NE(worlds_of(plan(R"(,"radio":{})")), worlds);
  EXPECT_NE(worlds_of(plan(R"(,"factors":{"loss":[0.4]})")), worlds_of(plan(R"(,"factors":{"loss":[0.3]})")));
}

TEST(SensitivityRecord, StandsBesideTheCampaignFile) {
  EXPECT_EQ(sensitivity_path("night.db"), "night.sensitivity.json");
  EXPECT_EQ(sensitivity_path("/a b/plant 1.2.db"), "/a b/plant 1.2.sensitivity.json");
}

TEST(SensitivityTable, HasMediansAndSaysWhatHasNone) {
  const Table table = sensitivity_table(sample());
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.columns[3].head, "first after runs, median");
  SensitivityRecord one_seed = sample();
  one_seed.seeds = {3};
  EXPECT_EQ(sensitivity_table(one_seed).columns[3].head, "first after runs");
  EXPECT_THAT(table.rows[0], testing::ElementsAre("early", "releases early", "3 of 3", "12.5", "40", "contact",
                                                  "grid, 2 AGVs", "crossing"));
  EXPECT_EQ(table.rows[1][3], "by rate");
  EXPECT_EQ(table.rows[2][4], "-") << "one seed missed it";
}

}  // namespace
}  // namespace fleetproof::sensitivity_record_test
