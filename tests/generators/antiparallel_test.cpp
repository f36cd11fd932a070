#include "generators/map/antiparallel.hpp"

#include <gtest/gtest.h>

namespace fleetproof::antiparallel_test {
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
  ASSERT_EQ(merge_antiparallel(layout).names.size(), 1U);
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
  ASSERT_EQ(merge_antiparallel(layout).names.size(), 1U);
  EXPECT_EQ(layout.segments[0].blocks, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Antiparallel, ABlockOfOneDirectionAloneIsTold) {
  const auto told = [](const std::vector<std::uint32_t>& there, const std::vector<std::uint32_t>& back) {
    Layout layout = twins();
    layout.segments[0].blocks = there;
    layout.segments[1].blocks = back;
    std::vector<std::string> sentences;
    settle_twins(layout, TwinPaths::Merge, "file", sentences);
    return sentences.size() == 2 ? sentences[1] : "";
  };
  const std::string sentence =
      "file: 1 of these pairs had blocks of one direction alone (\"there\"); here both directions belong to them";
  EXPECT_EQ(told({0}, {}), sentence);
  EXPECT_EQ(told({}, {0}), sentence);
  EXPECT_EQ(told({0, 1}, {1}), sentence);
  EXPECT_EQ(told({0, 1}, {1, 0}), "");
}

TEST(Antiparallel, WhatStaysOnATrackIsTold) {
  const auto sentences = [](const Layout& given) {
    Layout layout = given;
    std::vector<std::string> told;
    settle_twins(layout, TwinPaths::Merge, "file", told);
    return told;
  };
  const std::string stays =
      "file: 1 segments lie on the track of another one and stay beside it, because both lead the same way, one is "
      "two-way, or other AGVs may drive it (\"back\")";
  Layout permitted = twins(), two_way = twins(), same_way = twins(), apart = twins();
  permitted.segments[1].permissions = {{"fork", LoadState::Any}};
  two_way.segments[0].bidirectional = true;
  std::swap(same_way.segments[1].from, same_way.segments[1].to);
  apart.segments[0].bidirectional = true;
  apart.segments[1].control_points_m = {{4.0, 1.0}, {1.0, 1.0}};
  for (const Layout& layout : {permitted, two_way, same_way}) EXPECT_EQ(sentences(layout), std::vector{stays});
  EXPECT_TRUE(sentences(apart).empty());
  EXPECT_EQ(sentences(twins()).size(), 1U) << "only that they became one";
}

}  // namespace
}  // namespace fleetproof::antiparallel_test
