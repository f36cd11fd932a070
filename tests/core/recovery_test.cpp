#include "core/engine/recovery.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds.hpp"

namespace fleetproof {
namespace {

std::vector<std::uint32_t> stations_of(const std::vector<RecoveryPlace>& places) {
  std::vector<std::uint32_t> stations;
  for (const RecoveryPlace& place : places) stations.push_back(place.station.value);
  return stations;
}

TEST(Recovery, AnAgvThatStoodComesBackToItsStationWithItsHeading) {
  const auto map = test::row_map(4);
  const Pose stood{map->station(StationId{1U}).position_m, Vec2::UnitY()};
  const auto places = recovery_places(*map, StationId{1U}, nullptr, stood);
  EXPECT_EQ(stations_of(places), (std::vector<std::uint32_t>{1, 0, 2, 3})) << "by length, then by number";
  EXPECT_EQ(places[0].pose.heading, Vec2::UnitY());
  EXPECT_EQ(places[1].pose.heading, Vec2(-1.0, 0.0)) << "as it would arrive from station 1";
  EXPECT_EQ(places[3].pose.heading, Vec2::UnitX());
  EXPECT_EQ(places[3].pose.position_m, map->station(StationId{3U}).position_m);
}

TEST(Recovery, AnAgvThatStoppedOnALaneIsExpectedAtItsEnd) {
  const auto map = test::row_map(4);
  const Lane* lane = map->lane(SegmentId{1U}, StationId{1U});
  ASSERT_NE(lane, nullptr);
  const auto places = recovery_places(*map, StationId{1U}, lane, {Vec2(5.0, 0.0), Vec2::UnitY()});
  EXPECT_EQ(stations_of(places), (std::vector<std::uint32_t>{2, 1, 3, 0}));
  EXPECT_EQ(places[0].pose.position_m, map->station(StationId{2U}).position_m);
  EXPECT_EQ(places[0].pose.heading, Vec2::UnitX()) << "the heading at the end of the lane";
}

}  // namespace
}  // namespace fleetproof
