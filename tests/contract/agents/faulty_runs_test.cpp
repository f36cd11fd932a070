// The sound agent among everything that goes wrong with computers, clocks, batteries, drives and radio: no two AGVs
// ever come too near each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "generators/families/layout_family.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/support/hard_world.hpp"
#include "tests/support/reference_agent.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::faulty_runs_test {
namespace {

struct Totals {
  std::uint64_t runs = 0, violating = 0, crashed = 0, done = 0, faults = 0, duplicates = 0, restarted = 0, charged = 0;
};

void run_one(std::uint64_t number, Totals& totals) {
  const auto families = layout_families();
  WorldSpec spec = test::hard_world(300.0);
  const FamilyRange choice{&families[number % families.size()], Range::Normal};
  if (number / families.size() / 2 % 2 == 0) {
    spec.layout = std::string(choice.family->name);
  } else {
    spec.layout = test::bent_map(choice, 7000 + number);
  }
  RejectionCounts counts;
  Scenario scenario = generate_world(spec, 7000 + number, counts);
  scenario.radio.loss = number / families.size() % 2 == 0 ? 0.0 : 0.4;
  scenario.radio.delay_s = 2.0;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  scenario.radio.duplicates = 0.05;
  if (number % 5 == 0) scenario.radio.outages.mean_outage_s = 2.0;
  scenario.agent_clock.call_cost_s = number % 4 == 0 ? 0.002 : 0.0;
  scenario.operator_help = {.on = number % 5 != 0, .least_s = 5.0, .most_s = 20.0, .battery = 0.7};
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(find_law("exact")->make(scenario));
  const Outcome outcome = simulate(scenario, test::reference_agent("hull-lock"), laws);
  ++totals.runs;
  totals.violating += outcome.violation || outcome.contact;
  totals.crashed += outcome.crash || outcome.hang || outcome.engine_error;
  EXPECT_FALSE(outcome.violation || outcome.contact) << "world " << 7000 + number << ": " << scenario.name;
  totals.done += outcome.counters.transports_done;
  totals.faults += outcome.counters.faults;
  totals.duplicates += outcome.counters.duplicates;
  for (const ProbeCount& probe : outcome.probes) {
    if (probe.name == "restarted") totals.restarted += probe.count;
    if (probe.name == "drives-to-charger") totals.charged += probe.count;
  }
}

TEST(Faults, HullLockKeepsItsDistanceWhateverGoesWrong) {
  Totals totals;
  for (std::uint64_t number = 0; number < 360; ++number) run_one(number, totals);
  EXPECT_EQ(totals.violating, 0U);
  EXPECT_EQ(totals.crashed, 0U);
  EXPECT_GT(totals.done, totals.runs) << "and it gets on with its work";
  EXPECT_GT(totals.faults, 20 * totals.runs);
  EXPECT_GT(totals.restarted, 5 * totals.runs);
  EXPECT_GT(totals.charged, 10U);
  EXPECT_GT(totals.duplicates, 100 * totals.runs);
}

}  // namespace
}  // namespace fleetproof::faulty_runs_test
