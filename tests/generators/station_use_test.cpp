// Where AGVs pick, drop and stop in drawn plants with rules, judged from the layout alone.
#include <gtest/gtest.h>

#include <utility>

#include "core/base/random.hpp"
#include "core/scenario/lane_rules.hpp"
#include "generators/map/core_only.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof::station_use_test {
namespace {

// By state (2 * lane + loaded): whether an AGV that has come by it can go on by the other, by search from the layout.
using Table = std::vector<std::vector<bool>>;

bool permits(const LogicalMap& map, std::size_t state) {
  return map.segment(map.lanes()[state / 2].segment).permits("", state % 2 == 1);
}

bool stops_after(const LogicalMap& map, std::size_t lane) {
  const auto& wanted = map.station(map.lanes()[lane].to).heading;
  return !wanted || (map.lanes()[lane].end_heading() - *wanted).norm() < 1e-6;
}

bool goes_on(const LogicalMap& map, std::size_t lane, std::size_t next) {
  return map.lanes()[lane].to == map.lanes()[next].from &&
         (map.station(map.lanes()[lane].to).turning ||
          (map.lanes()[lane].end_heading() - map.lanes()[next].start_heading()).norm() < 1e-6);
}

// Along lanes with one load, after at least no drive.
Table reach_with_one_load(const LogicalMap& map) {
  const std::size_t states = 2 * map.lanes().size();
  Table reach(states, std::vector<bool>(states, false));
  for (std::size_t i = 0; i < states; ++i) {
    for (std::size_t k = 0; k < states; ++k) {
      reach[i][k] = permits(map, i) && permits(map, k) && i % 2 == k % 2 && (i == k || goes_on(map, i / 2, k / 2));
    }
  }
  for (std::size_t via = 0; via < states; ++via) {
    for (std::size_t i = 0; i < states; ++i) {
      for (std::size_t k = 0; k < states; ++k) reach[i][k] = reach[i][k] || (reach[i][via] && reach[via][k]);
    }
  }
  return reach;
}

Layout random_plant(Draws& draws) {
  Layout layout;
  constexpr std::uint32_t kSide = 3;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    Station& station = layout.stations.emplace_back();
    station.name = "s" + std::to_string(i);
    station.position_m = {4.0 * (i % kSide), 4.0 * (i / kSide)};
    station.turning = draws.below(4) > 0;
    if (draws.below(6) == 0) station.heading = Vec2(draws.below(2) == 0 ? 1.0 : -1.0, 0.0);
  }
  const auto join = [&](std::uint32_t from, std::uint32_t to) {
    if (draws.below(8) == 0) return;
    Segment& segment = layout.segments.emplace_back();
    segment.name = std::to_string(layout.segments.size());
    segment.from = StationId{from}, segment.to = StationId{to};
    if (draws.below(2) == 0) std::swap(segment.from, segment.to);
    segment.bidirectional = draws.below(3) > 0;
    if (draws.below(4) == 0) segment.travel = Travel::Either;
    if (segment.bidirectional && draws.below(4) == 0) segment.back_travel = Travel::Backward;
    if (draws.below(3) == 0) segment.permissions = {{"", draws.below(2) == 0 ? LoadState::Empty : LoadState::Loaded}};
  };
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    if (i % kSide + 1 < kSide) join(i, i + 1);
    if (i + kSide < kSide * kSide) join(i, i + kSide);
  }
  return layout;
}

// Whether, from some lane after a transfer or stop at `from`, a way leads to an arrival at `to` after which the AGV can
// do there what it comes for.
class Judge {
 public:
  explicit Judge(const LogicalMap& map) : map_(map), reach_(reach_with_one_load(map)) {}

