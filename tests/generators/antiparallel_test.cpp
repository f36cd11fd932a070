#include "generators/map/antiparallel.hpp"

#include <gtest/gtest.h>

namespace fleetproof {
namespace {

// a and b, with a segment each way.
Layout twins() {
  Layout layout;
  layout.stations = {{"a", {0.0, 0.0}}, {"b", {5.0, 0.0}}};
  layout.blocks = {{"dock"}, {"aisle"}, {"lift"}};
  Segment there;
  there.name = "there";
  there.from = StationId{0U};
  there.to = StationId{1U};
  Segment back = there;
  back.name = "back";
  std::swap(back.from, back.to);
  layout.segments = {there, back};
  return layout;
}

TEST(Antiparallel, EachWayKeepsItsSpeedLimit) {
  Layout layout = twins();
  layout.segments[0].speed_limit_mps = 1.5;
  layout.segments[1].speed_limit_mps = 0.5;
  layout.segments[1].width_m = 2.0;
  ASSERT_EQ(merge_antiparallel(layout).size(), 1U);
  ASSERT_EQ(layout.segments.size(), 1U);
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(layout.segments[0].name, "there");
  EXPECT_EQ(layout.segments[0].speed_limit_mps, 1.5);
  EXPECT_EQ(layout.segments[0].back_speed_limit_mps, 0.5);
  EXPECT_EQ(layout.segments[0].width_m, 2.0);
}

TEST(Antiparallel, TheSegmentBelongsToTheBlocksOfBoth) {
  Layout layout = twins();
  layout.segments[0].blocks = {0, 2};
  layout.segments[1].blocks = {1, 2};
  ASSERT_EQ(merge_antiparallel(layout).size(), 1U);
  EXPECT_EQ(layout.segments[0].blocks, (std::vector<std::uint32_t>{0, 1, 2}));
}

}  // namespace
}  // namespace fleetproof
