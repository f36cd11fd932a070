#include "generators/map/reachability.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "independent_check.hpp"

namespace fleetproof::reachability_test {
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
        EXPECT_EQ(reachability.reaches(StationId{i}, StationId{k}, false), reach[i][k]) << seed;
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

// What AGVs of one of these types can do at the stations, in their order: "-" nothing, or some of "pass", "start",
// "stop", "pick" and "drop".
std::string uses_of(const Layout& layout, std::vector<std::string> types = {"tugger"}, std::uint32_t type = 0) {
  const LogicalMap map(layout);
  const Reachability reachability(map, types);
  std::vector<std::string> all;
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    const StationUse& use = reachability.use_of(StationId{i}, type);
    std::vector<std::string> words;
    if (use.started) words.push_back("start");
    if (use.stopped) words.push_back("stop");
    if (use.picks) words.push_back("pick");
    if (use.drops) words.push_back("drop");
    if (words.empty()) words.push_back(use.passed ? "pass" : "-");
    all.push_back(fmt::format("{}", fmt::join(words, " ")));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

constexpr const char* kAll = "start stop pick drop";
std::string two_and(const std::string& third) { return std::string(kAll) + ", " + kAll + ", " + third; }

TEST(ReachabilityUnderRules, ADeadEndWithoutTurningIsATrapUnlessOneBacksOut) {
  Layout layout = line_of_three();
  layout.stations[2].turning = false;
  EXPECT_EQ(uses_of(layout), two_and("-"));
  EXPECT_TRUE(Reachability(LogicalMap(layout)).reaches(StationId{0U}, StationId{2U}, true)) << "one gets in";
  layout.segments[1].back_travel = Travel::Backward;
  EXPECT_EQ(uses_of(layout), two_and(kAll));
}

TEST(ReachabilityUnderRules, AHeadingMustBePossible) {
  Layout layout = line_of_three();
  layout.stations[2].heading = Vec2(-1.0, 0.0);
  EXPECT_EQ(uses_of(layout), two_and("start"));
  layout.segments[1].travel = Travel::Either;
  EXPECT_EQ(uses_of(layout), two_and(kAll));
}

TEST(ReachabilityUnderRules, PermissionsCountForEveryType) {
  Layout layout = line_of_three();
  layout.segments[1].permissions = {{"tugger", LoadState::Any}};
  EXPECT_EQ(uses_of(layout), two_and(kAll));
  EXPECT_EQ(uses_of(layout, {"tugger", "forklift"}, 0), two_and(kAll));
  EXPECT_EQ(uses_of(layout, {"tugger", "forklift"}, 1), two_and("-"));
  const LogicalMap map(layout);
  const std::vector<std::string> tugger = {"forklift", "tugger"}, forklift = {"forklift"};
  EXPECT_EQ(Reachability(map, tugger).core().size(), 3U) << "of some type";
  EXPECT_EQ(Reachability(map, forklift).core().size(), 2U);
  EXPECT_EQ(uses_of(layout, {}), two_and(kAll)) << "no fleet yet: all permissions";
}

TEST(ReachabilityUnderRules, PermissionsCountForEveryLoad) {
  Layout layout = line_of_three();
  layout.segments[1].permissions = {{"", LoadState::Loaded}};
  EXPECT_EQ(uses_of(layout), two_and("pass")) << "nobody gets there to take a load up, or away without one";
  layout.segments[1].bidirectional = false;
  layout.segments.push_back({"c-b", StationId{2U}, StationId{1U}, false});
  EXPECT_EQ(uses_of(layout), two_and("start drop")) << "there with a load, back without one";
  layout.segments[1].permissions = {{"", LoadState::Empty}};
  EXPECT_EQ(uses_of(layout), two_and("start stop pick"));
  layout.segments[2].permissions = {{"", LoadState::Loaded}};
  EXPECT_EQ(uses_of(layout), two_and("pick")) << "who comes must take a load away";
  layout.segments[2].permissions = {{"", LoadState::Empty}};
  EXPECT_EQ(uses_of(layout), two_and("start stop")) << "a charger";
}

TEST(ReachabilityUnderRules, LoadsMayGoRoundOneWayAndNoFurther) {
  Layout layout = line_of_three();
  for (Segment& segment : layout.segments) segment.bidirectional = false;
  layout.segments[0].permissions = layout.segments[1].permissions = {{"", LoadState::Loaded}};
  layout.segments.push_back({"c-a", StationId{2U}, StationId{0U}, false});
  layout.segments.back().permissions = {{"", LoadState::Empty}};
  EXPECT_EQ(uses_of(layout), "pick, pass, start drop");
  layout.stations.push_back({"d", {0.0, 5.0}});
  layout.segments.insert(layout.segments.begin(), {"a-d", StationId{0U}, StationId{3U}, false});
  EXPECT_EQ(uses_of(layout), "pick, pass, start drop, -") << "a dead end is as many lanes, and comes first";
}

TEST(ReachabilityUnderRules, LoadsFromTwoSourcesMeetOnTheirWayToOneSink) {
  Layout layout;
  layout.stations = {{"source 1", {0.0, 0.0}}, {"source 2", {0.0, 5.0}}, {"fork", {5.0, 0.0}}, {"sink", {10.0, 0.0}}};
  const auto join = [&](std::uint32_t from, std::uint32_t to, LoadState load) {
    layout.segments.push_back({std::to_string(layout.segments.size()), StationId{from}, StationId{to}, false});
    layout.segments.back().permissions = {{"", load}};
  };
  join(0, 2, LoadState::Loaded), join(1, 2, LoadState::Loaded), join(2, 3, LoadState::Loaded);
  join(3, 0, LoadState::Empty), join(3, 1, LoadState::Empty);
  EXPECT_EQ(uses_of(layout), "pick, pick, pass, start drop");
}

// Two sources, a fork, two sinks; back without a load by another fork.
TEST(ReachabilityUnderRules, WaysThatMeetAtAStationAloneAreWays) {
  Layout layout;
  layout.stations = {{"source 1", {0.0, 0.0}}, {"source 2", {0.0, 9.0}}, {"fork", {5.0, 4.0}},
                     {"sink 1", {10.0, 0.0}},  {"sink 2", {10.0, 9.0}},  {"back", {5.0, 5.0}}};
  const auto join = [&](std::uint32_t from, std::uint32_t to, LoadState load) {
    layout.segments.push_back({std::to_string(layout.segments.size()), StationId{from}, StationId{to}, false});
    layout.segments.back().permissions = {{"", load}};
  };
  join(0, 2, LoadState::Loaded), join(1, 2, LoadState::Loaded);
  join(2, 3, LoadState::Loaded), join(2, 4, LoadState::Loaded);
  join(3, 5, LoadState::Empty), join(4, 5, LoadState::Empty);
  join(5, 0, LoadState::Empty), join(5, 1, LoadState::Empty);
  EXPECT_EQ(uses_of(layout), "pick, pick, pass, start drop, start drop, start");
}

// A ring with one lane for loads alone, and one for AGVs without.
TEST(ReachabilityUnderRules, ARingMayBeDividedByLoads) {
  Layout layout;
  for (std::uint32_t i = 0; i < 8; ++i) layout.stations.push_back({std::to_string(i), {5.0 * i, i < 4 ? 0.0 : 5.0}});
  for (std::uint32_t i = 0; i < 8; ++i)
    layout.segments.push_back({"e" + std::to_string(i), StationId{i}, StationId{(i + 1) % 8}, false});
  layout.segments[0].permissions = {{"", LoadState::Loaded}};
  layout.segments[4].permissions = {{"", LoadState::Empty}};
  const LogicalMap map(layout);
  const Reachability reachability(map);
  EXPECT_EQ(reachability.core().size(), 8U);
  EXPECT_FALSE(reachability.starts().empty());
  const auto some = [&](bool StationUse::*use) {
    return std::ranges::any_of(reachability.core(), [&](StationId s) { return reachability.use_of(s).*use; });
  };
  EXPECT_TRUE(some(&StationUse::picks) && some(&StationUse::drops));
}

// An AGV that comes from the other side could not go on with a load.
TEST(ReachabilityUnderRules, APickIsPossibleHoweverAnAgvComes) {
  Layout layout = line_of_three();
  layout.stations[1].turning = false;
  layout.segments[0].permissions = {{"", LoadState::Empty}};
  EXPECT_EQ(uses_of(layout), "start stop, start stop drop, start stop pick drop") << "b is no place to pick";
}

TEST(ReachabilityUnderRules, WhereNoAgvGetsOutWithoutALoadNoneBelongs) {
  Layout layout = line_of_three();
  for (Segment& segment : layout.segments) segment.permissions = {{"", LoadState::Loaded}};
  EXPECT_EQ(uses_of(layout), "-, -, -");
}

}  // namespace
}  // namespace fleetproof::reachability_test
