// Gates that name their cells: what a campaign file may say, what is refused, and that older plans keep their hash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/plan_check.hpp"
#include "campaign/plan/plan_text.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "storage/records.hpp"

namespace fleetproof::gate_cells_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string kCampaign =
    "[factors]\nagents = [\"hull-lock\", \"reckless\"]\nlayouts = [\"aisle-grid\", \"loop-spurs\"]\n"
    "fleet_sizes = [3, 5]\nloss = [0.0, 0.4, 0.6]\ndelay_s = [0.0, 2.0]\nmean_outage_s = [0.0, 0.5]\n"
    "[[gate]]\nname = \"g\"\nagent = \"hull-lock\"\n";

CampaignPlan plan_of(const std::string& text) {
  const CampaignFile file = parse_campaign_file(text, "c.toml");
  check_plan(file.plan, file.places);
  return file.plan;
}

std::string error_of(const std::string& lines, const std::string& campaign = kCampaign) {
  try {
    plan_of(campaign + lines);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::vector<CellRecord> cells_of_gate(const CampaignPlan& plan) {
  std::vector<CellRecord> list;
  for (const CellRecord& cell : plan.cells()) {
    if (covers(plan.gates.at(0), cell)) list.push_back(cell);
  }
  return list;
}

const std::string kOneCell =
    "layout = \"loop-spurs\"\nfleet_size = 5\nloss = 0.4\ndelay_s = 2.0\nmean_outage_s = 0.5\n";

TEST(GateCells, AGateMayNameOneCellCompletely) {
  const auto cells = cells_of_gate(plan_of(kCampaign + kOneCell));
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_EQ(cells[0].agent, "hull-lock");
  EXPECT_EQ(cells[0].layout, "loop-spurs");
  EXPECT_EQ(cells[0].fleet_size, 5U);
  EXPECT_THAT(cells[0].lowest.values, ElementsAre(0.4, 2.0, 0.5, 0.0));
}

// Of 2 layouts x 2 fleets x 3 losses x 2 delays x 2 outages, 8 x 2 x 2 of them within the contract.
TEST(GateCells, EveryPartThatIsLeftOutLeavesThemAll) {
  const auto count = [](const std::string& lines) { return cells_of_gate(plan_of(kCampaign + lines)).size(); };
  EXPECT_EQ(count(""), 32U);
  EXPECT_EQ(count("region = \"all\"\n"), 48U);
  EXPECT_EQ(count("fleet_size = 5\n"), 16U);
  EXPECT_EQ(count("mean_outage_s = 0.5\n"), 16U);
  EXPECT_EQ(count("fleet_size = 5\nmean_outage_s = 0\nlayout = \"aisle-grid\"\n"), 4U);
  EXPECT_EQ(count("loss = 0\n"), 16U);
  EXPECT_EQ(count("region = \"contract\"\ndelay_s = 2\n"), 16U);
}

TEST(GateCells, ARegionThatNobodyWroteDoesNotCutALossOrDelay) {
  EXPECT_EQ(plan_of(kCampaign + "loss = 0.6\n").gates[0].region, Region::All);
  EXPECT_EQ(plan_of(kCampaign + "delay_s = 2\n").gates[0].region, Region::All);
  EXPECT_EQ(plan_of(kCampaign + "delay_s = 2\nregion = \"contract\"\n").gates[0].region, Region::Contract);
  EXPECT_EQ(plan_of(kCampaign + "fleet_size = 3\nmean_outage_s = 0.5\n").gates[0].region, Region::Contract);
  EXPECT_EQ(cells_of_gate(plan_of(kCampaign + "loss = 0.6\n")).size(), 16U);
}

TEST(GateCells, WhatThePlanDoesNotHaveIsRefusedAtItsPlace) {
  EXPECT_EQ(error_of("fleet_size = 4\n"),
            "c.toml:11:14: gate \"g\": fleet_size 4 is not among factors.fleet_sizes: 3, 5");
  EXPECT_EQ(error_of("layout = \"fishbone\"\n"),
            "c.toml:11:10: gate \"g\": layout \"fishbone\" is not among factors.layouts: aisle-grid, loop-spurs");
  EXPECT_EQ(error_of("loss = 0.3\n"),
            "c.toml:11:8: gate \"g\": loss 0.3 is none of the values of loss in this campaign: 0, 0.4, 0.6");
  EXPECT_EQ(error_of("call_cost_s = 0.01\n"),
            "c.toml:11:15: gate \"g\": call_cost_s 0.01 is none of the values of call_cost_s in this campaign: 0");
  EXPECT_THAT(error_of("loss = 1.5\n"), HasSubstr("c.toml:11:8: gate.loss: 1.5 is refused: expected a number from 0"));
  EXPECT_THAT(error_of("fleet_size = 2.5\n"), HasSubstr("gate.fleet_size: 2.5 is refused: expected a whole number"));
}

TEST(GateCells, ARegionThatLeavesNoCellIsRefused) {
  EXPECT_EQ(error_of("region = \"contract\"\nloss = 0.6\n"),
            "c.toml:12:8: gate \"g\": loss 0.6 lies outside region \"contract\", where this campaign has loss: 0, 0.4; "
            "leave region out, or name one of these values");
  EXPECT_THAT(error_of("region = \"worst-case\"\nloss = 0.4\ndelay_s = 0\n"),
              HasSubstr("c.toml:13:11: gate \"g\": delay_s 0 lies outside region \"worst-case\", where this campaign "
                        "has delay_s: 2;"));
}

// A campaign with bounds has one such cell, which needs no name.
TEST(GateCells, AValueIsNotACellWithBounds) {
  const std::string drawn =
      "[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nloss = { from = 0.0, to = 0.4 }\n"
      "delay_s = [0, 2]\n[[gate]]\nname = \"g\"\nagent = \"hull-lock\"\n";
  EXPECT_THAT(error_of("loss = 0.4\n", drawn), HasSubstr("is none of the values of loss in this campaign: 0 .. 0.4"));
  EXPECT_EQ(cells_of_gate(plan_of(drawn + "delay_s = 2\n")).size(), 1U);
}

TEST(GateCells, APlanTextHoldsWhatIsNamed) {
  const CampaignPlan plan = plan_of(kCampaign + kOneCell);
  const CampaignPlan again = parse_plan(plan_text(plan));
  EXPECT_EQ(again.gates, plan.gates);
  EXPECT_EQ(plan_text(again), plan_text(plan));
  EXPECT_THAT(plan_text(plan), HasSubstr("\"fleet_size\": 5"));
  EXPECT_NE(plan_text(plan), plan_text(plan_of(kCampaign + "region = \"all\"\nlayout = \"loop-spurs\"\n")));
}

// The plan of tests/storage/archives/schema8.fp, with the hash that stands there.
TEST(GateCells, PlansThatNameNoCellsKeepTheirHash) {
  const CampaignPlan plan = plan_of(
      "name = \"old\"\nseed = 5\nreplicates = 3\nhorizon_s = 60\n[factors]\nagents = [\"hull-lock\", \"reckless\"]\n"
      "layouts = [\"aisle-grid\"]\nfleet_sizes = [3]\nloss = [0, 0.4]\n[agent_clock]\ncall_cost_s = 0.01\n"
      "[limits]\ncpu_s = 10\n"
      "[[gate]]\nname = \"g\"\nagent = \"hull-lock\"\nlimit = 0.9\nmethod = \"fixed\"\n");
  EXPECT_THAT(plan_text(plan), Not(HasSubstr("\"fleet_size\":")));
  EXPECT_EQ(name_hash(plan_text(plan)), 0x10b92e1e77060e3dU);
}

}  // namespace
}  // namespace fleetproof::gate_cells_test
