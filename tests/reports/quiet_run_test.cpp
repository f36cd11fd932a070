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

}  // namespace
}  // namespace fleetproof::quiet_run_test
