#include "laws/progress_law.hpp"

#include <gmock/gmock.h>

#include "laws/inferred_waits.hpp"
#include "tests/laws/told.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::progress_law_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using enum IncidentKind;

constexpr std::uint32_t kNobody = 0xffffffff;

// Six stations in a row, 4 m apart; AGV 0 stands at s1 and AGV 1 at s2, each has to fetch a load beyond the other, if
// `busy` says so.
class Progress : public testing::Test {
 protected:
  Progress() {
    scenario_ = row_scenario(6, {1, 2}, 600.0);
    scenario_.agvs[0].transports = {{StationId{3U}, StationId{4U}, seconds(1.0)}};
    scenario_.agvs[1].transports = {{StationId{0U}, StationId{5U}, seconds(2.0)}};
    scenario_.stuck_after = seconds(120.0);
  }
  Told told() { return {scenario_, "progress"}; }
  static void released(Told& told, double at_s, std::uint32_t agv, std::uint32_t transport, std::uint32_t from) {
    told.released(at_s, agv, transport).load_at_station(at_s, agv, transport, from);
  }
  static void both_released(Told& told) {
    released(told, 1.0, 0, 0, 3);
    released(told, 2.0, 1, 1, 0);
  }
  Scenario scenario_;
};

TEST_F(Progress, ADeadlockIsFiledWithWhoWaitsForWhomByTheirOwnWord) {
  Told law = told();
  both_released(law);
  law.waits_for(3.0, 0, 1).waits_for(4.0, 1, 0);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsDeclared, WaitsDeclared));
  EXPECT_EQ(found[0].a, EntityId{0U});
  EXPECT_EQ(found[0].b, EntityId{1U});
  EXPECT_EQ(found[0].value, 2) << "AGVs in the circle";
  EXPECT_EQ(found[0].first, at_seconds(2.0)) << "when the last of them had work and did nothing";
  EXPECT_EQ(found[0].last, at_seconds(600.0));
  EXPECT_EQ(found[2].a, EntityId{1U});
  EXPECT_EQ(found[2].b, EntityId{0U});
}

TEST_F(Progress, ASilentFleetsWaitsAreInferredFromWhoStandsInTheWay) {
  Told law = told();
  both_released(law);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsInferred, WaitsInferred));
  EXPECT_EQ(found[0].value, 2);
}

TEST_F(Progress, AllStandingWithoutACircleIsADeadlockOfUnknownKind) {
  scenario_.agvs[1].transports.clear();
  Told law = told();
  released(law, 1.0, 0, 0, 3);
  const auto found = law.finish(600.0).incidents;  // the idle AGV 1 stands in the way
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsInferred));
  EXPECT_EQ(found[0].value, 0);
  EXPECT_EQ(found[1].b, EntityId{1U});
}

// Also at the very end of the run, when every piece has ended.
TEST_F(Progress, AnObstacleIsInTheWayUntilItLeaves) {
  scenario_ = row_scenario(6, {1, 5}, 600.0);
  scenario_.agvs[0].transports = {{StationId{3U}, StationId{4U}, seconds(1.0)}};
  scenario_.obstacles = {{.name = "box", .footprint = {}, .pose = {Vec2{8.0, 0.0}, Vec2::UnitX()}}};
  for (const bool leaves : {false, true}) {
    Told law = told();
    released(law, 1.0, 0, 0, 3);
    if (leaves) law.leaves(50.0, 2);
    const auto found = law.finish(121.0).incidents;
    ASSERT_EQ(found.size(), leaves ? 1U : 2U);
    EXPECT_EQ(found[0].kind, Deadlock);
    EXPECT_EQ(found.back().b, leaves ? EntityId{} : EntityId{2U});
  }
}

TEST_F(Progress, StandingForLessThanStuckAfterIsNone) {
  Told law = told();
  both_released(law);
  EXPECT_THAT(law.finish(121.0).incidents, IsEmpty());
}

TEST_F(Progress, WhomTheOperatorHasTakenOffTheFloorWaitsForNobodyAndIsInNobodysWay) {
  Told law = told();
  both_released(law);
  law.leaves(100.0, 0);
  EXPECT_THAT(law.finish(600.0).incidents, IsEmpty());
}

TEST_F(Progress, NobodyWaitsForIt) {
  for (const bool away : {false, true}) {
    Told law = told();
    released(law, 2.0, 1, 1, 0);  // beyond AGV 0, which has nothing to do
    if (away) law.leaves(3.0, 0);
    const auto found = law.finish(600.0).incidents;
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].kind, Deadlock);
    EXPECT_EQ(found.size(), away ? 1U : 2U) << "the wait for AGV 0";
  }
}

