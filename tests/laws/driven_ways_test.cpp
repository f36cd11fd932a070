#include "laws/driven_ways.hpp"

#include <gtest/gtest.h>

#include "generators/families/layout_family.hpp"
#include "laws/map_places.hpp"
#include "laws/side_by_side.hpp"

namespace fleetproof::test::driven_ways_test {
namespace {

constexpr double kMargin_m = 0.1;

std::shared_ptr<const LogicalMap> map_of(const char* family, std::uint64_t seed) {
  Draws draws(stream_key(seed, Stream::Layout));
  return draw_map(family_range(family), draws, 2);
}

Piece drive_on(const Lane& lane, const Footprint& footprint) {
  Piece piece;
  piece.manner = Manner::Drive;
  piece.curve = &lane.curve;
  piece.segment = lane.segment;
  piece.footprint = footprint;
  return piece;
}

// Adds what two drives are, without anything remembered or left out.
void add(const Piece& earlier, const Piece& later, StationId to, bool one_place, const MapPlaces& places,
         DrivenWays::Meetings& sum) {
  const Track a = Track::of(*earlier.curve, earlier.footprint), b = Track::of(*later.curve, later.footprint);
  const auto scene = [&](SceneKind met, bool holds) { sum.scenes[static_cast<std::size_t>(met)] += holds ? 1 : 0; };
  const auto kind = encounter_of(a, b, kMargin_m).kind;
  if (kind) ++sum.encounters[static_cast<std::size_t>(*kind)];
  scene(SceneKind::BackIn, kind && (a.tail_first || b.tail_first));
  const SideBySide passing = side_by_side(a, b, kMargin_m);
  scene(SceneKind::TightGap, passing.tight_gap);
  scene(SceneKind::CurveBesideLane, passing.curve_beside_lane);
  scene(SceneKind::OverhangPass, passing.overhang_pass);
  scene(SceneKind::Bottleneck, one_place && places.bottleneck[to.index()]);
  scene(SceneKind::FourWay, one_place && places.four_way[to.index()]);
}

StationId end_of(const LogicalMap& map, const Piece& drive) {
  for (const Lane& lane : map.lanes()) {
    if (&lane.curve == drive.curve) return lane.to;
  }
  return {};
}

class WaysOfFamily : public testing::TestWithParam<const char*> {};

// Every lane after every other one, by bodies of two sizes.
TEST_P(WaysOfFamily, MeetAsTheirTracksDo) {
  const auto map = map_of(GetParam(), 3);
  const MapPlaces places(*map);
  DrivenWays ways(*map, 1, kMargin_m);
  DrivenWays::Meetings expected;
  for (const Footprint& footprint : {Footprint{}, Footprint{2.2, 1.3, 0.4}}) {
    for (const Lane& a : map->lanes()) {
      for (const Lane& b : map->lanes()) {
        const Piece earlier = drive_on(a, Footprint{}), later = drive_on(b, footprint);
        ways.meet(ways.number_of(earlier), ways.number_of(later));
        add(earlier, later, b.to, a.to == b.to && a.segment != b.segment, places, expected);
      }
    }
  }
  EXPECT_EQ(ways.meetings().encounters, expected.encounters);
  EXPECT_EQ(ways.meetings().scenes, expected.scenes);
}

// What is known of a drive, piece by piece.
struct Known {
  Piece first;
  SimTime met_until;
};

// Many pieces of drives of many AGVs, some of them cut short, against every drive before them.
TEST_P(WaysOfFamily, MeetThoseThatBeganBeforeThemAndMayStillBeNear) {
  constexpr std::uint32_t kAgvs = 40;
  const auto map = map_of(GetParam(), 4);
  const MapPlaces places(*map);
  DrivenWays ways(*map, kAgvs, kMargin_m);
  DrivenWays::Meetings expected;
  std::vector<Known> drives;
  std::vector<const Lane*> lanes(kAgvs, nullptr);
  int continued = 0;
  Draws draws(7);
  for (int i = 0; i < 600; ++i) {
    const EntityId agv{static_cast<std::uint32_t>(draws.below(kAgvs))};
    const Lane*& own = lanes[agv.index()];
    if (own == nullptr || draws.below(3) > 0)
      own = &map->lanes()[draws.below(static_cast<std::uint32_t>(map->lanes().size()))];
    const Lane& lane = *own;
    Piece drive = drive_on(lane, draws.below(3) == 0 ? Footprint{2.2, 1.3, 0.4} : Footprint{});
    drive.entity = agv;
    drive.begin = kStart + i * std::chrono::milliseconds(200);
    drive.end = drive.begin + std::chrono::seconds(1 + draws.below(i % 20 == 0 ? 40 : 6));
    const auto last =
        std::find_if(drives.rbegin(), drives.rend(), [&](const Known& k) { return k.first.entity == agv; });
    const bool was_there = last != drives.rend() && last->met_until >= drive.begin;
    ways.begins(drive);
    if (was_there && last->first.curve == drive.curve) {
      last->met_until = drive.end + DrivenWays::kLookAhead;
      ++continued;
      continue;
    }
    if (was_there) last->met_until = std::min(last->met_until, drive.begin + DrivenWays::kLookAhead);
    for (const auto& [earlier, met_until] : drives) {
      if (earlier.entity == agv || met_until < drive.begin) continue;
      const bool one_place = end_of(*map, earlier) == lane.to && earlier.segment != drive.segment;
      add(earlier, drive, lane.to, one_place, places, expected);
    }
    drives.push_back({drive, drive.end + DrivenWays::kLookAhead});
    if (i % 5 > 0) continue;
    const SimTime stands = drive.begin + std::chrono::milliseconds(100);
    ways.ends(agv, stands);
    drives.back().met_until = std::min(drives.back().met_until, stands + DrivenWays::kLookAhead);
  }
  EXPECT_GT(continued, 20);
  EXPECT_EQ(ways.meetings().encounters, expected.encounters);
  EXPECT_EQ(ways.meetings().scenes, expected.scenes);
  EXPECT_GT(expected.encounters[static_cast<std::size_t>(EncounterKind::Following)], 0U);
}

TEST_P(WaysOfFamily, LieInTheirBoxes) {
  const auto map = map_of(GetParam(), 5);
  for (const Lane& lane : map->lanes()) {
    const Footprint footprint{2.2, 1.3, 0.4};
    const Box box = Track::box_of(lane.curve, footprint);
    for (const Track::Point& point : Track::of(lane.curve, footprint).points)
      EXPECT_TRUE(box.overlaps({point.position_m, point.position_m}));
  }
}

TEST_P(WaysOfFamily, HavePointsWhereTheirCurvesHaveThem) {
  const auto map = map_of(GetParam(), 7);
  for (const Lane& lane : map->lanes()) {
    const Track track = Track::of(lane.curve, Footprint{});
    for (const Track::Point& point : track.points) {
      if (point.s_m < 0.0 || point.s_m > track.length_m) continue;
      const Pose pose = lane.curve.pose_at(point.s_m);
      EXPECT_EQ(point.position_m, pose.position_m);
      EXPECT_EQ(point.heading, track.tail_first ? Vec2(-pose.heading) : pose.heading);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, WaysOfFamily,
                         testing::Values("aisle-grid", "loop-spurs/stress", "random-planar/stress", "fishbone",
                                         "dense-crossing", "plant/overhang-pass/80", "plant/tight-gap/40"));

TEST(DrivenWays, CountEveryMeetingOfTheirDrives) {
  const auto map = map_of("aisle-grid", 1);
  const Lane& lane = map->lanes().front();
  DrivenWays ways(*map, 1, kMargin_m);
  const auto small = ways.number_of(drive_on(lane, Footprint{})), large = ways.number_of(drive_on(lane, {2.0, 1.2}));
  EXPECT_NE(small, large);
  EXPECT_EQ(ways.number_of(drive_on(lane, Footprint{})), small);
  for (int i = 0; i < 3; ++i) ways.meet(small, large);
  ways.meet(large, small);
  EXPECT_EQ(ways.meetings().encounters[static_cast<std::size_t>(EncounterKind::Following)], 4U);
}

}  // namespace
}  // namespace fleetproof::test::driven_ways_test
