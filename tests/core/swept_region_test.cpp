#include "core/clearance/swept_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/oracle/known_pairs.hpp"

namespace fleetproof::oracle {
namespace {

// The smallest clearance at a hundred instants of the oracle.
double sampled_m(const TrajectoryPair& pair) {
  double least_m = clearance_m(pair, pair.end);
  for (int i = 0; i < 100; ++i)
    least_m = std::min(least_m, clearance_m(pair, pair.begin + (pair.end - pair.begin) / 100 * i));
  return least_m;
}

// Of all kinds of pairs, moved aside: nothing comes near that is said to be apart, and most that is apart is said to
// be.
TEST(SweptRegion, BodiesThatAreSurelyApartNeverComeNear) {
  constexpr double kDistance_m = 0.3;
  PairSource source(5, PairSource::Bodies::Odd);
  int apart = 0, surely = 0, near = 0;
  for (int i = 0; i < 1'400; ++i) {
    TrajectoryPair pair = source.next(static_cast<Relation>(i % kRelations), 0.1);
    PairSource::move(pair.b, {source.within(-6.0, 6.0), source.within(-6.0, 6.0)});
    const OwnPiece a(pair.a), b(pair.b);
    const bool is_apart = sampled_m(pair) > kDistance_m,
               is_surely = surely_apart(a.piece, b.piece, {at_ns(pair.begin), at_ns(pair.end)}, kDistance_m);
    ASSERT_TRUE(is_apart || !is_surely) << i;
    ++(is_apart ? apart : near);
    surely += is_surely ? 1 : 0;
  }
  EXPECT_GT(near, 200);
  EXPECT_GT(2 * surely, apart);
}

// Beside the middle of a bend, where the chord is far away.
TEST(SweptRegion, ContainsTheOutsideOfABend) {
  const OwnPiece drives(PairSource::drive({{{0.0, 0.0}, {1.0, 0.0}, 6.4, 0.25}}, 0, {}));
  const auto is_apart_from = [&](double beside_m) {
    const double from_centre_m = 4.0 + 0.5 * drives.piece.footprint.width_m + beside_m;
    const Vec2 outside_m = Vec2(0.0, 4.0) + from_centre_m * Vec2(std::sin(0.8), -std::cos(0.8));
    const Piece post = rest_piece(EntityId{1U}, {0.02, 0.02}, {outside_m, Vec2::UnitX()}, kStart);
    return surely_apart(drives.piece, post, {kStart, drives.piece.end}, 0.3);
  };
  EXPECT_FALSE(is_apart_from(0.2));
  EXPECT_TRUE(is_apart_from(1.5));
}

}  // namespace
}  // namespace fleetproof::oracle