TEST_F(Progress, WhoWaitsForTheOperatorAfterAContactIsExcused) {
  for (const bool comes : {false, true}) {
    scenario_.operator_help.on = comes;
    Told law = told();
    both_released(law);
    law.touches(3.0, 0, 1).appears(5.0, 99);  // the latter is none of the fleet
    EXPECT_EQ(law.finish(600.0).incidents.empty(), comes);
  }
}

TEST_F(Progress, AndStartsAfreshWhereItIsSetDown) {
  Told law = told();
  both_released(law);
  law.leaves(100.0, 0).stand(0, Vec2{4.0, 0.0}, 200.0).appears(200.0, 0, 1);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsInferred, WaitsInferred));
  EXPECT_EQ(found[0].first, at_seconds(200.0));
}

TEST_F(Progress, AFleetWithoutWorkMayStand) {
  Told law = told();
  EXPECT_THAT(law.finish(600.0).incidents, IsEmpty());
}

TEST_F(Progress, AFleetThatHasDoneItsWorkMayStand) {
  scenario_.agvs[1].transports.clear();
  Told law = told();
  released(law, 1.0, 0, 0, 3);
  law.begins(5.0, 0, ActivityKind::Pick).load_on_agv(10.0, 0, 0).ends(10.0, 0, ActivityKind::Pick);
  law.load_at_station(60.0, 0, 0, 4).done(60.0, 0, 0);
  EXPECT_THAT(law.finish(600.0).incidents, IsEmpty());
}

TEST_F(Progress, ADeadlockThatDissolvesEnds) {
  Told law = told();
  both_released(law);
  law.waits_for(3.0, 0, 1).waits_for(4.0, 1, 0);
  law.begins(200.0, 1, ActivityKind::Drive).ends(210.0, 1, ActivityKind::Drive);
  const auto found = law.finish(235.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsDeclared, WaitsDeclared));
  EXPECT_LE(found[0].last, at_seconds(200.0));
  EXPECT_GE(found[0].last, at_seconds(190.0)) << "to within one look";
  EXPECT_EQ(found[1].last, found[0].last);
}

TEST_F(Progress, MovingToAndFroWithoutALoadIsALivelock) {
  Told law = told();
  both_released(law);
  for (int i = 0; i < 29; ++i)
    law.begins(10.0 + 20.0 * i, 0, ActivityKind::Drive).ends(15.0 + 20.0 * i, 0, ActivityKind::Drive);
  const auto found = law.finish(600.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Livelock));
  EXPECT_EQ(found[0].first, at_seconds(1.0));
  EXPECT_EQ(found[0].value, 29);
}

// Twice the time of the way by which it came nearer, at 0.05 m/s: 240 s and 320 s for the 8 m to station 3, and nothing
// for the way from there to station 4 and back.
TEST_F(Progress, WhoIsOnALongWayHasTimeForIt) {
  scenario_.vehicle_types[0].drive.speed_mps = 0.05;
  for (const auto& [segments, finish_s, is_livelock] :
       {std::tuple(std::vector<std::uint64_t>{1, 2, 3}, 545.0, false), {{1, 2, 3}, 590.0, true}, {{0}, 545.0, true}}) {
    Told law = told();
    both_released(law);
    for (std::size_t i = 0; 15.0 + 20.0 * static_cast<double>(i) < finish_s; ++i) {
      const std::uint64_t segment = segments[std::min(i, segments.size() - 1)];
      const double at_s = 10.0 + 20.0 * static_cast<double>(i);
      law.begins(at_s, 0, ActivityKind::Drive, segment).ends(at_s + 5.0, 0, ActivityKind::Drive);
    }
    const auto found = law.finish(finish_s).incidents;
    EXPECT_EQ(!found.empty(), is_livelock) << finish_s;
    EXPECT_TRUE(found.empty() || found[0].kind == Livelock);
  }
}

