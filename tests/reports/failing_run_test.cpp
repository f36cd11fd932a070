#include "reports/evidence/failing_run.hpp"

#include <gtest/gtest.h>

namespace fleetproof::failing_run_test {
namespace {

Violation near_miss(std::int64_t clearance_um, std::int64_t speed_um_s) {
  Violation violation;
  violation.min_clearance_um = clearance_um;
  violation.relative_speed_um_s = speed_um_s;
  return violation;
}

Violation contact(std::int64_t speed_um_s) {
  Violation violation = near_miss(0, speed_um_s);
  violation.contact = true;
  return violation;
}

TEST(FailingRuns, AreSortedByTheSeriousnessOfTheirEnds) {
  // The order of lists in reports; an error of the simulator stands behind what the software did.
  const OutcomeClass order[] = {OutcomeClass::Contact, OutcomeClass::Violation,     OutcomeClass::Crash,
                                OutcomeClass::Hang,    OutcomeClass::Indeterminate, OutcomeClass::EngineError,
                                OutcomeClass::Stuck};
  std::uint32_t before = 1000;
  for (const OutcomeClass id : order) {
    RunRecord run;
    for (const RunEnd& end : kRunEnds) run.outcome.*end.flag = end.seriousness <= find_run_end(id)->seriousness;
    const auto failing = FailingRun::of(run);
    ASSERT_TRUE(failing.has_value());
    EXPECT_EQ(failing->end, id);
    EXPECT_LT(failing->seriousness(), before) << failing->severity();
    before = failing->seriousness();
  }
}

RunRecord run_with(std::uint64_t index, std::vector<Violation> violations) {
  RunRecord run;
  run.run_index = index;
  run.outcome.violation = true;
  for (const Violation& violation : violations) run.outcome.contact |= violation.contact;
  run.outcome.violations = std::move(violations);
  run.outcome.min_clearance_um = 0;
  return run;
}

TEST(FailingRun, AHazardousContactLeadsBeforeAContactBeforeTheSmallestClearance) {
  const Violation slow = contact(100'000), fast = contact(900'000), fastest = contact(1'900'000);
  const Violation near = near_miss(20'000, 2'000'000), nearer = near_miss(10'000, 5'000);
  EXPECT_EQ(*worst_of({near, slow, nearer, fast, fastest}), fastest);
  EXPECT_EQ(*worst_of({near, slow, nearer}), slow);
  EXPECT_EQ(*worst_of({near, nearer}), nearer);
  EXPECT_EQ(*worst_of({contact(100'000), contact(200'000)}), contact(200'000));
  EXPECT_EQ(worst_of({}), nullptr);
}

TEST(FailingRun, OfEqualViolationsTheFirstLeads) {
  Violation first = contact(900'000), later = first;
  later.first = later.last = kStart + Duration{5};
  EXPECT_EQ(worst_of({first, later})->first, first.first);
  EXPECT_EQ(FailingRun::of(run_with(1, {first, later}))->worst, first);
}

TEST(FailingRun, RunsAreOrderedByTheirWorstViolation) {
  const auto hazardous = *FailingRun::of(run_with(9, {contact(100'000), contact(900'000)})),
             slow = *FailingRun::of(run_with(1, {contact(100'000), contact(200'000)})),
             near = *FailingRun::of(run_with(0, {near_miss(10'000, 0)}));
  WorstRuns worst(2);
  for (const FailingRun& run : {near, slow, hazardous}) worst.add(run);
  ASSERT_EQ(worst.list().size(), 2U);
  EXPECT_EQ(worst.list()[0].run_index, 9U);
  EXPECT_EQ(worst.list()[1].run_index, 1U);
}

}  // namespace
}  // namespace fleetproof::failing_run_test
