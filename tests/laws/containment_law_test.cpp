#include "laws/containment_law.hpp"

#include <gmock/gmock.h>

#include "tests/laws/told.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::containment_law_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using enum IncidentKind;

constexpr auto kPick = ActivityKind::Pick, kDrop = ActivityKind::Drop;
constexpr std::uint32_t kNobody = 0xffffffff;

// Stations s0 .. s4 in a row, 4 m apart. AGV 0 stands at s1 and brings a load from s1 to s3, then another from s1 to
// s2; AGV 1 stands at s4.
class Containment : public testing::Test {
 protected:
  Containment() : scenario_(make()), told_(scenario_, "containment") {}

  static Scenario make() {
    Scenario scenario = row_scenario(5, {1, 4});
    scenario.agvs[0].transports = {{StationId{1U}, StationId{3U}, seconds(1.0)},
                                   {StationId{1U}, StationId{2U}, seconds(2.0)}};
    return scenario;
  }
  static Vec2 station_m(int number) { return {4.0 * number, 0.0}; }
  Told& released() { return told_.released(1.0, 0, 0).load_at_station(1.0, 0, 0, 1); }
  Told& picked() { return released().begins(5.0, 0, kPick, 0).load_on_agv(10.0, 0, 0).ends(10.0, 0, kPick); }
  Told& done() {
    return picked()
        .stand(0, station_m(3), 20.0)
        .begins(20.0, 0, kDrop, 0)
        .load_at_station(25.0, 0, 0, 3)
        .done(25.0, 0, 0)
        .ends(25.0, 0, kDrop);
  }
  std::vector<IncidentKind> found() { return kinds_of(incidents()); }
  std::vector<Incident> incidents() { return told_.finish(60.0).incidents; }

  Scenario scenario_;
  Told told_;
};

TEST_F(Containment, IsSilentAboutATransportAsItShouldBe) {
  done();
  EXPECT_THAT(found(), IsEmpty());
}

TEST_F(Containment, IsSilentAboutEmptyPicksAndThoseCutShort) {
  released().begins(2.0, 1, kPick, kNobody).ends(7.0, 1, kPick).begins(8.0, 0, kPick, 0).ends(9.0, 0, kPick, false);
  EXPECT_THAT(found(), IsEmpty());
}

TEST_F(Containment, AccusesALoadThatPassesFromAgvToAgv) {
  picked().load_on_agv(30.0, 1, 0);
  const auto all = incidents();
  ASSERT_THAT(kinds_of(all), ElementsAre(LoadHeldByTwo));
  EXPECT_EQ(all[0].a, EntityId{0U});
  EXPECT_EQ(all[0].b, EntityId{1U});
}

TEST_F(Containment, AccusesALoadThatIsNowhereAfterAPick) {
  released().begins(5.0, 0, kPick, 0).ends(10.0, 0, kPick);
  EXPECT_THAT(found(), ElementsAre(LoadVanished));
}

TEST_F(Containment, AccusesAFullAgvThatTakesAnother) {
  picked().released(11.0, 0, 1).load_at_station(11.0, 0, 1, 1);
  told_.begins(12.0, 0, kPick, 1).load_on_agv(17.0, 0, 1).ends(17.0, 0, kPick);
  EXPECT_THAT(found(), ElementsAre(LoadPickedByFullAgv));
}

TEST_F(Containment, AccusesALoadPutDownElsewhereForAsLongAsItLiesThere) {
  picked().stand(0, station_m(2), 20.0).begins(20.0, 0, kDrop, 0).load_at_station(25.0, 0, 0, 2).ends(25.0, 0, kDrop);
  told_.begins(30.0, 0, kPick, 0).load_on_agv(35.0, 0, 0).ends(35.0, 0, kPick);
  const auto all = incidents();
  ASSERT_THAT(kinds_of(all), ElementsAre(LoadAtWrongStation));
  EXPECT_EQ(all[0].first, at_seconds(25.0));
  EXPECT_EQ(all[0].last, at_seconds(35.0));
}

TEST_F(Containment, PuttingALoadBackWhereItCameFromIsNoWrongStation) {
  picked().begins(20.0, 0, kDrop, 0).load_at_station(25.0, 0, 0, 1).ends(25.0, 0, kDrop);
  EXPECT_THAT(found(), IsEmpty());
}

TEST_F(Containment, AccusesADeliveryElsewhere) {
  picked().done(25.0, 0, 0);
  EXPECT_THAT(found(), ElementsAre(LoadAtWrongStation));
}

TEST_F(Containment, AccusesASecondDelivery) {
  done().done(26.0, 0, 0);
  EXPECT_THAT(found(), ElementsAre(LoadDeliveredTwice));
}

TEST_F(Containment, AccusesAPickWithoutAPickActivityOrFromAfar) {
  released().load_on_agv(10.0, 0, 0);
  EXPECT_THAT(found(), ElementsAre(LoadMovedByNobody));
}

TEST_F(Containment, AccusesAPickByAnAgvThatStandsElsewhere) {
  released().begins(5.0, 1, kPick, 0).load_on_agv(10.0, 1, 0).ends(10.0, 1, kPick);
  EXPECT_THAT(found(), ElementsAre(LoadMovedByNobody));
}

TEST_F(Containment, AccusesALoadThatNobodyOrdered) {
  told_.load_at_station(3.0, 0, 7, 1);
  EXPECT_THAT(found(), ElementsAre(LoadMovedByNobody));
}

TEST_F(Containment, AgreesWithTheEngineAboutAWholeRun) {
  Recorder recorder;
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
    if (b.self != 0) return;
    if (event.kind == FP_EVENT_ORDER && event.order_id == 0) host.pick(c, FP_HERE);
    if (event.kind != FP_EVENT_ACTION_DONE) return;
    std::uint32_t loaded = 0;
    host.is_loaded(c, &loaded);
    fp_pose pose{};
    host.get_position(c, &pose);
    if (loaded != 0) pose.x_m < 5.0 ? host.move(c, 1) : host.drop(c, 2);
  };
  current_handler = &handler;
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(find_law("safety-distance")->make(scenario_));
  laws.push_back(find_law("containment")->make(scenario_));
  scenario_.agvs.pop_back();
  const Outcome outcome = simulate(scenario_, handler_agent(), laws, &recorder);
  EXPECT_EQ(outcome.counters.transports_done, 1U);
  EXPECT_THAT(outcome.incidents, IsEmpty());
  const auto moves = recorder.of(TraceKind::LoadMoves);
  ASSERT_EQ(moves.size(), 4U) << "two loads appear, one is taken and put down";
  EXPECT_EQ(read<traced::LoadMoves>(moves[2]).to, (Holder{Holder::Kind::Agv, 0}));
  EXPECT_EQ(read<traced::LoadMoves>(moves[3]).to, (Holder{Holder::Kind::Station, 3}));
}

}  // namespace
}  // namespace fleetproof::test::containment_law_test
