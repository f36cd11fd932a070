#include "campaign/campaign_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"

namespace fleetproof {
namespace {

using testing::HasSubstr;

class CampaignFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("fleetproof-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  CampaignFile read(const std::string& text) {
    const std::string path = (folder_ / "c.toml").string();
    std::ofstream(path) << text;
    CampaignFile file = read_campaign_file(path);
    check_plan(file.plan, path);
    return file;
  }

  std::string error_of(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

const std::string kFactors = "[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n";

TEST_F(CampaignFileTest, DefaultsAreThePapers) {
  const CampaignPlan plan = read(kFactors).plan;
  EXPECT_EQ(plan.name, "c");
  EXPECT_EQ(plan.horizon_s, 600.0);
  EXPECT_EQ(plan.vehicle.drive.speed_mps, 2.0);
  EXPECT_EQ(plan.vehicle.drive.acceleration_mps2, 0.5);
  EXPECT_EQ(plan.vehicle.drive.deceleration_mps2, 1.0);
  EXPECT_EQ(plan.law.safety_distance_m, 0.10);
  EXPECT_EQ(plan.run_count(), 1U);
}

TEST_F(CampaignFileTest, LawsMayBeLeftOutButNotTheJudge) {
  EXPECT_TRUE(read(kFactors).plan.laws_left_out.empty());
  const CampaignPlan plan = read(kFactors + "[law]\nleave_out = [\"congestion\"]\nreaction_s = 3.0\nmin_transports_per_agv_hour = 2.0\n").plan;
  EXPECT_EQ(plan.laws_left_out, (std::vector<std::string>{"congestion"}));
  const CampaignPlan back = parse_plan(plan_text(plan));
  EXPECT_EQ(back.laws_left_out, plan.laws_left_out);
  EXPECT_EQ(back.law.reaction_s, 3.0);
  EXPECT_EQ(back.law.min_transports_per_agv_hour, 2.0);
  EXPECT_EQ(plan_text(back), plan_text(plan));
  EXPECT_THAT(error_of(kFactors + "[law]\nleave_out = [\"safety-distance\"]\n"), HasSubstr("the judge of violations"));
  EXPECT_THAT(error_of(kFactors + "[law]\nleave_out = [\"congestoin\"]\n"), HasSubstr("did you mean \"congestion\"?"));
  EXPECT_THAT(error_of(kFactors + "[law]\nleave_out = [\"coverage\"]\n"), HasSubstr("set coverage.probes = []"));
  EXPECT_THAT(error_of(kFactors + "[law]\nreaction_s = -1\n"), HasSubstr("law.reaction_s is -1"));
}

TEST_F(CampaignFileTest, AClaimAsksForEncountersAndASearchForNothing) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(read(kFactors).plan.probes_to_meet(), (Names{"encounter", "negotiation?"}));
  EXPECT_EQ(read("kind = \"search\"\n" + kFactors).plan.probes_to_meet(), Names{});
  const CampaignPlan plan = read("kind = \"search\"\n" + kFactors + "[coverage]\nprobes = [\"head-on\"]\n").plan;
  EXPECT_EQ(plan.probes_to_meet(), (Names{"head-on"}));
  EXPECT_EQ(parse_plan(plan_text(plan)).probes_to_meet(), (Names{"head-on"}));
  EXPECT_EQ(read(kFactors + "[coverage]\nprobes = []\n").plan.probes_to_meet(), Names{});
  EXPECT_THAT(error_of(kFactors + "[coverage]\nprobes = [\"\"]\n"), HasSubstr("coverage.probes holds"));
  EXPECT_THAT(error_of(kFactors + "[coverage]\nprobse = []\n"), HasSubstr("did you mean"));
}

TEST_F(CampaignFileTest, CellsAreAllCombinations) {
  const CampaignPlan plan =
      read("replicates = 3\n[factors]\nagents = [\"reckless\", \"hull-lock\"]\nlayouts = [\"aisle-grid\", \"corridor-sidings\"]\nfleet_sizes = [2, 5]\nloss = [0, "
           "0.4]\ndelay_s = [0, 1, 2]\n")
          .plan;
  EXPECT_EQ(plan.cell_count(), 2U * 2 * 2 * 2 * 3);
  EXPECT_EQ(plan.run_count(), 3 * plan.cell_count());
  const auto cells = plan.cells();
  ASSERT_EQ(cells.size(), plan.cell_count());
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(cells[i].index, i);
  EXPECT_EQ(cells[0].agent, "reckless");
  EXPECT_EQ(cells[1].agent, "hull-lock");
  EXPECT_EQ(cells[2].delay_s, 1.0);
}

TEST_F(CampaignFileTest, PlanTextSurvivesTheRoundTrip) {
  const CampaignPlan plan = read("seed = 9\nreplicates = 2\nagent_config = \"x=1\"\n" + kFactors +
                                 "loss = [0.1]\n[radio]\ndelay_model = \"uniform\"\n[vehicle]\nlength_m = 1.9\n[[gate]]\nagent = \"reckless\"\nregion = \"contract\"\nlimit = "
                                 "0.1\nkind = \"none\"\n")
                                .plan;
  const std::string text = plan_text(plan);
  const CampaignPlan again = parse_plan(text);
  EXPECT_EQ(plan_text(again), text);
  EXPECT_EQ(again.seed, 9U);
  EXPECT_EQ(again.vehicle.footprint.length_m, 1.9);
  EXPECT_EQ(again.radio.delay_model, RadioSetup::DelayModel::Uniform);
  ASSERT_EQ(again.gates.size(), 1U);
  EXPECT_EQ(again.gates[0].kind, GateKind::None);
  EXPECT_EQ(again.cells(), plan.cells());
}

TEST_F(CampaignFileTest, ErrorsNamePlaceValueAndRemedy) {
  EXPECT_THAT(error_of("seed = \n"), HasSubstr("c.toml:1:"));
  EXPECT_THAT(error_of("replicats = 3\n" + kFactors), HasSubstr("c.toml:1:1: replicats is not a known key; did you mean \"replicates\"?"));
  EXPECT_THAT(error_of(kFactors + "los = [0.1]\n"), HasSubstr("c.toml:5:1: factors.los is not a known key; did you mean \"loss\"?"));
  EXPECT_THAT(error_of(kFactors + "loss = [1.4]\n"), HasSubstr("factors.loss holds 1.4; a share of lost messages lies between 0 and 1"));
  EXPECT_THAT(error_of(kFactors + "loss = \"much\"\n"), HasSubstr("c.toml:5:8: factors.loss is a string; it must be an array"));
  EXPECT_THAT(error_of("replicates = -1\n" + kFactors), HasSubstr("replicates is -1; it must be a whole number"));
  EXPECT_THAT(error_of("replicates = 0\n" + kFactors), HasSubstr("replicates is 0"));
  EXPECT_THAT(error_of("[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [0]\n"), HasSubstr("a fleet has 1 to 1000 AGVs"));
  EXPECT_THAT(error_of("[factors]\nagents = [\"reckless\"]\nlayouts = [\"isle-grid\"]\n"), HasSubstr("did you mean \"aisle-grid\"?"));
  EXPECT_THAT(error_of("[factors]\nagents = [\"reckless\"]\nlayouts = [\"missing.xml\"]\n"), HasSubstr("missing.xml"));
  EXPECT_THAT(error_of(kFactors + "[[gate]]\nagent = \"recless\"\n"), HasSubstr("did you mean \"reckless\"?"));
  EXPECT_THAT(error_of(kFactors + "[[gate]]\nagent = \"reckless\"\nkind = \"rte\"\n"), HasSubstr("did you mean \"rate\"?"));
  EXPECT_THAT(error_of(kFactors + "[[gate]]\nagent = \"reckless\"\nregion = \"worst-case\"\n"), HasSubstr("no cell of this campaign lies in region"));
  EXPECT_THAT(error_of("name = \"x\"\n"), HasSubstr("has no [factors] table"));
  EXPECT_THAT(error_of(kFactors + "loss = [0.1, 0.1]\n"), HasSubstr("names one value twice"));
  EXPECT_THAT(error_of("[vehicle]\nspeed_mps = 0\n" + kFactors), HasSubstr("vehicle.speed_mps is 0; it lies from 0.01 to 100"));
}

TEST_F(CampaignFileTest, AMissingFileSaysSo) {
  try {
    read_campaign_file((folder_ / "none.toml").string());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("there is no such file"));
  }
}

}  // namespace
}  // namespace fleetproof
