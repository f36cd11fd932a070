// How long a run was at risk of failing an end point: worked out by hand, for four AGVs.
#include <gtest/gtest.h>

#include "reports/evidence/run_result.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::time_at_risk_test {
namespace {

Outcome of_100_s() {
  Outcome outcome;
  outcome.agv_count = 4;
  outcome.simulated_ns = 100'000'000'000;
  return outcome;
}

Violation violation_at(double first_s, double last_s, bool contact = false, std::uint32_t other = 1) {
  Violation violation;
  violation.a = EntityId{0U};
  violation.b = EntityId{other};
  violation.first = at_seconds(first_s);
  violation.closest_at = violation.last = at_seconds(last_s);
  violation.contact = contact;
  return violation;
}

Incident incident_at(IncidentKind kind, double first_s, double last_s) {
  Incident incident{};
  incident.kind = kind;
  incident.first = at_seconds(first_s);
  incident.last = at_seconds(last_s);
  return incident;
}

// In seconds of the run.
void expect_at_risk(const Outcome& outcome, EndPoint end_point, double least_s, double most_s) {
  const TimeAtRisk time = time_at_risk(outcome, end_point, result_of(outcome, end_point));
  EXPECT_DOUBLE_EQ(static_cast<double>(time.least_us) / 4e6, least_s) << name_of(end_point);
  EXPECT_DOUBLE_EQ(static_cast<double>(time.most_us) / 4e6, most_s) << name_of(end_point);
}

TEST(TimeAtRisk, IsTheWholeRunIfNothingHappened) {
  for (const EndPoint end_point : {EndPoint::Violation, EndPoint::Deadlock, EndPoint::WrongLoad, EndPoint::Hang})
    expect_at_risk(of_100_s(), end_point, 100.0, 100.0);
}

TEST(TimeAtRisk, EndsWhereTheDistanceIsBroken) {
  Outcome outcome = of_100_s();
  file_violations(outcome, {violation_at(40, 45), violation_at(20, 30, true)});
  expect_at_risk(outcome, EndPoint::Violation, 20.0, 20.0);
  expect_at_risk(outcome, EndPoint::Contact, 20.0, 30.0);  // somewhere in the approach
  file_violations(outcome, {violation_at(10, 45), violation_at(20, 30, true)});
  expect_at_risk(outcome, EndPoint::Violation, 10.0, 10.0);
  expect_at_risk(outcome, EndPoint::Contact, 20.0, 30.0);
}

TEST(TimeAtRisk, OfViolationsWithObstaclesIsOpen) {
  Outcome outcome = of_100_s();
  file_violations(outcome, {violation_at(10, 12, false, 4), violation_at(50, 51)});  // body 4 is no AGV
  expect_at_risk(outcome, EndPoint::Violation, 50.0, 50.0);
  file_violations(outcome, {violation_at(10, 12, false, 4)});
  expect_at_risk(outcome, EndPoint::Violation, 0.0, 100.0);
}

TEST(TimeAtRisk, OfALackOfProgressEndsWhenItCanBeCalledSo) {
  Outcome outcome = of_100_s();
  file_incidents(
      outcome, {incident_at(IncidentKind::Deadlock, 30, 90), incident_at(IncidentKind::Livelock, 40, 80),
                incident_at(IncidentKind::StandstillInContract, 60, 70), incident_at(IncidentKind::Deadlock, 20, 21)});
  expect_at_risk(outcome, EndPoint::Deadlock, 20.0, 20.0);
  expect_at_risk(outcome, EndPoint::Livelock, 40.0, 80.0);  // dated from the last progress
  expect_at_risk(outcome, EndPoint::Standstill, 60.0, 60.0);
  expect_at_risk(outcome, EndPoint::Starvation, 100.0, 100.0);
  file_violations(outcome, {violation_at(10, 100, true)});
  expect_at_risk(outcome, EndPoint::Deadlock, 0.0, 100.0);  // behind a wreck: unknown
}

TEST(TimeAtRisk, OfLoadsAndBatteriesEndsAtTheFirst) {
  Outcome outcome = of_100_s();
  file_incidents(
      outcome, {incident_at(IncidentKind::LoadAtWrongStation, 33, 33), incident_at(IncidentKind::LoadVanished, 12, 13),
                incident_at(IncidentKind::BatteryEmpty, 5, 9)});
  expect_at_risk(outcome, EndPoint::WrongLoad, 12.0, 12.0);
  expect_at_risk(outcome, EndPoint::EmptyBattery, 5.0, 5.0);
}

TEST(TimeAtRisk, OfACrashIsOpenBecauseNobodyKnowsItsInstant) {
  Outcome outcome = of_100_s();
  outcome.crash = true;
  for (const EndPoint end_point : {EndPoint::Crash, EndPoint::Violation, EndPoint::Deadlock})
    expect_at_risk(outcome, end_point, 0.0, 100.0);
  outcome.violation = true;  // without a list of violations
  expect_at_risk(outcome, EndPoint::Violation, 0.0, 100.0);
}

}  // namespace
}  // namespace fleetproof::time_at_risk_test
