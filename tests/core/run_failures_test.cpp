#include "core/outcome/run_failures.hpp"

#include <gtest/gtest.h>

#include "core/outcome/run_result.hpp"
#include "core/scenario/faults.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::run_failures_test {
namespace {

constexpr double kEnd_s = 600.0;

Outcome run_with(std::vector<Violation> violations, std::vector<Incident> incidents = {}) {
  Outcome outcome;
  outcome.agv_count = 6;
  outcome.simulated_ns = 600'000'000'000;
  file_violations(outcome, std::move(violations));
  file_incidents(outcome, std::move(incidents));
  return outcome;
}

enum class Level : std::uint8_t { Near, Contact, Hazardous };
Violation violation(std::uint32_t a, std::uint32_t b, double first_s, Level level, double last_s = kEnd_s) {
  Violation violation;
  violation.a = EntityId{a};
  violation.b = EntityId{b};
  violation.first = at_seconds(first_s);
  violation.last = at_seconds(last_s);
  violation.contact = level != Level::Near;
  violation.relative_speed_um_s = level == Level::Hazardous ? kHazardousSpeed_um_s + 1 : 0;
  return violation;
}

Incident incident(IncidentKind kind, double first_s, double last_s, std::uint32_t a = 0) {
  return {kind, EntityId{a}, {}, at_seconds(first_s), at_seconds(last_s), 1};
}

std::vector<std::string> order_of(const Outcome& outcome) {
  std::vector<std::string> words;
  for (const RunFailure& failure : failures_of(outcome)) words.push_back(failure.what);
  return words;
}
using Words = std::vector<std::string>;

TEST(RunFailures, ACleanRunHasNone) { EXPECT_TRUE(failures_of(run_with({})).empty()); }

// A stall that no gate judges leaves the class of a run clean. What people read names it.
TEST(RunFailures, ARunThatStallsIsNotCalledClean) {
  const Outcome deadlock = run_with({}, {incident(IncidentKind::Deadlock, 10.0, kEnd_s)});
  ASSERT_EQ(deadlock.outcome_class(), OutcomeClass::Clean);
  EXPECT_EQ(end_of_run(deadlock), "deadlock");
  EXPECT_EQ(end_of_run(run_with({}, {incident(IncidentKind::Livelock, 10.0, 50.0)})), "livelock");
  EXPECT_EQ(end_of_run(run_with({}, {incident(IncidentKind::Starvation, 10.0, kEnd_s)})), "starvation");
  EXPECT_EQ(end_of_run(run_with({violation(0, 1, 300.0, Level::Near)})), name_of(OutcomeClass::Violation));
  EXPECT_EQ(end_of_run(run_with({})), "clean");
}

// What lasts to the end comes before what has passed; of equal ones, the earliest leads.
TEST(RunFailures, TheHeaviestLeadsWheneverItHappened) {
  const Outcome outcome =
      run_with({violation(0, 1, 300.0, Level::Near), violation(2, 3, 400.0, Level::Contact),
                violation(4, 5, 500.0, Level::Hazardous)},
               {incident(IncidentKind::LoadVanished, 250.0, 250.0), incident(IncidentKind::Starvation, 20.0, 60.0),
                incident(IncidentKind::BatteryEmpty, 150.0, kEnd_s), incident(IncidentKind::Livelock, 10.0, 50.0)});
  EXPECT_EQ(order_of(outcome), (Words{"contact at hazardous speed, two AGVs", "contact, two AGVs",
                                      "safety distance broken, two AGVs", "load-vanished, one body",
                                      "battery-empty, one body", "livelock, one body", "starvation, one body"}));
}

TEST(RunFailures, ACrashAndAHangStandBetweenWrongLoadsAndStalls) {
  Outcome outcome =
      run_with({}, {incident(IncidentKind::Deadlock, 20.0, kEnd_s), incident(IncidentKind::LoadHeldByTwo, 590.0, 590.0),
                    incident(IncidentKind::BatteryEmpty, 30.0, kEnd_s)});
  outcome.crash = outcome.hang = true;
  EXPECT_EQ(order_of(outcome),
            (Words{"load-held-by-two, one body", "crash", "hang", "battery-empty, one body", "deadlock, one body"}));
  EXPECT_FALSE(failures_of(outcome).back().is_judged) << "who crashed may have kept the others waiting";
}

TEST(RunFailures, AStallThatLastsComesBeforeAnEarlierOneThatPassed) {
  const Outcome outcome = run_with(
      {}, {incident(IncidentKind::Deadlock, 20.0, 90.0), incident(IncidentKind::Starvation, 300.0, kEnd_s, 3)});
  EXPECT_EQ(order_of(outcome), (Words{"starvation, one body", "deadlock, one body"}));
  EXPECT_TRUE(failures_of(outcome).back().is_over);
}

TEST(RunFailures, WhoHitsAWreckOrAFallenLoadDoesNotLead) {
  const Outcome outcome =
      run_with({violation(0, 6, 20.0, Level::Hazardous), violation(0, 1, 30.0, Level::Hazardous),
                violation(2, 3, 400.0, Level::Near)},
               {incident(IncidentKind::ForeignBody, 10.0, kEnd_s, 6), incident(IncidentKind::Deadlock, 100.0, kEnd_s)});
  EXPECT_EQ(order_of(outcome),
            (Words{"safety distance broken, two AGVs", "contact at hazardous speed, AGV and another body",
                   "contact at hazardous speed, two AGVs", "deadlock, one body"}));
}

TEST(RunFailures, WhatNothingIsJudgedOnStillHasAFirst) {
  EXPECT_EQ(order_of(run_with({violation(0, 6, 20.0, Level::Contact)})), (Words{"contact, AGV and another body"}));
  Outcome outcome = run_with({});
  outcome.stuck = true;
  EXPECT_EQ(order_of(outcome), (Words{"stuck"}));
}

TEST(RunFailures, TheChosenOneIsTheFirstOfItsEndPoint) {
  const Outcome outcome =
      run_with({violation(0, 1, 300.0, Level::Contact)},
               {incident(IncidentKind::Deadlock, 20.0, 90.0), incident(IncidentKind::Deadlock, 110.0, 190.0, 2)});
  EXPECT_EQ(chosen_failure(outcome, {})->what, "contact, two AGVs");
  const auto stall = chosen_failure(outcome, {bit_of(EndPoint::Deadlock)});
  ASSERT_TRUE(stall);
  EXPECT_EQ(stall->at, at_seconds(20.0));
  EXPECT_FALSE(chosen_failure(outcome, {bit_of(EndPoint::Crash)}));
}

// Software that differs from run to run: what is found anew is compared by class and pair, not by the instant.
TEST(RunFailures, TheSameOneHasItsClassAndItsPair) {
  const auto only = [](const Outcome& outcome) { return failures_of(outcome).front(); };
  const RunFailure contact = only(run_with({violation(0, 1, 300.0, Level::Contact)}));
  EXPECT_TRUE(is_same_failure(contact, only(run_with({violation(0, 1, 20.0, Level::Contact)}))));
  EXPECT_FALSE(is_same_failure(contact, only(run_with({violation(0, 2, 300.0, Level::Contact)}))));
  EXPECT_FALSE(is_same_failure(contact, only(run_with({violation(2, 1, 300.0, Level::Contact)}))));
  EXPECT_FALSE(is_same_failure(contact, only(run_with({violation(0, 1, 300.0, Level::Hazardous)}))));
  const RunFailure stall = only(run_with({}, {incident(IncidentKind::Deadlock, 20.0, kEnd_s, 3)}));
  EXPECT_FALSE(is_same_failure(stall, only(run_with({}, {incident(IncidentKind::Deadlock, 20.0, kEnd_s, 4)}))));
  EXPECT_FALSE(is_same_failure(stall, only(run_with({}, {incident(IncidentKind::Livelock, 20.0, kEnd_s, 3)}))));
}

// A column of the table decides, and every end point that one run can fail has its place in it.
TEST(RunFailures, EachEndPointOfARunHasAWeight) {
  for (const EndPointInfo& info : kEndPoints) {
    EXPECT_EQ(info.weight > 0, info.id != EndPoint::Throughput) << name_of(info.id);
    const bool may_pass = info.is_lack_of_progress || info.id == EndPoint::EmptyBattery;
    EXPECT_EQ(info.weight_if_over < info.weight, may_pass) << name_of(info.id);
  }
}

// Both tell the same, in words and in sets.
TEST(RunFailures, WhatIsJudgedIsWhatTheRunFails) {
  const Outcome outcome =
      run_with({violation(0, 1, 300.0, Level::Contact)},
               {incident(IncidentKind::Deadlock, 20.0, 90.0), incident(IncidentKind::Deadlock, 400.0, kEnd_s, 2)});
  std::uint32_t failed = 0;
  for (const RunFailure& failure : failures_of(outcome)) failed |= failure.is_judged ? bit_of(*failure.end_point) : 0;
  EXPECT_EQ(judged(outcome).failed, failed | bit_of(EndPoint::Violation)) << "a contact is a violation, too";
}

}  // namespace
}  // namespace fleetproof::run_failures_test
