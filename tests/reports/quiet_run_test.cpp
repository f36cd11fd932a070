#include "reports/evidence/quiet_run.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace fleetproof::quiet_run_test {
namespace {

RunRecord quiet_run() {
  RunRecord run;
  run.outcome.agv_count = 2;
  run.outcome.simulated_ns = 60'000'000'000;
  run.outcome.counters.transports_done = 3;
  run.outcome.counters.messages_sent = 4;
  run.outcome.min_clearance_um = 120'000;
  return run;
}

Incident incident_of(IncidentKind kind) {
  Incident incident;
  incident.kind = kind;
  incident.a = EntityId{0U};
  return incident;
}

TEST(QuietRuns, HaveNothingThatAPageCouldName) {
  EXPECT_TRUE(is_quiet(quiet_run()));
  for (const auto flag : {&Outcome::violation, &Outcome::contact, &Outcome::stuck, &Outcome::crash, &Outcome::hang,
                          &Outcome::indeterminate, &Outcome::engine_error}) {
    RunRecord run = quiet_run();
    run.outcome.*flag = true;
    EXPECT_FALSE(is_quiet(run));
  }
  RunRecord near = quiet_run();
  near.outcome.violations.emplace_back();
  EXPECT_FALSE(is_quiet(near));
}

TEST(QuietRuns, MayHaveFaultsButNoAccusation) {
  for (const IncidentKindInfo& info : incident_kinds()) {
    RunRecord run = quiet_run();
    run.outcome.incidents = {incident_of(info.kind)};
    EXPECT_EQ(is_quiet(run), info.kind == IncidentKind::FaultInjected) << info.name;
  }
}

// The head counts those of software under test.
TEST(QuietRuns, WithoutAMessageAreFoldedOnlyIfNobodyCountsThem) {
  StoredPlan plan;
  plan.campaign.agents_under_test = {"ours"};
  plan.cells = {{0, "ours", "ring", 2, {}}, {1, "theirs", "ring", 2, {}}};
  const MayFold may_fold = quiet_runs_of(plan);
  RunRecord run = quiet_run();
  EXPECT_TRUE(may_fold(run));
  run.outcome.counters.messages_sent = 0;
  EXPECT_FALSE(may_fold(run));
  run.cell = 1;
  EXPECT_TRUE(may_fold(run)) << "a reference agent";
  run.cell = 0;
  run.outcome.agv_count = 1;
  EXPECT_TRUE(may_fold(run)) << "one AGV has nobody to talk to";
}

}  // namespace
}  // namespace fleetproof::quiet_run_test
