// Comparing hulls remembers the last one and first looks at boxes and lengths. The answers must be those of comparing
// part by part.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/agents/hull.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::hull_comparison_test {
namespace {

class HullComparison : public ::testing::Test {
 protected:
  std::uint32_t drawn_below(std::uint32_t count) { return static_cast<std::uint32_t>(draw() % count); }

  Path any_path() {
    Path path;
    path.station = drawn_below(map.station_count());
    if (drawn_below(3) == 0) path.heading = {0.0, 1.0};
    for (std::uint32_t lanes = drawn_below(5); lanes > 0; --lanes) {
      const auto leaving = map.lanes_from(end_of(map, path).station);
      path.append(leaving[drawn_below(static_cast<std::uint32_t>(leaving.size()))]);
    }
    return path;
  }

  // In the order in which the AGV covers them.
  std::vector<std::uint32_t> parts_of(const HullParts& parts, std::uint32_t agv, const Path& path) const {
    std::vector<std::uint32_t> numbers;
    Vec heading = path.heading;
    for (const std::uint32_t lane : path.lanes()) {
      const Vec start = map.start_heading(lane);
      if (!same_heading(heading, start)) numbers.push_back(parts.of_turn(agv, map.lane(lane).from, heading, start));
      numbers.push_back(parts.of_lane(agv, lane));
      heading = map.end_heading(lane);
    }
    return numbers;
  }

  // Requires: `a` has lanes.
  bool conflict_by_parts(HullParts& parts, const Path& a, const Path& b) const {
    const Shape standing = body_at(map.position_m(b.station), b.heading, parts.body(1));
    const auto others = parts_of(parts, 1, b);
    return std::ranges::any_of(parts_of(parts, 0, a), [&](std::uint32_t of_a) {
      return b.empty() ? parts.conflicts_with_body(of_a, standing)
                       : std::ranges::any_of(others, [&](std::uint32_t of_b) { return parts.conflict(of_a, of_b); });
    });
  }

  // Stations on a grid that is a little askew, with lanes to the neighbours.
  testing::DrawnMap drawn = [] {
    testing::DrawnMap d;
    for (std::uint32_t i = 0; i < 36; ++i) d.station(4.0 * (i % 6) + 0.3 * (i % 5), 4.5 * (i / 6) + 0.4 * (i % 7));
    for (std::uint32_t i = 0; i < 36; ++i) {
      if (i % 6 < 5) d.segment(i, i + 1);
      if (i < 30) d.segment(i, i + 6);
      if (i % 6 < 5 && i < 30 && i % 3 == 0) d.segment(i, i + 7);
    }
    return d;
  }();
  MapView map{drawn.map()};
  testing::TestFleet fleet = [&] {
    testing::TestFleet f(drawn.map(), 2);
    f.agvs[1].length_m *= 1.7;  // who is who must not be mixed up
    return f;
  }();
  HullGeometry geometry{map, fleet.briefing(0, 0)};
  std::mt19937 draw{20261126};
};

TEST_F(HullComparison, SaysWhatThePartsSay) {
  const fp_briefing briefing = fleet.briefing(0, 0);
  const Facts facts(briefing);
  HullParts by_parts(map, facts.shared(), {HullOptions{}, 0});
  Path a = any_path();
  int conflicts = 0, asked = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (i % 4 == 0) a = any_path();
    const Path b = any_path();
    const bool conflict = geometry.conflict(0, a, 1, b);
    EXPECT_EQ(conflict, geometry.conflict(1, b, 0, a)) << "whichever comes first";
    if (i % 8 == 0) geometry.conflict(1, a, 0, b);
    if (a.empty()) continue;
    ASSERT_EQ(geometry.conflict(0, a, 1, b), conflict) << i;
    ASSERT_EQ(conflict, conflict_by_parts(by_parts, a, b)) << i;
    ++asked, conflicts += conflict ? 1 : 0;
  }
  EXPECT_GT(conflicts, asked / 10);
  EXPECT_LT(conflicts, asked / 2);
}

// Another heading is another hull, though the lanes are the same: the AGV turns before it drives off.
TEST(HullMemory, TellsTurnsApart) {
  testing::DrawnMap drawn;
  drawn.segment(drawn.station(0, 0), drawn.station(6, 0));
  for (int i = 0; i < 20; ++i) drawn.station(-0.5, 0.5 + 0.1 * i);
  const MapView map(drawn.map());
  const testing::TestFleet fleet(drawn.map(), 2);
  HullGeometry geometry(map, fleet.briefing(0, 0));
  Path along, turned, beside;
  turned.heading = {0.0, 1.0};
  along.append(0), turned.append(0);
  int differs = 0;
  for (beside.station = 2; beside.station < map.station_count(); ++beside.station) {
    const bool drives = geometry.conflict(0, along, 1, beside), turns = geometry.conflict(0, turned, 1, beside);
    EXPECT_TRUE(turns || !drives) << "a turn only covers more";
    EXPECT_EQ(geometry.conflict(0, along, 1, beside), drives);
    differs += drives != turns ? 1 : 0;
  }
  EXPECT_GT(differs, 0);
  EXPECT_LT(differs, 20);
}

TEST_F(HullComparison, NoShorterWayMeetsTheOtherPath) {
  int met = 0, spared = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Path a = any_path(), b = any_path();
    const double after_m = geometry.meets_after_m(0, a.station, 1, b);
    double length_m = 0.0;
    for (const std::uint32_t lane : a.lanes()) {
      length_m += map.lane(lane).length_m;
      const std::uint32_t end = map.lane(lane).to;
      const bool meets = geometry.lane_conflict(0, lane, 1, b) || geometry.turn_conflict(0, end, 1, b) ||
                         geometry.turns_conflict(0, end, 1, end_of(map, b).station);
      met += meets ? 1 : 0;
      spared += after_m > length_m ? 1 : 0;
      ASSERT_TRUE(!meets || after_m <= length_m) << i;
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(spared, 1000);
}

}  // namespace
}  // namespace fleetproof::agents::hull_comparison_test
