// Quickest ways from every station to every other one, against Bellman and Ford and a drive along the lanes: one-way
// rings with dead ends and ways into them, where most ways are copied from another station's, and whatever random lanes
// make.
#include "generators/map/timetable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>

#include "core/base/random.hpp"
#include "core/geometry/rotation.hpp"
#include "core/motion/motion_profile.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof::timetable_test {
namespace {

std::int64_t drive_ns(const Lane& lane, const VehicleType& type) {
  return MotionProfile(lane.curve.length_m(), type.drive).duration().count();
}

std::vector<std::int64_t> quickest_ns(const LogicalMap& map, const VehicleType& type, StationId from) {
  constexpr std::int64_t kFar = std::int64_t{1} << 60;
  std::vector<std::int64_t> best(map.station_count(), kFar);
  best[from.index()] = 0;
  for (std::size_t round = 0; round < map.station_count(); ++round) {
    for (const Lane& lane : map.lanes()) {
      auto& there = best[lane.to.index()];
      there = std::min(there, best[lane.from.index()] + drive_ns(lane, type));
    }
  }
  for (auto& cost : best) cost = cost < kFar ? cost : -1;
  return best;
}

// A ring of three to twelve stations, dead ends and one-way ways into it hung on anywhere, now and then a chord. No two
// lanes lead from one station to the same other one.
Layout ring(Draws& draws) {
  Layout layout;
  const auto station = [&] {
    const auto n = std::to_string(layout.stations.size());
    layout.stations.push_back({n, {draws.uniform(0.0, 50.0), draws.uniform(0.0, 50.0)}, Purpose::Routing});
    return StationId{layout.stations.size() - 1};
  };
  const auto lane = [&](StationId from, StationId to, bool both) {
    layout.segments.push_back({std::to_string(layout.segments.size()), from, to, both, {}});
  };
  const std::uint32_t n = 3 + draws.below(10);
  for (std::uint32_t i = 0; i < n; ++i) station();
  for (std::uint32_t i = 0; i < n; ++i) lane(StationId{i}, StationId{(i + 1) % n}, draws.below(20) == 0);
  for (std::uint32_t k = draws.below(10); k > 0; --k) {
    const StationId root{draws.below(static_cast<std::uint32_t>(layout.stations.size()))}, end = station();
    if (draws.below(3) == 0) {
      lane(end, root, false);
    } else {
      lane(root, end, true);
    }
  }
  const std::uint32_t from = draws.below(n),
                      steps = 2 + draws.below(n - 2);  // n - 1 leads back, beside the lane of the ring
  if (draws.below(3) == 0 && steps < n - 1) lane(StationId{from}, StationId{(from + steps) % n}, false);
  return layout;
}

void expect_quickest(const LogicalMap& map, const VehicleType& type, const QuickestWays& ways, std::uint64_t seed) {
  const auto best = quickest_ns(map, type, ways.from);
  for (std::size_t s = 0; s < map.station_count(); ++s) {
    const StationId to{s};
    const auto lanes = ways.lanes(map, to);
    ASSERT_EQ(lanes.empty(), best[s] <= 0) << seed << ": " << ways.from.value << " to " << s;
    if (lanes.empty()) continue;
    std::int64_t driven_ns = 0;
    Duration now{}, begun{};
    StationId here = ways.from;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const Lane& lane = map.lanes()[lanes[i]];
      ASSERT_EQ(lane.from, here);
      if (i > 0) {
        const Curve& in = map.lanes()[lanes[i - 1]].curve;
        const double angle =
            std::abs(angle_between(in.pose_at(in.length_m()).heading, lane.curve.pose_at(0.0).heading));
        if (angle > 1e-7) now += MotionProfile(angle, type.turn.as_motion()).duration();
      }
      begun = now;
      now += Duration(drive_ns(lane, type));
      driven_ns += drive_ns(lane, type);
      here = lane.to;
    }
    EXPECT_EQ(here, to);
    EXPECT_EQ(driven_ns, best[s]) << seed << ": " << ways.from.value << " to " << s;
    EXPECT_EQ(ways.at(to).drives_off, begun);
    EXPECT_EQ(ways.at(to).arrives, now);
    EXPECT_EQ(ways.at(to).first, lanes.front());
    EXPECT_TRUE(ways.at(to).unique) << "no two ways are as quick between stations at random places";
  }
}

TEST(Timetable, KnowsTheQuickestWaysInWhateverOrderItIsAsked) {
  const VehicleType type;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draws draws(seed);
    const LogicalMap map(ring(draws));
    Timetable timetable(map, type);
    for (const auto s : draw_some(draws, map.station_count(), map.station_count()))
      expect_quickest(map, type, timetable.from(StationId{s}), seed);
    if (HasFailure()) return;
  }
}

// Backward at 0.5 m/s, be it less or more than forward; the lane's own limit holds as well.
TEST(Timetable, DrivesALaneAtTheSpeedOfItsDirection) {
  Layout layout;
  layout.stations = {{"a", {0.0, 0.0}}, {"b", {10.0, 0.0}}};
  layout.segments.push_back({"a-b", StationId{0U}, StationId{1U}});
  layout.segments[0].travel = Travel::Backward;
  const auto arrives = [&](double forward_mps, double reverse_mps) {
    VehicleType type;
    type.drive.speed_mps = forward_mps;
    type.reverse_speed_mps = reverse_mps;
    const LogicalMap map(layout);
    return Timetable(map, type).from(StationId{0U}).at(StationId{1U}).arrives;
  };
  EXPECT_EQ(arrives(2.0, 0.5), arrives(0.5, 0.0));
  EXPECT_EQ(arrives(0.1, 0.5), arrives(0.5, 0.0));
  const Duration unlimited = arrives(0.1, 0.5);
  layout.segments[0].speed_limit_mps = 0.2;
  EXPECT_EQ(arrives(0.1, 0.5), arrives(0.2, 0.0));
  EXPECT_GT(arrives(0.1, 0.5), unlimited);
}

