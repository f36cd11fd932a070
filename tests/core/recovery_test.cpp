#include "core/engine/recovery.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds.hpp"

namespace fleetproof::recovery_test {
namespace {

std::vector<std::uint32_t> stations_of(const std::vector<RecoveryPlace>& places) {
  std::vector<std::uint32_t> stations;
  for (const RecoveryPlace& place : places) stations.push_back(place.station.value);
  return stations;
}

TEST(Recovery, AnAgvThatStoodComesBackToItsStationWithItsHeading) {
  const auto map = test::row_map(4);
  const Pose stood{map->station(StationId{1U}).position_m, Vec2::UnitY()};
  const auto places = recovery_places({*map, ""}, StationId{1U}, nullptr, stood);
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
  const auto places = recovery_places({*map, ""}, StationId{1U}, lane, {Vec2(5.0, 0.0), Vec2::UnitY()});
  EXPECT_EQ(stations_of(places), (std::vector<std::uint32_t>{2, 1, 3, 0}));
  EXPECT_EQ(places[0].pose.position_m, map->station(StationId{2U}).position_m);
  EXPECT_EQ(places[0].pose.heading, Vec2::UnitX()) << "the heading at the end of the lane";
}

TEST(Recovery, AnAgvIsSetDownAsTheStationDemandsAndNeverWhereItCouldNotDriveOff) {
  Layout layout = test::row_map(5)->layout();
  layout.stations[2].heading = Vec2::UnitY();
  layout.stations[4].turning = false;  // whoever comes to the last station could not turn back
  layout.segments[0].permissions = {{"", LoadState::Empty}};
  const LogicalMap map(layout);
  const Pose stood{map.station(StationId{1U}).position_m, Vec2::UnitX()};
  const auto empty = recovery_places({map, "", false}, StationId{1U}, nullptr, stood);
  EXPECT_EQ(stations_of(empty), (std::vector<std::uint32_t>{1, 0, 2, 3}));
  EXPECT_EQ(empty[2].pose.heading, Vec2::UnitY());
  const auto loaded = recovery_places({map, "", true}, StationId{1U}, nullptr, stood);
  EXPECT_EQ(stations_of(loaded), (std::vector<std::uint32_t>{1, 2, 3})) << "a load may not leave station 0";
}

}  // namespace
}  // namespace fleetproof::recovery_test
