// Everything a radio can do, at once, in whole campaigns: the same bytes on any number of workers, every run comes
// back, scenario files hold it all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::hostile_radio_test {
namespace {

CampaignPlan hostile_plan(OutageSetup::Scope scope) {
  CampaignPlan plan = test::small_plan();
  plan.replicates = 2;
  plan.layouts = {{"aisle-grid", nullptr}};
  plan.factors[Factor::MeanOutage] = {0.0, 0.5};
  plan.radio.delay_model = RadioSetup::DelayModel::HeavyTail;
  plan.radio.range_m = 30.0;
  plan.radio.outages.model = OutageSetup::Model::HeavyTail;
  plan.radio.outages.scope = scope;
  plan.radio.asymmetry = scope == OutageSetup::Scope::Place ? 0.0 : 0.5;
  plan.radio.duplicates = 0.1;
  plan.radio.places = {
      .ap_spacing_m = 10.0, .roaming_at_crossing = scope == OutageSetup::Scope::Link, .roaming_border_m = 1.0};
  plan.radio.contention = {.interference = true, .contention_window = 7};
  plan.sources = {.count = 3, .like = {.mean_on_s = 2.0, .mean_off_s = 4.0}};
  RadioTrace trace;
  for (int i = 0; i < 100; ++i) {
    trace.push_back({AgvId{0U}, AgvId{1U}, Duration{i * 37'000'000LL},
                     i % 3 == 0 ? std::nullopt : std::optional(Duration{i * 11'000'000LL})});
  }
  plan.radio.trace = std::make_shared<const RadioTrace>(std::move(trace));
  return plan;
}

class HostileRadio : public test::ProgramTest {};

TEST_F(HostileRadio, AnyNumberOfWorkersWritesTheSameBytesAndEveryRunComesBack) {
  const CampaignPlan plan = hostile_plan(OutageSetup::Scope::Place);
  const AgentPrograms programs;
  for (const int workers : {1, 3}) {
    RunOptions options;
    options.workers = workers;
    EXPECT_TRUE(run_campaign(plan, programs, path(std::to_string(workers) + ".db"), options, {}).complete());
  }
  EXPECT_TRUE(read(path("1.db")) == read(path("3.db")));
  for (const int index : {0, 14, 23, 47}) {
    const auto replayed = run("replay 1.db " + std::to_string(index));
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_THAT(replayed.out, testing::HasSubstr("REPRODUCED"));
  }
}

TEST_F(HostileRadio, ARunIsTheSameFromItsScenarioFile) {
  for (const auto scope : {OutageSetup::Scope::Link, OutageSetup::Scope::Direction, OutageSetup::Scope::Place}) {
    const CampaignPlan plan = hostile_plan(scope);
    const ScenarioSource source(plan);
    const AgentPrograms programs;
    Counters sum;
    for (std::uint64_t index = 18; index < 24; ++index) {  // loss 40 %, outages of 0.5 s
      const Scenario scenario = source.scenario(index), again = parse_scenario(to_text(scenario), "text");
      const fp_agent_type& agent = programs.find(source.place(index).cell.agent, "test");
      const Outcome first = simulate(scenario, agent, {}), second = simulate(again, agent, {});
      EXPECT_EQ(first, second);
      sum.lost_in_outage += first.counters.lost_in_outage;
      sum.lost_by_interference += first.counters.lost_by_interference;
      sum.lost_to_sources += first.counters.lost_to_sources;
      sum.duplicates += first.counters.duplicates;
    }
    EXPECT_GT(sum.lost_in_outage, 1000U);
    EXPECT_GT(sum.lost_by_interference, 5U);
    EXPECT_GT(sum.lost_to_sources, 100U);
    EXPECT_GT(sum.duplicates, 100U);
  }
}

}  // namespace
}  // namespace fleetproof::hostile_radio_test