TEST(Timetable, AnswersTheSameAfterItHasForgotten) {
  const VehicleType type;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Draws draws(seed);
    const LogicalMap map(ring(draws));
    Timetable once(map, type), often(map, type);
    for (const auto s : draw_some(draws, map.station_count(), map.station_count())) {
      often.forget();
      EXPECT_EQ(often.kept(), 0U);
      const auto &a = once.from(StationId{s}), &b = often.from(StationId{s});
      EXPECT_GE(often.kept(), map.station_count());
      for (std::size_t to = 0; to < map.station_count(); ++to) {
        const auto &one = a.at(StationId{to}), &other = b.at(StationId{to});
        EXPECT_EQ(std::tuple(one.drives_off, one.arrives, one.lane, one.first, one.unique),
                  std::tuple(other.drives_off, other.arrives, other.lane, other.first, other.unique))
            << seed << ": " << s << " to " << to;
      }
    }
    EXPECT_LE(once.kept(), map.station_count() * map.station_count());
    if (HasFailure()) return;
  }
}

// The queue of the search for quickest ways, against the one of the standard library.

using Costs = std::priority_queue<std::int64_t, std::vector<std::int64_t>, std::greater<>>;

// Pushes what a search may push, now and then as far ahead as it may, and pops until nothing is open. Which stations
// are open is kept by cost.
void expect_like_the_oracle(CalendarQueue& queue, std::int64_t longest_ns, Draws& draws) {
  Costs costs;
  std::map<std::int64_t, std::multiset<std::uint32_t>> stations;
  std::uint32_t pushed = 0;
  const auto push = [&](std::int64_t cost_ns) {
    queue.push({cost_ns, pushed});
    costs.push(cost_ns);
    stations[cost_ns].insert(pushed++);
  };
  push(0);
  while (!costs.empty()) {
    ASSERT_FALSE(queue.empty());
    const auto found = queue.pop();
    ASSERT_EQ(found.cost_ns, costs.top()) << "longest hop " << longest_ns << ", push " << pushed;
    costs.pop();
    auto& open = stations[found.cost_ns];
    ASSERT_TRUE(open.contains(found.station)) << "one of those that cost as much, and each once";
    open.erase(open.find(found.station));
    if (pushed > 300) continue;
    for (std::uint32_t n = draws.below(4); n > 0; --n) {
      const auto hop = static_cast<std::int64_t>(draws.uniform() * static_cast<double>(longest_ns));
      const std::int64_t ahead[] = {hop, hop, hop / 16, 0, longest_ns};  // near ones, ties, and the farthest
      push(found.cost_ns + ahead[draws.below(5)]);
    }
  }
  EXPECT_TRUE(queue.empty());
}

TEST(CalendarQueue, PopsWhatAHeapPopsWhateverTheLongestHop) {
  for (std::uint64_t seed = 0; seed < 2'000; ++seed) {
    Draws draws(seed);
    // Every power of two, and the numbers beside it and beside fifteen times it, where slots become longer.
    const std::int64_t power = std::int64_t{1} << draws.below(44);
    const std::int64_t longest_ns = (draws.below(2) == 0 ? power : 15 * power) + draws.below(3) - 1;
    CalendarQueue queue{Duration(longest_ns)};
    for (int search = 0; search < 3; ++search) {
      expect_like_the_oracle(queue, longest_ns, draws);
      queue.rewind();
    }
  }
}

TEST(CalendarQueue, IsEmptyUntilPushedAndAfterTheLastPop) {
  CalendarQueue queue{std::chrono::seconds(7)};
  EXPECT_TRUE(queue.empty());
  queue.push({5, 1});
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ(queue.pop().station, 1U);
  EXPECT_TRUE(queue.empty());
}

// Which of several with one cost comes first is not promised, but it never depends on anything but what was pushed and
// popped.
TEST(CalendarQueue, TiesComeInTheSameOrderEveryTime) {
  std::vector<std::uint32_t> orders[2];
  CalendarQueue used{std::chrono::seconds(1)}, fresh{std::chrono::seconds(1)};
  Draws draws(1);
  expect_like_the_oracle(used, 1'000'000'000, draws);
  used.rewind();
  CalendarQueue* queues[] = {&used, &fresh};
  for (int k = 0; k < 2; ++k) {
    for (std::uint32_t s = 0; s < 20; ++s) queues[k]->push({s % 3 * 1000, s});
    while (!queues[k]->empty()) orders[k].push_back(queues[k]->pop().station);
  }
  EXPECT_EQ(orders[0].size(), 20U);
  EXPECT_EQ(orders[0], orders[1]);
  EXPECT_EQ(orders[0][0], 0U) << "of untouched ones, the first that was pushed";
}

}  // namespace
}  // namespace fleetproof::timetable_test
