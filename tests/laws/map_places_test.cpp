#include "laws/map_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "generators/families/layout_family.hpp"
#include "laws/laws.hpp"
#include "tests/laws/timeline.hpp"

namespace fleetproof::test::map_places_test {
namespace {

// By taking each station out and walking from every other one: how many remain together at most.
std::vector<bool> bottlenecks_by_trial(const Layout& layout) {
  const std::size_t n = layout.stations.size();
  std::vector<bool> found(n);
  for (std::size_t without = 0; without < n; ++without) {
    std::vector<bool> seen(n);
    std::size_t largest = 0;
    for (std::size_t start = 0; start < n; ++start) {
      if (seen[start] || start == without) continue;
      std::set<std::size_t> part{start};
      for (bool grows = true; grows;) {
        grows = false;
        for (const Segment& s : layout.segments) {
          const std::size_t a = s.from.index(), b = s.to.index();
          if (a == without || b == without || part.contains(a) == part.contains(b)) continue;
          part.insert({a, b});
          grows = true;
        }
      }
      for (const std::size_t station : part) seen[station] = true;
      largest = std::max(largest, part.size());
    }
    found[without] = (n - 1 - largest) * 10 >= n;
  }
  return found;
}

class PlacesOfFamily : public testing::TestWithParam<const char*> {};

TEST_P(PlacesOfFamily, BottlenecksAreThoseFoundByTrial) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Draws draws(stream_key(seed, Stream::Layout));
    const auto map = draw_map(family_range(GetParam()), draws, 2);
    EXPECT_EQ(MapPlaces(*map).bottleneck, bottlenecks_by_trial(map->layout())) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, PlacesOfFamily,
                         testing::Values("aisle-grid", "aisle-grid/stress", "corridor-sidings", "loop-spurs",
                                         "random-planar/stress", "fishbone", "plant", "plant/bottleneck/180"));

// Two squares joined by one lane: the stations of the joint are bottlenecks. The left joint has four sides.
Layout dumbbell() {
  Layout layout;
  for (const Vec2& p : {Vec2(0, 0), Vec2(-5, 0), Vec2(0, 5), Vec2(0, -5), Vec2(5, 0), Vec2(10, 5), Vec2(10, -5)})
    layout.stations.push_back({"s" + std::to_string(layout.stations.size()), p, Purpose::Routing});
  const auto lane = [&](std::size_t a, std::size_t b) {
    layout.segments.push_back(
        {layout.stations[a].name + layout.stations[b].name, StationId{a}, StationId{b}, true, {}});
  };
  for (const std::size_t side : {1U, 2U, 3U, 4U}) lane(0, side);
  lane(4, 5);
  lane(4, 6);
  return layout;
}

TEST(MapPlaces, FourWaysAreStationsWithLanesFromFourSides) {
  const MapPlaces places{LogicalMap(dumbbell())};
  EXPECT_EQ(places.four_way, (std::vector<bool>{true, false, false, false, false, false, false}));
}

using Met = std::map<std::string, std::uint64_t>;

// Two AGVs that drive these segments, the second one `later_s` after the first one.
Met met_by(SegmentId first, SegmentId second, double later_s) {
  Scenario scenario;
  scenario.map = std::make_shared<const LogicalMap>(dumbbell());
  scenario.agvs.resize(2);
  const auto law = find_law("coverage")->make(scenario);
  std::vector<Timeline> bodies;
  for (std::uint32_t agv = 0; agv < 2; ++agv) {
    const Segment& segment = scenario.map->segment(agv == 0 ? first : second);
    // Against the segment: towards station 0.
    const Curve curve = segment_curve(scenario.map->layout(), segment).reversed();
    bodies.emplace_back(EntityId{agv}, curve.pose_at(0.0), Footprint{});
    bodies.back().wait_until(1.0 + agv * later_s).drive(curve);
  }
  std::vector<Piece> pieces;
  for (const Timeline& body : bodies) {
    for (const Piece& piece : body.until(at_seconds(60.0))) pieces.push_back(piece);
  }
  std::ranges::stable_sort(pieces, {}, &Piece::begin);
  for (Piece& piece : pieces) {
    if (piece.manner == Manner::Drive) piece.segment = piece.entity == EntityId{0U} ? first : second;
    piece.planned_box = piece.swept_box(piece.end);
    law->piece_started(piece);
  }
  Met counts;
  for (const ProbeCount& probe : law->findings().met) {
    if (probe.name == "four-way" || probe.name == "bottleneck") counts[probe.name] = probe.count;
  }
  return counts;
}

TEST(MapPlaces, TwoThatComeFromDifferentSidesWithinTenSecondsMeet) {
  const Met both{{"four-way", 1}, {"bottleneck", 1}};
  EXPECT_EQ(met_by(SegmentId{0U}, SegmentId{1U}, 2.0), both);
  EXPECT_EQ(met_by(SegmentId{0U}, SegmentId{3U}, 14.0), both) << "5.48 s of driving, and 8.5 s later";
  EXPECT_EQ(met_by(SegmentId{0U}, SegmentId{3U}, 16.0), Met{}) << "10.5 s later";
  EXPECT_EQ(met_by(SegmentId{0U}, SegmentId{0U}, 2.0), Met{}) << "one behind the other";
  EXPECT_EQ(met_by(SegmentId{0U}, SegmentId{4U}, 2.0), Met{}) << "to another station";
}

}  // namespace
}  // namespace fleetproof::test::map_places_test