// However slowly. The load that it fetches is at station 3.
TEST_F(Progress, WhoIsOnItsWayIsNoLivelock) {
  constexpr std::uint64_t kAway = 0, kNearer = 1, kLoad = 0, kNoLoad = LoadId{}.value;
  using enum ActivityKind;
  struct Does {
    ActivityKind kind;
    double until_s;
    std::uint64_t subject;
  };
  struct Case {
    std::vector<Does> does;
    bool is_livelock;
  };
  for (const Case& one : {Case{{{Drive, 520.0, kNearer}}, false},
                          {{{Drive, 520.0, kAway}}, true},
                          {{{Drive, 250.0, kNearer}, {Settle, 300.0, 0}, {Drive, 520.0, 2}}, false},
                          {{{Drive, 150.0, kNearer}, {Drive, 300.0, kNearer}, {Drive, 520.0, kNearer}}, true},
                          {{{Turn, 260.0, 1}, {Drive, 520.0, kNearer}}, false},
                          {{{Turn, 260.0, 1}, {Turn, 520.0, 1}}, true},
                          {{{Pick, 600.0, kLoad}}, false},
                          {{{Pick, 600.0, kNoLoad}}, true}}) {
    Told law = told();
    both_released(law);
    double at_s = 10.0;
    for (const auto& [kind, until_s, subject] : one.does) {
      law.begins(at_s, 0, kind, subject);
      if (until_s < 525.0) law.ends(until_s, 0, kind);  // else it is under way
      at_s = until_s;
    }
    const auto found = law.finish(525.0).incidents;
    EXPECT_EQ(!found.empty(), one.is_livelock) << one.does.size() << " " << name_of(one.does.front().kind);
    EXPECT_TRUE(found.empty() || found[0].kind == Livelock);
  }
}

TEST_F(Progress, AHaltOnALongWayTurnsNobodyRound) {
  scenario_.vehicle_types[0].drive.speed_mps = 0.05;
  Told law = told();
  both_released(law);
  law.begins(5.0, 0, ActivityKind::Drive, 1).ends(6.0, 0, ActivityKind::Drive, false);
  for (std::uint64_t i = 0; i < 27; ++i) {
    const double at_s = 10.0 + 20.0 * static_cast<double>(i);
    law.begins(at_s, 0, ActivityKind::Drive, std::min<std::uint64_t>(i + 1, 3))
        .ends(at_s + 5.0, 0, ActivityKind::Drive);
  }
  EXPECT_THAT(law.finish(545.0).incidents, IsEmpty());
}

// The same, but the AGV charges to the end in between; a charge that is cut short is no progress.
TEST_F(Progress, AChargeToTheEndIsProgressAndOneThatIsCutShortIsNot) {
  for (const bool to_the_end : {true, false}) {
    Told law = told();
    both_released(law);
    for (int i = 0; i < 29; ++i) {
      law.begins(10.0 + 20.0 * i, 0, ActivityKind::Drive).ends(15.0 + 20.0 * i, 0, ActivityKind::Drive);
      if (i % 10 == 9)
        law.begins(16.0 + 20.0 * i, 0, ActivityKind::Charge).ends(18.0 + 20.0 * i, 0, ActivityKind::Charge, to_the_end);
    }
    EXPECT_EQ(law.finish(600.0).incidents.empty(), to_the_end);
  }
}

// Twenty minutes, until the agent breaks off. Then the AGV works on, or stands.
TEST_F(Progress, WhoChargesForLongIsNotAccusedUntilItHasCharged) {
  for (const bool works_on : {true, false}) {
    Told law = told();
    both_released(law);
    for (std::uint32_t agv = 0; agv < 2; ++agv)
      law.begins(5.0, agv, ActivityKind::Drive)
          .ends(9.0, agv, ActivityKind::Drive)
          .begins(10.0, agv, ActivityKind::Charge);
    for (std::uint32_t agv = 0; agv < 2; ++agv) law.ends(1210.0, agv, ActivityKind::Charge, false);
    for (double t_s = 1211.0; works_on && t_s < 1400.0; t_s += 20.0)
      law.begins(t_s, 0, ActivityKind::Drive).ends(t_s + 10.0, 0, ActivityKind::Drive);
    const auto found = law.finish(works_on ? 1400.0 : 2000.0).incidents;
    if (works_on) {
      EXPECT_THAT(found, IsEmpty());
    } else {
      ASSERT_FALSE(found.empty());
      EXPECT_EQ(found[0].kind, Deadlock);
      EXPECT_EQ(found[0].first, at_seconds(1210.0));
    }
  }
}

// One charges while the other one carries: it is not overtaken.
TEST_F(Progress, WhoChargesIsNotStarving) {
  scenario_.agvs[1].transports.resize(9, scenario_.agvs[1].transports[0]);
  for (const bool charges : {true, false}) {
    Told law = told();
    released(law, 1.0, 0, 0, 3);
    for (std::uint32_t i = 1; i < 9; ++i) released(law, 1.0, 1, i, 0);
    if (charges) law.begins(2.0, 0, ActivityKind::Charge);
    for (std::uint32_t i = 1; i < 9; ++i) {
      const double t_s = 60.0 * i;
      law.begins(t_s, 1, ActivityKind::Pick).load_on_agv(t_s + 5.0, 1, i).ends(t_s + 5.0, 1, ActivityKind::Pick);
      law.begins(t_s + 9.0, 1, ActivityKind::Drop).load_at_station(t_s + 10.0, 1, i, 5);
      law.ends(t_s + 10.0, 1, ActivityKind::Drop).done(t_s + 10.0, 1, i);
    }
    const auto found = law.finish(500.0).incidents;
    EXPECT_EQ(found.empty(), charges);
  }
}

