#include "reports/page/wording.hpp"

#include <gtest/gtest.h>

namespace fleetproof::wording_test {
namespace {

TEST(Wording, ClearancesAreRoundedDown) {
  EXPECT_EQ(metres_text(0), "0.00 m");
  EXPECT_EQ(metres_text(9'999), "0.00 m");
  EXPECT_EQ(metres_text(99'999), "0.09 m");
  EXPECT_EQ(metres_text(100'000), "0.10 m");
  EXPECT_EQ(metres_text(289'999), "0.28 m");
  EXPECT_EQ(metres_text(290'000), "0.29 m");
}

TEST(Wording, DistancesOfAPlanKeepAllTheirDigits) {
  EXPECT_EQ(distance_text(0.1), "0.10 m");
  EXPECT_EQ(distance_text(0.25), "0.25 m");
  EXPECT_EQ(distance_text(0.105), "0.105 m");
  EXPECT_EQ(distance_text(1.0), "1.00 m");
}

Tally tally_of(const Outcome& outcome) {
  RunRecord run;
  run.outcome = outcome;
  return Tally::of(run, result_of(outcome, EndPoint::Violation));
}

TEST(Wording, AClearanceThatWasNotMeasuredIsNotCalledLarge) {
  Outcome far, engine_error, unexplained;
  far.simulated_ns = engine_error.simulated_ns = 600'000'000'000;
  engine_error.engine_error = true;
  unexplained.crash = true;  // nothing is known of it, its time neither
  EXPECT_EQ(clearance_text(Tally{}), "-");
  EXPECT_EQ(clearance_text(tally_of(far)), "> 0.5 m");
  EXPECT_EQ(clearance_text(tally_of(engine_error)), "-");
  EXPECT_EQ(clearance_text(tally_of(unexplained)), "-");
  Tally all = tally_of(engine_error);
  all.add(tally_of(unexplained));
  EXPECT_EQ(clearance_text(all), "-");
  all.add(tally_of(far));
  EXPECT_EQ(clearance_text(all), "> 0.5 m");
  Outcome near = unexplained;
  near.min_clearance_um = 340'000;
  all.add(tally_of(near));
  EXPECT_EQ(clearance_text(all), "0.34 m");
  EXPECT_EQ(all.unmeasured_runs, 2U);
}

// As their ids count: AGVs, computers, obstacles, fallen loads.
TEST(Wording, ABodyHasTheNumberAmongItsKind) {
  const CellRecord cell{0, "central", "ring", 5, {0.4, 2.0}};
  EXPECT_EQ(body_name(EntityId{4U}, cell, {"broker", "server"}), "AGV 4");
  EXPECT_EQ(body_name(EntityId{6U}, cell, {"broker", "server"}), "server");
  EXPECT_EQ(body_name(EntityId{7U}, cell, {"broker", "server"}), "fallen load or obstacle 0");
  EXPECT_EQ(body_name(EntityId{5U}, cell, {}), "fallen load or obstacle 0");
}

}  // namespace
}  // namespace fleetproof::wording_test
