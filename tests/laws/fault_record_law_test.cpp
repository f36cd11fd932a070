#include "laws/fault_record_law.hpp"

#include <gmock/gmock.h>

#include "tests/laws/told.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::fault_record_law_test {
namespace {

using testing::ElementsAre;

Incident noted(IncidentKind kind, std::uint32_t body, double first_s, double last_s, std::int64_t value) {
  return {kind, EntityId{body}, {}, at_seconds(first_s), at_seconds(last_s), value};
}

TEST(FaultRecord, NotesEachFaultFromItsBeginningToItsEnd) {
  const Scenario scenario = row_scenario(2, {0, 1});
  Told told(scenario, "faults");
  told.strikes(1.0, 0, Fault::Kind::Restart)
      .record(3.5, 0, traced::FaultOver{Fault::Kind::Restart, 0})
      .strikes(4.0, 1, Fault::Kind::Breakdown);
  EXPECT_THAT(told.finish(10.0).incidents,
              ElementsAre(noted(IncidentKind::FaultInjected, 0, 1.0, 3.5, static_cast<int>(Fault::Kind::Restart)),
                          noted(IncidentKind::FaultInjected, 1, 4.0, 10.0, static_cast<int>(Fault::Kind::Breakdown))));
}

TEST(FaultRecord, TellsFaultsApartThatLastAtTheSameTime) {
  const Scenario scenario = row_scenario(2, {0, 1});
  Told told(scenario, "faults");
  told.record(1.0, 0, traced::FaultStrikes{Fault::Kind::Restart, 0})
      .record(2.0, 0, traced::FaultStrikes{Fault::Kind::Freeze, 1})
      .record(3.0, 1, traced::FaultStrikes{Fault::Kind::Restart, 0})
      .record(4.0, 0, traced::FaultOver{Fault::Kind::Restart, 0})
      .record(5.0, 1, traced::FaultOver{Fault::Kind::Restart, 0});
  EXPECT_THAT(told.finish(10.0).incidents,
              ElementsAre(noted(IncidentKind::FaultInjected, 0, 1.0, 4.0, static_cast<int>(Fault::Kind::Restart)),
                          noted(IncidentKind::FaultInjected, 0, 2.0, 10.0, static_cast<int>(Fault::Kind::Freeze)),
                          noted(IncidentKind::FaultInjected, 1, 3.0, 5.0, static_cast<int>(Fault::Kind::Restart))));
}

TEST(FaultRecord, NotesBodiesOnTheFloorAndNotAgvsThatAreSetDown) {
  Scenario scenario = row_scenario(2, {0, 1});
  scenario.obstacles.emplace_back();
  Told told(scenario, "faults");
  told.leaves(1.0, 0).appears(2.0, 0);  // an AGV in the hands of the operator
  told.appears(3.0, 2).leaves(5.0, 2).appears(6.0, 3);
  EXPECT_THAT(told.finish(10.0).incidents, ElementsAre(noted(IncidentKind::ForeignBody, 2, 3.0, 5.0, 0),
                                                       noted(IncidentKind::ForeignBody, 3, 6.0, 10.0, 1)));
}

Scenario with_faults(std::vector<Fault> faults) {
  Scenario scenario = row_scenario(2, {0, 1});
  scenario.horizon = seconds(10.0);
  scenario.faults = std::move(faults);
  return scenario;
}

Fault fault_of(Fault::Kind kind, std::uint32_t agv, double at_s) {
  Fault fault;
  fault.kind = kind, fault.agv = AgvId{agv}, fault.at = seconds(at_s);
  return fault;
}

TEST(DeniedRequests, OfFaultsHaveTheirReason) {
  const Scenario scenario = with_faults({fault_of(Fault::Kind::Freeze, 0, 1.0), fault_of(Fault::Kind::LoadDrop, 1, 2.0),
                                         fault_of(Fault::Kind::LoadDrop, 1, 3.0)});
  Told told(scenario, "faults");
  told.record(1.0, 0, traced::Denied{Denial::AgentAway, 0})
      .record(2.0, 1, traced::Denied{Denial::NoRoom, 1})
      .record(3.0, 1, traced::Denied{Denial::NoSuchLoad, 2});
  EXPECT_THAT(told.finish(10.0).incidents,
              ElementsAre(noted(IncidentKind::FaultWithoutEffect, 0, 1.0, 1.0, static_cast<int>(Fault::Kind::Freeze)),
                          noted(IncidentKind::LoadDidNotFall, 1, 2.0, 2.0, kNoRoomForLoad),
                          noted(IncidentKind::LoadDidNotFall, 1, 3.0, 3.0, kNoSuchLoad)));
}

// Obstacles 2, 3 and 4: one comes late, one leaves before it could come, one waits to the end.
TEST(DeniedRequests, OfObstaclesLastAsLongAsTheyAreNotThere) {
  Scenario scenario = with_faults({});
  scenario.obstacles.resize(3);
  for (ObstacleSetup& obstacle : scenario.obstacles) obstacle.appears = seconds(2.0), obstacle.leaves = seconds(6.0);
  scenario.obstacles[2].leaves = kLongestDuration;
  Told told(scenario, "faults");
  for (const std::uint32_t body : {2U, 3U, 4U}) told.record(2.0, body, traced::Denied{Denial::NoRoom, 0});
  told.appears(4.0, 2).leaves(6.0, 2);
  EXPECT_THAT(told.finish(10.0).incidents,
              ElementsAre(noted(IncidentKind::ObstacleWithoutRoom, 2, 2.0, 4.0, kCameLater),
                          noted(IncidentKind::ObstacleWithoutRoom, 3, 2.0, 6.0, kNeverCame),
                          noted(IncidentKind::ObstacleWithoutRoom, 4, 2.0, 10.0, kNeverCame),
                          noted(IncidentKind::ForeignBody, 2, 4.0, 6.0, kObstacle)));
}

TEST(DeniedRequests, AreWhatTheEndOfTheRunCameBefore) {
  Fault from_pick = fault_of(Fault::Kind::Breakdown, 1, 1.0);
  from_pick.transport = 0;
  Scenario scenario =
      with_faults({fault_of(Fault::Kind::Restart, 0, 10.0), fault_of(Fault::Kind::Restart, 0, 10.5), from_pick});
  scenario.agvs[1].transports = {{StationId{0U}, StationId{1U}, seconds(10.0)},
                                 {StationId{0U}, StationId{1U}, seconds(11.0)}};
  scenario.agvs[1].script = {{seconds(12.0), ScriptedCall::Action::Park, {}}};
  scenario.obstacles.resize(2);
  scenario.obstacles[0].appears = seconds(11.0), scenario.obstacles[1].appears = seconds(10.0);
  Told told(scenario, "faults");
  told.record(10.0, 0, traced::FaultStrikes{Fault::Kind::Restart, 0});
  EXPECT_THAT(told.finish(10.0).incidents,
              ElementsAre(noted(IncidentKind::FaultInjected, 0, 10.0, 10.0, static_cast<int>(Fault::Kind::Restart)),
                          noted(IncidentKind::NotReached, 0, 10.0, 10.0, 1),    // the second restart
                          noted(IncidentKind::NotReached, 1, 10.0, 10.0, 3),    // a pick, an order and a call
                          noted(IncidentKind::NotReached, 2, 10.0, 10.0, 1)));  // the first obstacle
}

TEST(DeniedRequests, AreCallsOfAScriptThatTheControllerRefuses) {
  Scenario scenario = with_faults({});
  scenario.agvs[0].script = {{seconds(1.0), ScriptedCall::Action::Move, SegmentId{0U}},
                             {seconds(4.0), ScriptedCall::Action::Pick, {}},
                             {seconds(5.0), ScriptedCall::Action::Move, SegmentId{0U}}};
  const auto incidents_of = [&] {
    Told told(scenario, "faults");
    told.record(5.0, 0, traced::CallRefused{0, SegmentId{0U}}).record(4.0, 0, traced::CallRefused{1, {}});
    told.record(4.0, 0, traced::CallRefused{2, {}});  // no such call in the script
    return told.finish(10.0).incidents;
  };
  EXPECT_THAT(incidents_of(), ElementsAre(noted(IncidentKind::CallNotMade, 0, 4.0, 4.0, 1),
                                          noted(IncidentKind::CallNotMade, 0, 5.0, 5.0, 2)));
  scenario.agent = "hull-lock";
  EXPECT_THAT(incidents_of(), ElementsAre(noted(IncidentKind::NotReached, 0, 10.0, 10.0, 3)))
      << "nobody plays the script";
}

// Calls: a refused pick, a pick that is cut short and begins anew, a drop, a pick, a drop.
TEST(DeniedRequests, AreTransfersOfAScriptThatMoveNoLoad) {
  Scenario scenario = with_faults({});
  for (const auto action : {ScriptedCall::Action::Pick, ScriptedCall::Action::Pick, ScriptedCall::Action::Drop,
                            ScriptedCall::Action::Pick, ScriptedCall::Action::Drop})
    scenario.agvs[1].script.push_back({seconds(1.0 + static_cast<double>(scenario.agvs[1].script.size())), action, {}});
  Told told(scenario, "faults");
  const auto transfer = [&](double from_s, ActivityKind kind, LoadId load, bool as_planned = true) {
    told.record(from_s, 1, traced::ActivityBegins{kind, load.value});
    told.record(from_s + 0.5, 1, traced::ActivityEnds{kind, as_planned});
  };
  told.record(1.0, 1, traced::CallRefused{1, {}});
  transfer(2.0, ActivityKind::Pick, {}, false);
  transfer(3.0, ActivityKind::Pick, {});
  transfer(4.0, ActivityKind::Drop, {});
  transfer(5.0, ActivityKind::Pick, LoadId{0U});
  transfer(6.0, ActivityKind::Drop, LoadId{0U});
  EXPECT_THAT(told.finish(10.0).incidents, ElementsAre(noted(IncidentKind::CallNotMade, 1, 1.0, 1.0, 0),
                                                       noted(IncidentKind::CallWithoutEffect, 1, 3.5, 3.5, 1),
                                                       noted(IncidentKind::CallWithoutEffect, 1, 4.5, 4.5, 2)));
}

TEST(DeniedRequests, AreMessagesThatAreNeverSent) {
  Scenario scenario = with_faults({});
  const auto given = [](std::uint32_t sender, std::uint32_t receiver, double sent_s) {
    GivenDelivery delivery;
    delivery.sender = AgvId{sender}, delivery.receiver = AgvId{receiver}, delivery.sent = seconds(sent_s);
    return delivery;
  };
  scenario.deliveries = {given(1, 0, 3.0), given(0, 1, 2.0), given(1, 0, 1.0), given(1, 0, 11.0)};
  Told told(scenario, "faults");
  for (const std::uint32_t number : {0U, 2U, 3U}) told.record(10.0, 1, traced::Denied{Denial::NotSent, number});
  told.record(10.0, 0, traced::Denied{Denial::NoSuchKind, 0}).record(10.0, 0, traced::Denied{Denial::NoSuchKind, 1});
  Incident pair = noted(IncidentKind::MessageNotSent, 1, 1.0, 10.0, 3);
  pair.b = EntityId{0U};
  Incident kinds = noted(IncidentKind::MessageNotSent, 0, 10.0, 10.0, 2);
  kinds.a = {};
  EXPECT_THAT(told.finish(10.0).incidents, ElementsAre(pair, kinds));
}

TEST(FaultRecord, AccusesNobody) {
  EXPECT_FALSE(accuses(IncidentKind::FaultInjected));
  EXPECT_FALSE(accuses(IncidentKind::ForeignBody));
  EXPECT_TRUE(accuses(IncidentKind::ThroughputBelowFloor));
}

}  // namespace
}  // namespace fleetproof::test::fault_record_law_test
