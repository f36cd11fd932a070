// What laws say about transports that no AGV is given: by hand, record by record.
#include <gmock/gmock.h>

#include "tests/laws/told.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::open_orders_law_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using enum IncidentKind;

constexpr std::uint32_t kNobody = 0xffffffff;

// Six stations in a row, 4 m apart; AGV 0 stands at s1 and AGV 1 at s2. Open transports lead from s3 to s4.
class OpenOrders : public testing::Test {
 protected:
  OpenOrders() {
    scenario_ = row_scenario(6, {1, 2}, 2000.0);
    for (int i = 0; i < 20; ++i) scenario_.open_orders.push_back({StationId{3U}, StationId{4U}, seconds(1.0 + i)});
    scenario_.stuck_after = seconds(120.0);
  }
  Told told(std::string_view law = "progress") { return {scenario_, law}; }
  static Told& released(Told& told, double at_s, std::uint32_t transport) {
    return told.released(at_s, kNobody, transport).load_at_station(at_s, kNobody, transport, 3);
  }
  static Told& works_on(Told& told, double at_s, std::uint32_t agv, std::uint32_t transport) {
    return told.record(at_s, agv, traced::WorksOn{TransportId{transport}});
  }
  static Told& withdrawn(Told& told, double at_s, std::uint32_t transport) {
    return told.record(at_s, kNobody, traced::OrderWithdrawn{TransportId{transport}})
        .record(at_s, kNobody, traced::LoadMoves{LoadId{transport}, {Holder::Kind::Withdrawn, 0}});
  }
  // The AGV takes the load up and delivers it.
  static Told& delivered(Told& told, double at_s, std::uint32_t agv, std::uint32_t transport) {
    return told.load_on_agv(at_s, agv, transport)
        .load_at_station(at_s + 1.0, agv, transport, 4)
        .done(at_s + 1.0, agv, transport);
  }
  Scenario scenario_;
};

TEST_F(OpenOrders, OfWhichNobodySaysWhoseWorkTheyAreAccuseTheFleetAsAWhole) {
  Told law = told();
  released(law, 1.0, 0);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock));
  EXPECT_FALSE(found[0].a.valid()) << "no AGV";
  EXPECT_EQ(found[0].first, at_seconds(1.0));
  EXPECT_EQ(found[0].last, at_seconds(600.0));
  EXPECT_EQ(found[0].value, 0);
}

TEST_F(OpenOrders, AnAgvThatMovesMayBeAtWork) {
  Told law = told();
  released(law, 1.0, 0);
  for (double t_s = 50.0; t_s < 600.0; t_s += 100.0)
    law.begins(t_s, 1, ActivityKind::Drive, 2).ends(t_s + 4.0, 1, ActivityKind::Drive);
  for (const Incident& incident : law.finish(600.0).incidents) EXPECT_NE(incident.kind, Deadlock);
}

TEST_F(OpenOrders, DeclaredWorkMakesAnAgvAnswerForIt) {
  Told law = told();
  released(law, 1.0, 0);
  works_on(law, 10.0, 0, 0);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsInferred));
  EXPECT_EQ(found[0].a, EntityId{0U});
  EXPECT_EQ(found[0].first, at_seconds(10.0)) << "from when it has work";
  EXPECT_EQ(found[1].b, EntityId{1U}) << "the other AGV stands on its way to the load";
}

TEST_F(OpenOrders, WorkThatIsTakenBackIsNone) {
  Told law = told();
  released(law, 1.0, 0);
  works_on(law, 10.0, 0, 0);
  works_on(law, 20.0, 0, kNobody);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock));
  EXPECT_FALSE(found[0].a.valid());
}

TEST_F(OpenOrders, ADeadlockOfDeclaredWorkHasItsCircle) {
  Told law = told();
  released(law, 1.0, 0);
  released(law, 2.0, 1);
  works_on(law, 3.0, 0, 0);
  works_on(law, 4.0, 1, 1);
  law.waits_for(5.0, 0, 1).waits_for(5.0, 1, 0);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsDeclared, WaitsDeclared));
  EXPECT_EQ(found[0].value, 2);
}

// Then it is no longer the work of the one that declared it.
TEST_F(OpenOrders, WhoTakesTheLoadUpOwnsTheTransport) {
  Told law = told();
  released(law, 1.0, 0);
  works_on(law, 2.0, 0, 0);
  law.load_on_agv(20.0, 1, 0);
  const auto found = law.finish(600.0).incidents;
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].kind, Deadlock);
  EXPECT_EQ(found[0].a, EntityId{1U});
}

