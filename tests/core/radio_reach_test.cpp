#include "core/radio/radio_reach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include "core/geometry/rotation.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::radio_reach_test {
namespace {

constexpr std::uint32_t kAgvs = 60;

// AGVs rest, turn, and drive short, long and winding ways on a floor and beside it.
class MovingFleet {
 public:
  // `calm`: most of them stand or turn, and no way is long.
  MovingFleet(double range_m, bool calm)
      : reach(kAgvs, kAgvs, range_m, {Vec2(0.0, 0.0), Vec2(80.0, 50.0)}), calm_(calm), pieces_(kAgvs) {
    for (std::uint32_t i = 0; i < kAgvs; ++i) begin(i);
  }

  double within(double low, double high) { return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::uint32_t any_agv() { return static_cast<std::uint32_t>(random_() % kAgvs); }
  Vec2 place() { return {within(-20.0, 100.0), within(-20.0, 70.0)}; }
  Vec2 position_m(std::uint32_t agv) const { return pieces_[agv].pose_at(now).position_m; }

  void begin(std::uint32_t agv) {
    Piece piece = rest_piece(AgvId{agv}, {}, {place(), unit_vector(within(-3.0, 3.0))}, now);
    if (calm_ && random_() % 2 == 0) {
      piece.manner = Manner::Turn;
      piece.turn_rad = within(-3.0, 3.0);
      piece.profile = MotionProfile(std::abs(piece.turn_rad), {});
      piece.end = now + piece.profile.duration();
    } else if (random_() % 3 != 0) {
      const double length_m = !calm_ && random_() % 5 == 0 ? within(20.0, 90.0) : within(0.5, calm_ ? 3.0 : 8.0);
      const Vec2 to = piece.start.position_m + length_m * piece.start.heading,
                 aside = length_m * unit_vector(within(-3.0, 3.0));
      curves_.push_back(Curve::bezier(
          piece.start.position_m, piece.start.position_m + 0.5 * length_m * piece.start.heading, to + 0.3 * aside, to));
      piece.manner = Manner::Drive;
      piece.curve = &curves_.back();
      piece.way_begin_m = random_() % 2 == 0 ? 0.0 : within(0.0, piece.curve->length_m());
      piece.profile = MotionProfile(piece.curve->length_m() - piece.way_begin_m, {});
      piece.end = now + piece.profile.duration();
    }
    pieces_[agv] = piece;
    reach.piece_begins(piece);
  }
  // To a place of which the file learns nothing.
  void carry(std::uint32_t agv) {
    reach.forget(AgvId{agv});
    pieces_[agv] = rest_piece(AgvId{agv}, {}, {place(), Vec2::UnitX()}, now);
  }

  RadioReach reach;
  SimTime now = kStart;

 private:
  bool calm_;
  std::mt19937_64 random_{3};
  std::deque<Curve> curves_;
  std::vector<Piece> pieces_;
};

// How many answers that name somebody are exact.
std::size_t exact_answers(double range_m, bool calm) {
  std::size_t exact = 0;
  MovingFleet fleet(range_m, calm);
  std::vector<Vec2> places;  // some AGVs ask from the same place again and again
  for (std::uint32_t agv = 0; agv < kAgvs; ++agv) places.push_back(fleet.place());
  std::size_t in_range = 0, looked_at = 0, rounds = 0;
  for (; rounds < 2000; ++rounds) {
    fleet.now += seconds(fleet.within(0.0, 0.5));
    rounds % (calm ? 500 : 50) == 0 ? fleet.carry(fleet.any_agv()) : fleet.begin(fleet.any_agv());
    const std::uint32_t asker = fleet.any_agv();
    if (asker % 3 == 0) places[asker] = rounds % 2 == 0 ? fleet.place() : fleet.position_m(asker);
    const auto [near, is_exact] = fleet.reach.near(AgvId{asker}, places[asker]);
    EXPECT_TRUE(std::ranges::is_sorted(near, std::ranges::less_equal())) << "or one of them is there twice";
    looked_at += near.size();
    std::size_t in_range_now = 0;
    for (std::uint32_t agv = 0; agv < kAgvs; ++agv) {
      if (agv == asker || (fleet.position_m(agv) - places[asker]).norm() > range_m) continue;
      ++in_range_now;
      EXPECT_TRUE(std::ranges::binary_search(near, agv)) << range_m << " " << rounds;
    }
    if (is_exact) {
      EXPECT_EQ(near.size(), in_range_now) << range_m << " " << rounds;
      exact += near.empty() ? 0 : 1;
    }
    in_range += in_range_now;
  }
  EXPECT_GT(in_range, 0U);
  if (range_m < 10.0) {
    EXPECT_LT(looked_at, rounds * kAgvs / 3) << range_m;
  }
  return exact;
}

TEST(RadioReach, FindsAllThatAreInRange) {
  for (const double range_m : {0.5, 7.0, 25.0, 60.0}) {
    exact_answers(range_m, false);
    const std::size_t exact = exact_answers(range_m, true);
    if (range_m == 7.0) {
      EXPECT_GT(exact, 100U);
    }
  }
}

TEST(RadioReach, IsExactAmongThoseWhoStand) {
  const Curve way = Curve::straight({12.0, 0.0}, {17.0, 0.0});
  RadioReach reach(4, 4, 10.0, {Vec2(0.0, 0.0), Vec2(80.0, 50.0)});
  const auto rests_at = [&](std::uint32_t agv, double x_m) {
    reach.piece_begins(rest_piece(AgvId{agv}, {}, {{x_m, 0.0}, Vec2::UnitX()}, kStart));
  };
  const auto asked = [&] {
    const auto [near, is_exact] = reach.near(AgvId{0U}, {0.0, 0.0});
    return std::pair(std::vector(near.begin(), near.end()), is_exact);
  };
  rests_at(0, 0.0), rests_at(1, 10.0), rests_at(2, 10.5), rests_at(3, 60.0);
  const std::pair alone(std::vector{1U}, true);
  EXPECT_EQ(asked(), alone) << "10 m are in range";
  Piece drive = rest_piece(AgvId{2U}, {}, {{12.0, 0.0}, Vec2::UnitX()}, kStart);
  drive.manner = Manner::Drive;
  drive.curve = &way;
  drive.profile = MotionProfile(way.length_m(), {});
  drive.end = drive.begin + drive.profile.duration();
  reach.piece_begins(drive);
  EXPECT_EQ(asked(), alone) << "it drives farther out";
  reach.forget(AgvId{3U});
  EXPECT_EQ(asked(), std::pair(std::vector({1U, 3U}), false)) << "it may be anywhere";
  rests_at(3, 60.0), rests_at(2, -9.0);
  EXPECT_EQ(asked(), std::pair(std::vector({1U, 2U}), true));
  rests_at(1, 11.0);
  EXPECT_EQ(asked(), std::pair(std::vector{2U}, true));
}

}  // namespace
}  // namespace fleetproof::radio_reach_test
