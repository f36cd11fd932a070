#include "core/clearance/swept_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/oracle/known_pairs.hpp"

namespace fleetproof::oracle::swept_region_test {
namespace {

constexpr int kInstants = 100;

// The clearance at instants of the oracle.
std::vector<std::pair<SimTime, double>> sampled_m(const TrajectoryPair& pair) {
  std::vector<std::pair<SimTime, double>> sampled;
  for (int i = 0; i <= kInstants; ++i) {
    const auto t = i < kInstants ? pair.begin + (pair.end - pair.begin) / kInstants * i : pair.end;
    sampled.emplace_back(at_ns(t), clearance_m(pair, t));
  }
  return sampled;
}

// Of all kinds of pairs, moved aside: nothing comes near outside the part, and most that is apart is said to be.
TEST(SweptRegion, BodiesComeNearOnlyInThePart) {
  constexpr double kDistance_m = 0.3;
  PairSource source(5, PairSource::Bodies::Odd);
  int apart = 0, surely = 0, near = 0, shorter = 0;
  for (int i = 0; i < 1'400; ++i) {
    TrajectoryPair pair = source.next(static_cast<Relation>(i % kRelations), 0.1);
    PairSource::move(pair.b, {source.within(-6.0, 6.0), source.within(-6.0, 6.0)});
    const OwnPiece a(pair.a), b(pair.b);
    const Interval whole{at_ns(pair.begin), at_ns(pair.end)};
    const auto part = near_part(a.piece, b.piece, whole, kDistance_m);
    bool is_apart = true;
    for (const auto& [t, distance_m] : sampled_m(pair)) {
      if (distance_m > kDistance_m) continue;
      is_apart = false;
      ASSERT_TRUE(part && part->begin <= t && t <= part->end) << i;
    }
    ++(is_apart ? apart : near);
    surely += part ? 0 : 1;
    shorter += part && (whole.begin < part->begin || part->end < whole.end) ? 1 : 0;
  }
  EXPECT_GT(near, 200);
  EXPECT_GT(shorter, near / 10);
  EXPECT_GT(2 * surely, apart);
}

// Beside the middle of a bend, where the chord is far away.
TEST(SweptRegion, ContainsTheOutsideOfABend) {
  const OwnPiece drives(PairSource::drive({{{0.0, 0.0}, {1.0, 0.0}, 6.4, 0.25}}, 0, {}));
  const auto is_apart_from = [&](double beside_m) {
    const double from_centre_m = 4.0 + 0.5 * drives.piece.footprint.width_m + beside_m;
    const Vec2 outside_m = Vec2(0.0, 4.0) + from_centre_m * Vec2(std::sin(0.8), -std::cos(0.8));
    const Piece post = rest_piece(EntityId{1U}, {0.02, 0.02}, {outside_m, Vec2::UnitX()}, kStart);
    return !near_part(drives.piece, post, {kStart, drives.piece.end}, 0.3);
  };
  EXPECT_FALSE(is_apart_from(0.2));
  EXPECT_TRUE(is_apart_from(1.5));
}

}  // namespace
}  // namespace fleetproof::oracle::swept_region_test
