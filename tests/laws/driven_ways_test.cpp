#include "laws/driven_ways.hpp"

#include <gtest/gtest.h>

#include "generators/families/layout_family.hpp"
#include "laws/map_places.hpp"
#include "laws/side_by_side.hpp"

namespace fleetproof::test {
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
  const auto kind = encounter_of(a, b, kMargin_m);
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

// Many drives of many AGVs, some of them cut short, against every one before them.
TEST_P(WaysOfFamily, MeetThoseThatBeganBeforeThemAndMayStillBeNear) {
  constexpr std::uint32_t kAgvs = 40;
  const auto map = map_of(GetParam(), 4);
  const MapPlaces places(*map);
  DrivenWays ways(*map, kAgvs, kMargin_m);
  DrivenWays::Meetings expected;
  std::vector<Piece> drives;
  std::vector<SimTime> met_until, latest(kAgvs, kStart);
  Draws draws(7);
  for (int i = 0; i < 400; ++i) {
    const Lane& lane = map->lanes()[draws.below(static_cast<std::uint32_t>(map->lanes().size()))];
    Piece drive = drive_on(lane, draws.below(3) == 0 ? Footprint{2.2, 1.3, 0.4} : Footprint{});
    drive.entity = EntityId{static_cast<std::uint32_t>(draws.below(kAgvs))};
    drive.begin = kStart + i * std::chrono::milliseconds(200);
    drive.end = drive.begin + std::chrono::seconds(1 + draws.below(i % 20 == 0 ? 40 : 6));
    for (std::size_t k = 0; k < drives.size(); ++k) {
      if (drives[k].entity == drive.entity || met_until[k] < drive.begin) continue;
      const StationId to = lane.to;
      const bool one_place = end_of(*map, drives[k]) == to && drives[k].segment != drive.segment;
      add(drives[k], drive, to, one_place, places, expected);
    }
    SimTime& until = latest[drive.entity.index()];
    until = std::max(until, drive.end + DrivenWays::kLookAhead);
    drives.push_back(drive);
    met_until.push_back(until);
    ways.begins(drive);
  }
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
                                         "dense-crossing", "plant/overhang-pass/40", "plant/tight-gap/40"));

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
}  // namespace fleetproof::test