  // `before`, `after`: whether the AGV has a load when it comes to a station, and when it goes on.
  bool leads(StationId from, bool before, bool loaded, StationId to, bool after) const {
    for (std::size_t out = 0; out < map_.lanes().size(); ++out) {
      if (!leaves(from, before, out, loaded)) continue;
      for (std::size_t in = 0; in < map_.lanes().size(); ++in) {
        if (reach_[2 * out + loaded][2 * in + loaded] && arrives(to, in, loaded, after)) return true;
      }
    }
    return false;
  }

 private:
  bool leaves(StationId station, bool before, std::size_t out, bool after) const {
    if (map_.lanes()[out].from != station || !permits(map_, 2 * out + after)) return false;
    for (std::size_t in = 0; in < map_.lanes().size(); ++in) {
      if (permits(map_, 2 * in + before) && stops_after(map_, in) && goes_on(map_, in, out)) return true;
    }
    return false;
  }
  bool arrives(StationId station, std::size_t in, bool before, bool after) const {
    if (map_.lanes()[in].to != station || !permits(map_, 2 * in + before) || !stops_after(map_, in)) return false;
    for (std::size_t out = 0; out < map_.lanes().size(); ++out) {
      if (permits(map_, 2 * out + after) && goes_on(map_, in, out)) return true;
    }
    return false;
  }

  const LogicalMap& map_;
  Table reach_;
};

TEST(StationUse, LoadsGetFromPicksToDropsAsToldAndEmptyAgvsFromAllDropsToAllPicks) {
  std::size_t limited = 0, whole = 0, pairs = 0, others = 0, missed = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Draws draws(seed);
    const Layout layout = random_plant(draws);
    if (layout.segments.empty() || !has_rules(layout)) continue;
    const LogicalMap map(layout);
    const Reachability reachability(map);
    const Judge judge(map);
    for (std::size_t i = 0; i < layout.stations.size(); ++i) {
      const StationUse& from = reachability.use_of(StationId{i});
      EXPECT_TRUE(from.passed || !(from.started || from.stopped || from.picks || from.drops)) << seed;
      if (from.picks != from.drops) ++limited;
      if (from.picks && from.drops) ++whole;
      for (std::size_t k = 0; k < layout.stations.size(); ++k) {
        const StationUse& to = reachability.use_of(StationId{k});
        const auto leads = [&](bool before, bool loaded, bool after) {
          return i == k || judge.leads(StationId{i}, before, loaded, StationId{k}, after);
        };
        if (from.picks && to.drops && i != k) {
          const bool carried = reachability.carried_from(StationId{i}, 0)[k];
          EXPECT_TRUE(!carried || leads(false, true, false)) << seed << ": " << i << " to " << k;
          missed += !carried && leads(false, true, false) ? 1 : 0;
          EXPECT_TRUE(carried || !reachability.carries_all(0)) << seed;
          ++(carried ? pairs : others);
        }
        EXPECT_TRUE(!(from.drops && to.picks) || leads(true, false, true)) << seed << ": " << i << " to " << k;
        EXPECT_TRUE(!(from.drops && to.stopped) || leads(true, false, false)) << seed << ": " << i << " to " << k;
        EXPECT_TRUE(!(from.stopped && to.picks) || leads(false, false, true)) << seed << ": " << i << " to " << k;
        EXPECT_TRUE(!(from.stopped && to.stopped) || leads(false, false, false)) << seed << ": " << i << " to " << k;
      }
    }
  }
  EXPECT_GT(limited, 500U);
  EXPECT_GT(whole, 500U);
  EXPECT_GT(pairs, 5000U);
  EXPECT_GT(others, 20U);
  EXPECT_LT(missed, pairs / 100) << "from lanes on which no AGV comes again and again";
}

TEST(StationUse, TheCoreOfTheCoreIsTheCore) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Draws draws(seed);
    Layout layout = random_plant(draws);
    keep_core(layout);
    if (layout.segments.empty()) continue;
    const std::size_t stations = layout.stations.size();
    EXPECT_TRUE(keep_core(layout).empty()) << seed << ": of " << stations;
  }
}

}  // namespace
}  // namespace fleetproof::station_use_test