TEST_F(Progress, WhoPicksNowAndThenIsNoLivelock) {
  scenario_.agvs[0].transports.resize(3, scenario_.agvs[0].transports[0]);
  scenario_.agvs[1].transports.clear();
  Told law = told();
  for (std::uint32_t i = 0; i < 3; ++i) released(law, 1.0, 0, i, 3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const double t_s = 150.0 * static_cast<double>(i + 1);
    law.begins(t_s - 50.0, 0, ActivityKind::Drive)
        .ends(t_s - 10.0, 0, ActivityKind::Drive)
        .load_on_agv(t_s, 0, i)
        .load_at_station(t_s + 20.0, 0, i, 4);
    law.done(t_s + 20.0, 0, i);
  }
  EXPECT_THAT(law.finish(600.0).incidents, IsEmpty());
}

TEST_F(Progress, OneThatIsNeverServedStarves) {
  scenario_.agvs[0].transports.resize(4, scenario_.agvs[0].transports[0]);
  Told law = told();
  for (std::uint32_t i = 0; i < 4; ++i) released(law, 1.0, 0, i, 3);
  released(law, 2.0, 1, 4, 0);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const double t_s = 100.0 * static_cast<double>(i + 1);
    law.begins(t_s - 50.0, 0, ActivityKind::Drive)
        .ends(t_s - 10.0, 0, ActivityKind::Drive)
        .load_on_agv(t_s, 0, i)
        .load_at_station(t_s + 20.0, 0, i, 4);
    law.done(t_s + 20.0, 0, i);
    law.begins(t_s, 1, ActivityKind::Turn).ends(t_s + 1.0, 1, ActivityKind::Turn);
  }
  const auto found = law.finish(430.0).incidents;
  ASSERT_THAT(kinds_of(found), ElementsAre(Starvation));
  EXPECT_EQ(found[0].a, EntityId{1U});
  EXPECT_EQ(found[0].first, at_seconds(2.0));
}

TEST_F(Progress, ACircleOfSomeIsADeadlockWhileOthersWork) {
  scenario_ = row_scenario(8, {1, 2, 6}, 600.0);
  scenario_.agvs[0].transports = {{StationId{3U}, StationId{4U}, seconds(1.0)}};
  scenario_.agvs[1].transports = {{StationId{0U}, StationId{5U}, seconds(2.0)}};
  Told law = told();
  both_released(law);
  law.waits_for(3.0, 0, 1).waits_for(4.0, 1, 0);
  for (int i = 0; i < 10; ++i)
    law.begins(10.0 + 20.0 * i, 2, ActivityKind::Drive).ends(15.0 + 20.0 * i, 2, ActivityKind::Drive);
  EXPECT_THAT(kinds_of(law.finish(220.0).incidents), ElementsAre(Deadlock, WaitsDeclared, WaitsDeclared));
}

TEST_F(Progress, AWaitThatIsTakenBackIsNone) {
  Told law = told();
  both_released(law);
  law.waits_for(3.0, 0, 1).waits_for(4.0, 1, 0).waits_for(5.0, 1, kNobody);
  const auto found = law.finish(600.0).incidents;
  EXPECT_THAT(kinds_of(found), ElementsAre(Deadlock, WaitsDeclared, WaitsInferred))
      << "what it no longer says is inferred";
}

TEST(FirstLaneOfWay, LeadsWhereTheAgvHasPermission) {
  Layout layout = row_map(3)->layout();  // and a detour from its beginning to its end
  layout.stations.push_back({"detour", {4.0, 9.0}});
  layout.segments.push_back({"up", StationId{0U}, StationId{3U}, true});
  layout.segments.push_back({"down", StationId{3U}, StationId{2U}, true});
  layout.segments[1].permissions = {{"tug", LoadState::Empty}};
  const LogicalMap map(layout);
  const auto leads_to = [&](const LaneRules& rules) {
    return first_lane_of_way(rules, StationId{0U}, StationId{2U})->to.value;
  };
  EXPECT_EQ(leads_to({map, "tug", false}), 1U);
  EXPECT_EQ(leads_to({map, "tug", true}), 3U);
  EXPECT_EQ(leads_to({map, "truck", false}), 3U);
}

}  // namespace
}  // namespace fleetproof::test::progress_law_test
