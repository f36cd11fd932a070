#include "core/outcome/run_result.hpp"

#include <gtest/gtest.h>

#include "tests/support/at_seconds.hpp"

namespace fleetproof::run_result_test {
namespace {

Incident incident(IncidentKind kind, double first_s) {
  Incident incident;
  incident.kind = kind;
  incident.first = at_seconds(first_s);
  return incident;
}

Outcome with_contact(double first_s, std::int64_t speed_um_s = 0) {
  Outcome outcome;
  Violation violation;
  violation.first = at_seconds(first_s);
  violation.contact = true;
  violation.relative_speed_um_s = speed_um_s;
  file_violations(outcome, {violation});
  return outcome;
}

TEST(RunResult, EveryIncidentOfAnEndPointFailsIt) {
  const std::pair<IncidentKind, EndPoint> kinds[] = {{IncidentKind::Deadlock, EndPoint::Deadlock},
                                                     {IncidentKind::Livelock, EndPoint::Livelock},
                                                     {IncidentKind::Starvation, EndPoint::Starvation},
                                                     {IncidentKind::StandstillInContract, EndPoint::Standstill},
                                                     {IncidentKind::BatteryEmpty, EndPoint::EmptyBattery},
                                                     {IncidentKind::LoadHeldByTwo, EndPoint::WrongLoad},
                                                     {IncidentKind::LoadVanished, EndPoint::WrongLoad},
                                                     {IncidentKind::LoadDeliveredTwice, EndPoint::WrongLoad},
                                                     {IncidentKind::LoadPickedByFullAgv, EndPoint::WrongLoad},
                                                     {IncidentKind::LoadAtWrongStation, EndPoint::WrongLoad},
                                                     {IncidentKind::LoadMovedByNobody, EndPoint::WrongLoad}};
  for (const auto& [kind, judged] : kinds) {
    Outcome outcome;
    outcome.incidents = {incident(kind, 50.0)};
    for (const EndPoint end_point : kValuesOf<EndPoint>) {
      if (end_point == EndPoint::Throughput) continue;
      EXPECT_EQ(result_of(outcome, end_point), end_point == judged ? RunResult::Failed : RunResult::Passed)
          << name_of(end_point);
    }
  }
}

TEST(RunResult, WhatStandsBehindAWreckIsItsConsequence) {
  Outcome before = with_contact(100.0), behind = with_contact(100.0);
  before.incidents = {incident(IncidentKind::Deadlock, 60.0)};
  behind.incidents = {incident(IncidentKind::Deadlock, 160.0)};
  EXPECT_EQ(result_of(before, EndPoint::Deadlock), RunResult::Failed);
  EXPECT_EQ(result_of(behind, EndPoint::Deadlock), RunResult::Unknown);
  EXPECT_EQ(result_of(behind, EndPoint::Contact), RunResult::Failed);
  EXPECT_EQ(result_of(with_contact(100.0), EndPoint::Starvation), RunResult::Unknown)
      << "whether the fleet would have gone on is not known";
}

TEST(RunResult, OfARunThatEndedEarlyIsUnknownUnlessItFailedBefore) {
  Outcome crash;
  crash.crash = true;
  EXPECT_EQ(result_of(crash, EndPoint::Crash), RunResult::Failed);
  for (const EndPoint end_point : {EndPoint::Violation, EndPoint::Hang, EndPoint::Deadlock, EndPoint::WrongLoad})
    EXPECT_EQ(result_of(crash, end_point), RunResult::Unknown) << name_of(end_point);
  Outcome both = with_contact(10.0);
  both.crash = true;
  EXPECT_EQ(result_of(both, EndPoint::Violation), RunResult::Failed);
}

TEST(RunResult, OnlyAFastContactIsHazardous) {
  EXPECT_EQ(result_of(with_contact(1.0, kHazardousSpeed_um_s), EndPoint::HazardousContact), RunResult::Passed);
  EXPECT_EQ(result_of(with_contact(1.0, kHazardousSpeed_um_s + 1), EndPoint::HazardousContact), RunResult::Failed);
}

}  // namespace
}  // namespace fleetproof::run_result_test
