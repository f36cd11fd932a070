#include "campaign/shrink/later_start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/scenario/order_table.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::later_start_test {
namespace {

using std::chrono::seconds;

struct Night {
  Night() : bench("hull-lock", 1), scenario(test::bad_night(3)) {
    scenario.radio = RadioSetup{};
    scenario.faults.clear();
    scenario.horizon = seconds(300);
    run = bench.host(scenario, Deliveries::Kept);
  }
  const Itinerary& itinerary() const { return run.itinerary; }

  test::CaseBench bench;
  Scenario scenario;
  CaseRun run;
};

// Each departure is from where the one before led to, along a segment of the map, not before its arrival.
TEST(Itinerary, IsAWayThroughTheMap) {
  const Night night;
  std::map<AgvId, StationId> at;
  std::map<AgvId, SimTime> since;
  for (const Departure& departure : night.itinerary().departures) {
    const auto known = at.find(departure.agv);
    const StationId start = night.scenario.agvs[departure.agv.index()].start;
    EXPECT_EQ(departure.from, known == at.end() ? start : known->second);
    EXPECT_GE(departure.at, since[departure.agv]);
    const auto& segments = night.scenario.map->layout().segments;
    EXPECT_TRUE(std::ranges::any_of(segments, [&](const Segment& segment) {
      return std::minmax(segment.from, segment.to) == std::minmax(departure.from, departure.to);
    }));
    EXPECT_NEAR(departure.heading.norm(), 1.0, 1e-9);
    at[departure.agv] = departure.to;
    since[departure.agv] = departure.arrives;
  }
  EXPECT_GT(night.itinerary().departures.size(), 20U);
  EXPECT_EQ(night.itinerary().done.size(), night.run.outcome.counters.transports_done);
  EXPECT_GT(night.run.outcome.counters.transports_done, 0U);
}

TEST(LaterStart, PutsAgvsWhereTheyWere) {
  Night night;
  const AgvId agv{0U};
  Itinerary known;
  known.departures = {
      {agv, kStart + seconds(2), kStart + seconds(4), StationId{7U}, StationId{8U}, {0.0, 1.0}, {1.0, 0.0}},
      {agv, kStart + seconds(9), kStart + seconds(12), StationId{8U}, StationId{9U}, {0.0, -1.0}, {-1.0, 0.0}}};
  const auto placed = [&](int from_s, Between between) {
    const AgvSetup setup = with_later_start(night.scenario, known, seconds(from_s), between).agvs[0];
    return std::tuple(setup.start.value, setup.heading.x(), setup.heading.y());
  };
  const AgvSetup& first = night.scenario.agvs[0];
  EXPECT_EQ(placed(1, Between::Behind), std::tuple(first.start.value, first.heading.x(), first.heading.y()));
  EXPECT_EQ(placed(3, Between::Behind), std::tuple(7U, 0.0, 1.0)) << "on the way: where it came from";
  EXPECT_EQ(placed(3, Between::Ahead), std::tuple(8U, 0.0, -1.0)) << "or where it went, and as it left there";
  EXPECT_EQ(placed(5, Between::Behind), std::tuple(8U, 0.0, -1.0)) << "it has arrived";
  EXPECT_EQ(placed(20, Between::Behind), std::tuple(9U, -1.0, 0.0)) << "it stays where it arrived last";
}

// A case file has no negative zero. Headings reach agents, and from there messages and digests.
TEST(LaterStart, HeadingsHaveNoNegativeZero) {
  Night night;
  const AgvId agv{0U};
  Itinerary known;
  known.departures = {
      {agv, kStart + seconds(2), kStart + seconds(4), StationId{7U}, StationId{8U}, {-0.0, 1.0}, {1.0, -0.0}},
      {agv, kStart + seconds(9), kStart + seconds(12), StationId{8U}, StationId{9U}, {-1.0, -0.0}, {-0.0, -1.0}}};
  for (const int from_s : {3, 5, 20}) {
    const Vec2 heading = with_later_start(night.scenario, known, seconds(from_s), Between::Behind).agvs[0].heading;
    for (const double along : {heading.x(), heading.y()}) EXPECT_FALSE(along == 0.0 && std::signbit(along)) << from_s;
  }
}

TEST(LaterStart, TakesTheTimeBeforeOutOfAllInstants) {
  Night night;
  night.scenario.faults.clear();
  for (const auto& [agv, at] : {std::pair(1U, seconds(4)), {2U, seconds(8)}, {3U, seconds(30)}})
    night.scenario.faults.push_back(
        {.kind = Fault::Kind::Breakdown, .agv = AgvId{agv}, .at = at, .transport = {}, .lasts = seconds(5)});
  Itinerary known;
  const OrderTable orders(night.scenario);
  known.done = {{AgvId{1U}, orders.at(AgvId{1U}, 0), kStart + seconds(9)},
                {AgvId{2U}, orders.at(AgvId{2U}, 0), kStart + seconds(11)}};
  const Scenario later = with_later_start(night.scenario, known, seconds(10), Between::Behind);
  EXPECT_EQ(later.horizon, night.scenario.horizon - seconds(10));
  ASSERT_EQ(later.faults.size(), 2U) << "one was over";
  EXPECT_EQ(later.faults[0].at, Duration::zero());
  EXPECT_EQ(later.faults[0].lasts, seconds(3)) << "what is left of it";
  EXPECT_EQ(later.faults[1].at, seconds(20));
  EXPECT_EQ(later.agvs[1].transports.size(), night.scenario.agvs[1].transports.size() - 1) << "one was delivered";
  EXPECT_EQ(later.agvs[2].transports.size(), night.scenario.agvs[2].transports.size());
  const TransportOrder& order = later.agvs[2].transports.back();
  const Duration release = night.scenario.agvs[2].transports.back().release;
  EXPECT_EQ(order.release, std::max(Duration::zero(), release - seconds(10)));
}

}  // namespace
}  // namespace fleetproof::later_start_test
