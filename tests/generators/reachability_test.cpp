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

}  // namespace
}  // namespace fleetproof
