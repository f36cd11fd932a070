#include "reports/evidence/first_cause.hpp"

#include <gtest/gtest.h>

#include "core/outcome/foreign_bodies.hpp"
#include "core/outcome/run_result.hpp"
#include "core/scenario/faults.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::first_cause_test {
namespace {

constexpr std::uint32_t kAgvs = 4;

// Four AGVs, bodies 0 to 3; 4 and above are obstacles and fallen loads.
Outcome run_with(std::vector<Violation> violations, std::vector<Incident> incidents = {}) {
  Outcome outcome;
  outcome.agv_count = kAgvs;
  outcome.simulated_ns = 600'000'000'000;
  file_violations(outcome, std::move(violations));
  file_incidents(outcome, std::move(incidents));
  return outcome;
}

// A contact lasts to the end of the run, as if the two stayed where they are.
Violation violation(std::uint32_t a, std::uint32_t b, double first_s, bool contact = false, double last_s = 600.0) {
  Violation violation;
  violation.a = EntityId{a};
  violation.b = EntityId{b};
  violation.first = at_seconds(first_s);
  violation.last = at_seconds(last_s);
  violation.contact = contact;
  return violation;
}

Incident fault(Fault::Kind kind, std::uint32_t agv, double first_s) {
  return {IncidentKind::FaultInjected, EntityId{agv},         {}, at_seconds(first_s),
          at_seconds(first_s + 5.0),   static_cast<int>(kind)};
}

Incident body(std::uint32_t id, double first_s, double last_s) {
  return {IncidentKind::ForeignBody, EntityId{id}, {}, at_seconds(first_s), at_seconds(last_s), 1};
}

Incident deadlock(double first_s, double last_s) {
  return {IncidentKind::Deadlock, EntityId{0u}, EntityId{1u}, at_seconds(first_s), at_seconds(last_s), 2};
}

TEST(FirstCause, ACleanRunHasNone) { EXPECT_FALSE(first_cause(run_with({}, {body(4, 1.0, 9.0)})).has_value()); }

TEST(FirstCause, AContactLeadsEvenIfADeadlockCameBefore) {
  const auto outcome = run_with({violation(0, 1, 200.0, true)}, {deadlock(50.0, 180.0)});
  const auto cause = first_cause(outcome);
  ASSERT_TRUE(cause);
  EXPECT_EQ(cause->what, "contact, two AGVs");
  EXPECT_EQ(cause->at, at_seconds(200.0));
  EXPECT_EQ(cause->before, CameBefore::Nothing);
}

TEST(FirstCause, AContactBeforeADeadlockLeads) {
  EXPECT_EQ(first_cause(run_with({violation(0, 1, 20.0, true)}, {deadlock(50.0, 180.0)}))->what, "contact, two AGVs");
}

TEST(CameBefore, AFaultOfAnAgvInvolvedIsOneThatTheSoftwareCouldKnowOf) {
  const auto cause = first_cause(run_with({violation(0, 1, 20.0)}, {fault(Fault::Kind::Restart, 1, 17.5)}));
  EXPECT_EQ(cause->before, CameBefore::KnownFault);
  EXPECT_EQ(fault_text(*cause, "AGV 1"), "2.50 s after the restart of AGV 1 began");
}

TEST(CameBefore, FaultsOfOthersOrLaterOnesDoNotTouchThePair) {
  EXPECT_EQ(first_cause(run_with({violation(0, 1, 20.0)}, {fault(Fault::Kind::Restart, 2, 17.5)}))->before,
            CameBefore::Nothing);
  EXPECT_EQ(first_cause(run_with({violation(0, 1, 20.0)}, {fault(Fault::Kind::Restart, 1, 20.5)}))->before,
            CameBefore::Nothing);
}

// Whichever AGVs they are, their computers count.
TEST(CameBefore, AFaultOfAComputerTouchesEveryPair) {
  const auto cause = first_cause(run_with({violation(0, 1, 20.0)}, {fault(Fault::Kind::DiskLoss, kAgvs + 1, 17.5)}));
  EXPECT_EQ(cause->before, CameBefore::KnownFault);
  EXPECT_EQ(fault_text(*cause, "computer 1"), "2.50 s after the disk-loss of computer 1 began");
}

TEST(CameBefore, OfAFallenLoadNoSoftwareIsTold) {
  const auto cause = first_cause(run_with({violation(0, 4, 20.0, true)}, {body(4, 10.0, 300.0)}));
  EXPECT_EQ(cause->what, "contact, AGV and another body");
  EXPECT_EQ(cause->before, CameBefore::ForeignBody);
  EXPECT_EQ(fault_text(*cause, ""), "10.00 s after a load fell");
}

TEST(CameBefore, WhetherADroppedLoadMatteredToItsAgvIsUndecided) {
  EXPECT_EQ(first_cause(run_with({violation(0, 1, 20.0)}, {fault(Fault::Kind::LoadDrop, 1, 5.0)}))->before,
            CameBefore::Undecided);
}

TEST(CameBefore, ADeadlockAfterSomeFaultIsUndecided) {
  EXPECT_EQ(first_cause(run_with({}, {fault(Fault::Kind::Freeze, 3, 5.0), deadlock(50.0, 180.0)}))->before,
            CameBefore::Undecided);
}

TEST(CameBefore, TheLastFaultIsNamed) {
  const auto cause = first_cause(
      run_with({violation(0, 1, 20.0)}, {fault(Fault::Kind::Restart, 1, 5.0), fault(Fault::Kind::Freeze, 0, 15.0)}));
  EXPECT_EQ(fault_text(*cause, "AGV 0"), "5.00 s after the freeze of AGV 0 began");
}

TEST(CameBefore, AForeignBodyIsNamedRatherThanALaterFaultOfItsAgv) {
  const auto cause =
      first_cause(run_with({violation(0, 4, 20.0)}, {body(4, 10.0, 300.0), fault(Fault::Kind::Restart, 0, 19.0)}));
  EXPECT_EQ(cause->before, CameBefore::ForeignBody);
  EXPECT_EQ(fault_text(*cause, ""), "10.00 s after a load fell");
}

TEST(CameBefore, AContactThatFollowsADeadlockIsNotOfTheFaultOfAnother) {
  EXPECT_EQ(
      first_cause(run_with({violation(0, 1, 200.0, true)}, {fault(Fault::Kind::Freeze, 3, 5.0), deadlock(50.0, 180.0)}))
          ->before,
      CameBefore::Nothing);
}

TEST(CameBefore, CountedFaultsThatNoLawNotedAreUndecided) {
  Outcome outcome = run_with({}, {deadlock(50.0, 180.0)});
  outcome.counters.faults = 1;
  EXPECT_EQ(first_cause(outcome)->before, CameBefore::Undecided);
  Outcome noted = run_with({}, {deadlock(50.0, 180.0), fault(Fault::Kind::Freeze, 3, 300.0)});
  noted.counters.faults = 1;
  EXPECT_EQ(first_cause(noted)->before, CameBefore::Nothing) << "the fault came later";
}

TEST(ForeignBodies, RunsWithThemAloneAreUnknown) {
  const Outcome outcome = run_with({violation(0, 4, 20.0, true)});
  for (const EndPoint end_point : {EndPoint::Violation, EndPoint::Contact})
    EXPECT_EQ(result_of(outcome, end_point), RunResult::Unknown) << name_of(end_point);
}

TEST(ForeignBodies, APairOfAgvsStillRefutes) {
  EXPECT_EQ(result_of(run_with({violation(0, 4, 20.0, true), violation(1, 2, 30.0)}), EndPoint::Violation),
            RunResult::Failed);
  EXPECT_EQ(result_of(run_with({violation(0, 4, 20.0, true), violation(1, 2, 30.0)}), EndPoint::Contact),
            RunResult::Unknown)
      << "the only contact is that with the load";
}

TEST(ForeignBodies, WhoRunsIntoTheWreckOfOneIsNoFindingEither) {
  const Outcome chain = run_with({violation(0, 4, 20.0, true), violation(0, 1, 30.0, true), violation(1, 2, 40.0)});
  EXPECT_EQ(answerable(chain), (std::vector<bool>{false, false, false}));
  const Outcome near_only = run_with({violation(0, 4, 20.0), violation(0, 1, 30.0, true)});
  EXPECT_EQ(answerable(near_only), (std::vector<bool>{false, true})) << "AGV 0 passed the load and drove on";
}

TEST(ForeignBodies, AWreckLiesThereUntilTheLastOfItsContactsEnds) {
  const Outcome outcome =
      run_with({violation(0, 4, 20.0, true), violation(0, 1, 30.0, true, 35.0), violation(0, 2, 40.0)});
  EXPECT_EQ(answerable(outcome), (std::vector<bool>{false, false, false}));
}

TEST(ForeignBodies, AreMetOnTheFloorOrInAViolation) {
  EXPECT_TRUE(met_foreign_bodies(run_with({}, {body(4, 1.0, 9.0)})));
  EXPECT_TRUE(met_foreign_bodies(run_with({violation(0, 4, 20.0)}))) << "an obstacle from the start is not filed";
  EXPECT_FALSE(met_foreign_bodies(run_with({violation(0, 1, 20.0)}, {fault(Fault::Kind::Restart, 1, 5.0)})));
}

TEST(ForeignBodies, AnAgvThatDrivesOnAfterwardsIsLikeAnyOther) {
  const Outcome outcome = run_with({violation(0, 4, 20.0, true, 25.0), violation(0, 1, 30.0, true)});
  EXPECT_EQ(answerable(outcome), (std::vector<bool>{false, true}));
  EXPECT_EQ(result_of(outcome, EndPoint::Contact), RunResult::Failed);
}

TEST(FirstCause, AStarvationIsDatedFromTheLastProgressAndJudgedOnlyIfItWasOverBefore) {
  const Incident starvation{IncidentKind::Starvation, EntityId{2u}, {}, at_seconds(10.0), at_seconds(300.0), 1};
  const Outcome around = run_with({violation(0, 1, 17.0, true)}, {starvation});
  EXPECT_EQ(first_cause(around)->what, "contact, two AGVs");
  EXPECT_EQ(result_of(around, EndPoint::Starvation), RunResult::Unknown);
  const Outcome before = run_with({violation(0, 1, 400.0, true)}, {starvation});
  EXPECT_EQ(first_cause(before)->what, "contact, two AGVs");
  EXPECT_EQ(result_of(before, EndPoint::Starvation), RunResult::Failed);
}

TEST(ForeignBodies, AStandstillWhileOneLayIsUnknown) {
  EXPECT_EQ(result_of(run_with({}, {body(4, 60.0, 90.0), deadlock(50.0, 180.0)}), EndPoint::Deadlock),
            RunResult::Unknown);
  EXPECT_EQ(result_of(run_with({}, {body(4, 10.0, 40.0), deadlock(50.0, 180.0)}), EndPoint::Deadlock),
            RunResult::Failed)
      << "it was cleared before";
  EXPECT_EQ(result_of(run_with({}, {body(4, 200.0, 240.0), deadlock(50.0, 180.0)}), EndPoint::Deadlock),
            RunResult::Failed)
      << "it fell afterwards";
}

}  // namespace
}  // namespace fleetproof::first_cause_test
