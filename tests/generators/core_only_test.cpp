// The core of a layout, against paths by Warshall.
#include "generators/map/core_only.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.hpp"
#include "independent_check.hpp"

namespace fleetproof::core_only_test {
namespace {

Layout drawn(std::uint64_t seed) {
  Draws draws(seed);
  Layout layout;
  const std::size_t stations = 2 + draws.below(12), segments = draws.below(25);
  for (std::size_t i = 0; i < stations; ++i) {
    auto& station = layout.stations.emplace_back();
    station.name = "s" + std::to_string(i);
    station.position_m = {static_cast<double>(i), 0.0};
  }
  for (std::size_t i = 0; i < segments; ++i) {
    auto& segment = layout.segments.emplace_back();
    segment.name = "g" + std::to_string(i);
    segment.from = StationId{draws.below(static_cast<std::uint32_t>(stations))};
    segment.to = StationId{draws.below(static_cast<std::uint32_t>(stations))};
    segment.bidirectional = draws.below(4) == 0;
  }
  return layout;
}

// Names of the largest set that can all reach each other; of equal sets, that of the first station.
std::vector<std::string> core_names(const Layout& layout) {
  const auto reach = independent::reach(layout);
  std::vector<std::string> largest;
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < layout.stations.size(); ++k) {
      if (reach[i][k] && reach[k][i]) names.push_back(layout.stations[k].name);
    }
    if (names.size() > largest.size()) largest = names;
  }
  return largest;
}

TEST(CoreOnly, IsTheLargestPartWithItsSegments) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Layout whole = drawn(seed);
    const auto expected = core_names(whole);
    Layout core = whole;
    const auto cut_off = keep_core(core);
    ASSERT_EQ(core.stations.size(), expected.size()) << seed;
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(core.stations[i].name, expected[i]) << seed;
    EXPECT_EQ(cut_off.size() + expected.size(), whole.stations.size());
    for (const auto& name : cut_off) EXPECT_EQ(std::ranges::count(expected, name), 0) << seed;
    std::vector<std::string> ways, expected_ways;
    const auto way = [](const Layout& layout, const Segment& s) {
      return layout.stations[s.from.index()].name + s.name + layout.stations[s.to.index()].name;
    };
    for (const auto& s : core.segments) ways.push_back(way(core, s));
    for (const auto& s : whole.segments) {
      const auto inside = [&](StationId id) {
        return std::ranges::count(expected, whole.stations[id.index()].name) > 0;
      };
      if (inside(s.from) && inside(s.to)) expected_ways.push_back(way(whole, s));
    }
    EXPECT_EQ(ways, expected_ways) << seed;
  }
}

TEST(CoreOnly, IsToldInNumbersAndNames) {
  Layout layout;
  for (const char* name : {"a", "b", "\u4ED3\u5E93"}) layout.stations.emplace_back().name = name;
  auto& there = layout.segments.emplace_back();
  there.from = StationId{0U}, there.to = StationId{1U}, there.bidirectional = true;
  layout.stations[1].purposes = Purposes(Purpose::Storage) | Purpose::Parking;
  EXPECT_EQ(reachability_text(layout), "2 of 3 stations can all reach each other; cut off: \"\u4ED3\u5E93\"");
  EXPECT_EQ(purposes_summary(layout), "1 storage, 0 charging, 1 parking");
  keep_core(layout);
  EXPECT_EQ(reachability_text(layout), "all 2 stations can reach each other");
}

TEST(CoreOnly, LongNamesAreToldInFull) {
  Layout layout;
  const std::string hall(190, 'x');
  for (const char* end : {"1", "2", "3", "4"}) layout.stations.emplace_back().name = hall + end;
  auto& there = layout.segments.emplace_back();
  there.from = StationId{0U}, there.to = StationId{1U}, there.bidirectional = true;
  EXPECT_EQ(reachability_text(layout),
            "2 of 4 stations can all reach each other; cut off: \"" + hall + "3\", \"" + hall + "4\"");
}

}  // namespace
}  // namespace fleetproof::core_only_test