TEST_F(OpenOrders, WhatIsDeliveredOrWithdrawnIsNobodysWork) {
  Told law = told();
  released(law, 1.0, 0);
  released(law, 2.0, 1);
  works_on(law, 3.0, 0, 1);
  delivered(law, 20.0, 1, 0);
  withdrawn(law, 30.0, 1);
  EXPECT_THAT(law.finish(600.0).incidents, IsEmpty());
}

TEST_F(OpenOrders, OneThatIsPutDownElsewhereWaitsAgain) {
  Told law = told();
  released(law, 1.0, 0);
  law.load_on_agv(20.0, 1, 0).load_at_station(40.0, 1, 0, 5);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock));
  EXPECT_FALSE(found[0].a.valid());
}

TEST_F(OpenOrders, OneThatNobodyTakesWhileLaterOnesAreDoneIsAccused) {
  for (const bool is_declared : {false, true}) {
    Told law = told();
    for (std::uint32_t i = 0; i < 5; ++i) released(law, 1.0 + i, i);
    if (is_declared) works_on(law, 8.0, 1, 0);
    for (std::uint32_t i = 1; i < 5; ++i) delivered(law, 10.0 * i, i % 2, i);
    for (double t_s = 60.0; t_s < 300.0; t_s += 40.0)  // it is no deadlock
      law.begins(t_s, 0, ActivityKind::Turn).ends(t_s + 4.0, 0, ActivityKind::Turn);
    const auto found = law.finish(300.0).incidents;
    const auto accused = std::ranges::find(found, OrderNotTaken, &Incident::kind);
    ASSERT_NE(accused, found.end());
    EXPECT_EQ(accused->a, is_declared ? EntityId{1U} : EntityId{}) << "an AGV only once there is one";
    EXPECT_EQ(accused->value, 0) << "the transport";
    EXPECT_EQ(accused->first, at_seconds(1.0));
    EXPECT_EQ(std::ranges::count(found, OrderNotTaken, &Incident::kind), 1);
  }
}

TEST_F(OpenOrders, ABacklogIsNoStarvation) {
  Told law = told();
  for (std::uint32_t i = 0; i < 20; ++i) released(law, 1.0 + i, i);
  for (std::uint32_t i = 0; i < 19; ++i) delivered(law, 40.0 + 40.0 * i, i % 2, i);  // in their order
  for (const Incident& incident : law.finish(800.0).incidents) EXPECT_NE(incident.kind, OrderNotTaken);
}

TEST_F(OpenOrders, AFleetThatDrivesInVainIsInALivelock) {
  Told law = told();
  released(law, 1.0, 0);
  for (double t_s = 5.0; t_s < 600.0; t_s += 10.0)
    law.begins(t_s, 0, ActivityKind::Turn).ends(t_s + 4.0, 0, ActivityKind::Turn);
  EXPECT_THAT(kinds_of(law.finish(600.0).incidents), ElementsAre(Livelock));
}

TEST_F(OpenOrders, AreStandstillOfTheFleetUntilTheyAreWithdrawn) {
  for (const bool is_withdrawn : {false, true}) {
    Told law = told("normal-operation");
    released(law, 1.0, 0);
    if (is_withdrawn) withdrawn(law, 50.0, 0);
    EXPECT_THAT(kinds_of(law.finish(600.0).incidents),
                is_withdrawn ? testing::Matcher<std::vector<IncidentKind>>(IsEmpty())
                             : testing::Matcher<std::vector<IncidentKind>>(ElementsAre(StandstillInContract)));
  }
}

TEST_F(OpenOrders, AWithdrawnLoadMayGoFromAStationOnly) {
  Told law = told("containment");
  released(law, 1.0, 0);
  withdrawn(law, 2.0, 0);
  released(law, 3.0, 1);
  law.begins(3.0, 0, ActivityKind::Pick, 1).stand(0, scenario_.map->station(StationId{3U}).position_m, 3.0);
  law.load_on_agv(4.0, 0, 1).ends(4.0, 0, ActivityKind::Pick);
  EXPECT_THAT(law.finish(10.0).incidents, IsEmpty());
  Told other = told("containment");
  released(other, 1.0, 1);
  other.begins(1.0, 0, ActivityKind::Pick, 1).stand(0, scenario_.map->station(StationId{3U}).position_m, 1.0);
  other.load_on_agv(4.0, 0, 1).ends(4.0, 0, ActivityKind::Pick);
  withdrawn(other, 5.0, 1);
  EXPECT_THAT(kinds_of(other.finish(10.0).incidents), ElementsAre(LoadMovedByNobody));
}

}  // namespace
}  // namespace fleetproof::test::open_orders_law_test
