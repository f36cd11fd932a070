#include "campaign/findings/circumstances.hpp"

#include <gmock/gmock.h>

namespace fleetproof::circumstances_test {
namespace {

using testing::HasSubstr;

SimTime at_s(double t_s) { return kStart + seconds(t_s); }

MessageDelivery message(std::uint32_t from, std::uint32_t to, double sent_s, double arrives_s) {
  MessageDelivery message;
  message.delivery.sender = AgvId{from};
  message.delivery.receiver = AgvId{to};
  message.delivery.sent = seconds(sent_s);
  message.on_its_way = seconds(arrives_s - sent_s);
  return message;
}

Departure drive(std::uint32_t agv, double at, double arrives) {
  Departure drive;
  drive.agv = AgvId{agv};
  drive.at = at_s(at);
  drive.arrives = at_s(arrives);
  return drive;
}

Fault fault(Fault::Kind kind, std::uint32_t agv, double at) {
  Fault fault;
  fault.kind = kind;
  fault.agv = AgvId{agv};
  fault.at = seconds(at);
  return fault;
}

// AGV 1 has stood since 3 s, and drove for 3 s before. AGV 0 sets off at 8 s, and comes too close at 10 s. AGV 0 hears
// AGV 1 at 7.5 s and at 9 s; it has sent it three messages, of which one was lost.
CaseRun close_call() {
  CaseRun run;
  Violation violation;
  violation.a = EntityId{0U};
  violation.b = EntityId{1U};
  violation.first = violation.last = violation.closest_at = at_s(10.0);
  run.outcome.violations.push_back(violation);
  run.itinerary.departures = {drive(1, 0.0, 3.0), drive(0, 1.0, 4.0), drive(0, 8.0, 12.0), drive(1, 11.0, 13.0)};
  run.deliveries = {message(1, 0, 6.0, 7.5), message(1, 0, 8.5, 9.0), message(1, 0, 9.5, 10.5), message(0, 1, 1.0, 2.0),
                    message(0, 1, 2.0, 3.0), message(0, 1, 9.0, 9.0), message(0, 2, 9.0, 9.1)};
  run.deliveries[5].delivery.lost = true;
  return run;
}

Scenario of_three() {
  Scenario scenario;
  scenario.agvs.resize(3);
  const auto restarts = Fault::Kind::Restart;
  scenario.faults = {fault(restarts, 1, 2.0), fault(restarts, 1, 6.0), fault(restarts, 1, 11.0),
                     fault(Fault::Kind::Breakdown, 0, 1.0)};
  return scenario;
}

TEST(Circumstances, AreThoseOfTheTwoUntilItCame) {
  const auto found = circumstances_of(close_call(), of_three());
  EXPECT_EQ(found.at("came (s)"), 10.0);
  EXPECT_EQ(found.at("later: set off (s before)"), 2.0);
  EXPECT_EQ(found.at("later: stood (s)"), 0.0);
  EXPECT_EQ(found.at("later: drives"), 2.0);
  EXPECT_EQ(found.at("later: restarted (s before)"), kNever_s);
  EXPECT_EQ(found.at("later: heard (s before)"), 1.0);
  EXPECT_EQ(found.at("later: messages heard"), 2.0);
  EXPECT_EQ(found.at("later, setting off: heard (s before)"), 0.5);
  EXPECT_EQ(found.at("later, setting off: messages heard"), 1.0);
  EXPECT_EQ(found.at("other: stood (s)"), 7.0);
  EXPECT_EQ(found.at("other: drives"), 1.0);
  EXPECT_EQ(found.at("other: restarted (s before)"), 4.0);
  EXPECT_EQ(found.at("other: messages heard"), 2.0) << "one was lost";
  EXPECT_EQ(found.at("other, setting off: heard (s before)"), kNever_s);
}

TEST(Circumstances, ATurnIsSettingOffToo) {
  CaseRun run = close_call();
  run.itinerary.turns = {drive(1, 9.5, 10.5)};
  const auto found = circumstances_of(run, of_three());
  EXPECT_EQ(found.at("later: set off (s before)"), 0.5);
  EXPECT_EQ(found.at("later: restarted (s before)"), 4.0) << "now AGV 1 is the later one";
}

TEST(Circumstances, NeedTwoAgvs) {
  CaseRun run = close_call();
  run.outcome.violations[0].b = EntityId{3U};  // an obstacle
  EXPECT_TRUE(circumstances_of(run, of_three()).empty());
  run.outcome.violations.clear();
  EXPECT_TRUE(circumstances_of(run, of_three()).empty());
}

Circumstances of_values(std::size_t count, double from, double step) {
  std::vector<std::map<std::string, double>> failures;
  for (std::size_t i = 0; i < count; ++i) failures.push_back({{"came (s)", from + step * static_cast<double>(i)}});
  return circumstances_of(failures);
}

TEST(Circumstances, AreFiveValuesOfManyFailures) {
  EXPECT_TRUE(of_values(7, 1.0, 1.0).empty()) << "too few";
  EXPECT_THAT(of_values(10, 1.0, 1.0).at("came (s)"), testing::ElementsAre(2, 4, 6, 8, 10));
  EXPECT_THAT(of_values(40, 0.0, 1.0).at("came (s)"), testing::ElementsAre(4, 12, 20, 28, 36));
}

TEST(Circumstances, TellFailuresApartIfOneKindHasMoreNearlyAlways) {
  const Circumstances before = of_values(20, 0.0, 1.0);
  EXPECT_THAT(told_apart_by(before, of_values(20, 19.0, 1.0)), testing::StrEq("\"came (s)\" is 29.0, and was 10.0"));
  EXPECT_NE(told_apart_by(of_values(20, 19.0, 1.0), before), "") << "less tells, too";
  EXPECT_EQ(told_apart_by(before, before), "");
  EXPECT_EQ(told_apart_by(before, of_values(20, 10.0, 1.0)), "") << "seven in eight";
  EXPECT_EQ(told_apart_by(before, of_values(7, 1000.0, 0.0)), "") << "too few to tell";
  EXPECT_EQ(told_apart_by({}, before), "");
}

// All failures may have the same figure, which 5 ms more of thinking change in all of them.
TEST(Circumstances, SmallDifferencesAreThoseOfTiming) {
  EXPECT_EQ(told_apart_by(of_values(20, 2.0, 0.0), of_values(20, 2.02, 0.0)), "");
  EXPECT_NE(told_apart_by(of_values(20, 2.0, 0.0), of_values(20, 2.5, 0.0)), "");
}

// Half a mend may leave failures in one world only: they are as they were there.
TEST(Circumstances, AreComparedWorldByWorld) {
  const Circumstances early = of_values(20, 0.0, 1.0), late = of_values(20, 100.0, 1.0),
                      later = of_values(20, 200.0, 1.0);
  const auto told = [](const std::vector<Circumstances>& before, const std::vector<Circumstances>& now) {
    return told_apart_by(before, now);
  };
  EXPECT_EQ(told({early, late}, {{}, late}), "");
  EXPECT_NE(told({early, late}, {{}, later}), "");
  EXPECT_NE(told({early, late}, {late, later}), "");
  EXPECT_EQ(told({early, late}, {late, late}), "") << "some are as they were";
  EXPECT_EQ(told({{}, late}, {late}), "") << "nothing can be compared";
}

TEST(Circumstances, WhatNeverHappenedIsSaid) {
  EXPECT_THAT(told_apart_by(of_values(10, 2.0, 0.0), of_values(10, kNever_s, 0.0)), HasSubstr("is never, and was 2.0"));
}

}  // namespace
}  // namespace fleetproof::circumstances_test
