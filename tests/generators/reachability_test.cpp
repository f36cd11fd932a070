#include "generators/map/reachability.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "independent_check.hpp"

namespace fleetproof {
namespace {

Layout random_layout(Draws& draws) {
  Layout layout;
  const std::uint32_t n = 2 + draws.below(12);
  for (std::uint32_t i = 0; i < n; ++i)
    layout.stations.push_back({std::to_string(i), {4.0 * i, 0.0}, Purpose::Routing});
  for (std::uint32_t k = draws.below(2 * n); k > 0; --k) {
    const std::uint32_t from = draws.below(n), to = draws.below(n);
    if (from != to)
      layout.segments.push_back({std::to_string(k), StationId{from}, StationId{to}, draws.below(4) == 0, {}});
  }
  return layout;
}

TEST(Reachability, AgreesWithFloydWarshallOnRandomMaps) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Draws draws(seed);
    const Layout layout = random_layout(draws);
    const LogicalMap map(layout);
    const Reachability reachability(map);
    const auto reach = independent::reach(layout);
    std::size_t largest = 0;
    for (std::size_t i = 0; i < reach.size(); ++i) {
      std::size_t mutual = 0;
      for (std::size_t k = 0; k < reach.size(); ++k) {
        EXPECT_EQ(reachability.reaches(StationId{i}, StationId{k}), reach[i][k]) << seed;
        if (reach[i][k] && reach[k][i]) ++mutual;
      }
      largest = std::max(largest, mutual);
    }
    ASSERT_EQ(reachability.core().size(), largest) << seed;
    const auto first = reachability.core()[0].index();
    for (std::size_t k = 0; k < reach.size(); ++k)
      EXPECT_EQ(reachability.in_core(StationId{k}), reach[first][k] && reach[k][first]) << seed;
  }
}

TEST(Reachability, LongChainsDoNotExhaustTheStack) {
  Layout layout;
  constexpr std::size_t kStations = 100'000;
  for (std::size_t i = 0; i < kStations; ++i)
    layout.stations.push_back({"", {static_cast<double>(i), 0.0}, Purpose::Routing});
  for (std::size_t i = 0; i < kStations; ++i)
    layout.segments.push_back({"", StationId{i}, StationId{(i + 1) % kStations}, false, {}});
  const LogicalMap map(layout);
  EXPECT_EQ(Reachability(map).core().size(), kStations);
}

// a - b - c on a line, both ways, nose first.
Layout line_of_three() {
  Layout layout;
  layout.stations = {{"a", {0.0, 0.0}}, {"b", {5.0, 0.0}}, {"c", {10.0, 0.0}}};
  layout.segments = {{"a-b", StationId{0U}, StationId{1U}, true}, {"b-c", StationId{1U}, StationId{2U}, true}};
  return layout;
}

std::size_t core_of(const Layout& layout, std::vector<std::string> types = {"tugger"}) {
  const LogicalMap map(layout);
  return Reachability(map, types).core().size();
}

TEST(ReachabilityUnderRules, ADeadEndWithoutTurningIsATrapUnlessOneBacksOut) {
  Layout layout = line_of_three();
  layout.stations[2].turning = false;
  EXPECT_EQ(core_of(layout), 2U);
  EXPECT_TRUE(Reachability(LogicalMap(layout)).reaches(StationId{0U}, StationId{2U})) << "one gets in";
  layout.segments[1].back_travel = Travel::Backward;
  EXPECT_EQ(core_of(layout), 3U);
}

TEST(ReachabilityUnderRules, AHeadingMustBePossible) {
  Layout layout = line_of_three();
  layout.stations[2].heading = Vec2(-1.0, 0.0);
  EXPECT_EQ(core_of(layout), 2U);
  layout.segments[1].travel = Travel::Either;
  EXPECT_EQ(core_of(layout), 3U);
}

TEST(ReachabilityUnderRules, PermissionsCountForEveryTypeAndLoad) {
  Layout layout = line_of_three();
  layout.segments[1].permissions = {{"tugger", LoadState::Any}};
  EXPECT_EQ(core_of(layout), 3U);
  EXPECT_EQ(core_of(layout, {"tugger", "forklift"}), 2U);
  EXPECT_EQ(core_of(layout, {}), 3U) << "no fleet yet: all permissions";
  layout.segments[1].permissions = {{"", LoadState::Loaded}};
  EXPECT_EQ(core_of(layout), 2U) << "nobody gets there to take a load up";
  layout.segments.push_back({"c-b", StationId{2U}, StationId{1U}, false});
  layout.segments[1].bidirectional = false;
  EXPECT_EQ(core_of(layout), 2U) << "there with a load, back without one: nothing can be fetched";
  layout.segments.push_back({"b-c 2", StationId{1U}, StationId{2U}, true});
  layout.segments.back().permissions = {{"", LoadState::Empty}};
  EXPECT_EQ(core_of(layout), 3U) << "c-b is for all";
}

}  // namespace
}  // namespace fleetproof
