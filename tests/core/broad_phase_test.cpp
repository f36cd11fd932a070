#include "core/geometry/broad_phase.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <tuple>

#include "core/geometry/rotation.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test::broad_phase_test {
namespace {

class Floor {
 public:
  double within(double low, double high) { return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  bool one_in(std::uint64_t n) { return random_() % n == 0; }
  std::size_t below(std::size_t n) { return random_() % n; }
  // Bodies, drives, now and then a wall across the floor, and one far out.
  Box box() {
    const double longest_m = one_in(20) ? 700.0 : one_in(3) ? 20.0 : 3.0;
    const Vec2 low = one_in(50) ? Vec2(within(-1e15, 1e15), 0.0) : Vec2(within(-60.0, 60.0), within(-60.0, 60.0));
    // On the grid's own lines too.
    const Vec2 at = one_in(5) ? Vec2(8.0 * std::round(low.x() / 8.0), 8.0 * std::round(low.y() / 8.0)) : low;
    return {at, at + Vec2(within(0.0, longest_m), within(0.0, longest_m))};
  }

 private:
  std::mt19937_64 random_{5};
};

TEST(BroadPhase, GridAndScanAnswerAsEveryBoxOnItsOwn) {
  constexpr std::size_t kBodies = 90;
  Floor floor;
  BroadPhase grid(kBodies, 0), scan(kBodies, kBodies);
  std::vector<Box> boxes(kBodies);
  std::size_t met = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::size_t body = floor.below(kBodies);
    const bool is_placed = boxes[body].low_m.x() <= boxes[body].high_m.x();
    const Box next = floor.one_in(4) ? Box{} : is_placed && floor.one_in(2) ? boxes[body].grown(0.3) : floor.box();
    for (BroadPhase* phase : {&grid, &scan}) {
      if (next.low_m.x() > next.high_m.x() || floor.one_in(2)) phase->remove(body);
      if (next.low_m.x() <= next.high_m.x()) phase->place(body, next);
    }
    boxes[body] = next;
    const Box asked = floor.box();
    std::vector<std::uint32_t> expected;
    for (std::size_t k = 0; k < kBodies; ++k) {
      if (asked.overlaps(boxes[k])) expected.push_back(static_cast<std::uint32_t>(k));
    }
    met += expected.size();
    for (BroadPhase* phase : {&grid, &scan}) {
      const auto found = phase->overlapping(asked);
      ASSERT_EQ(std::vector(found.begin(), found.end()), expected) << i;
    }
  }
  EXPECT_GT(met, 20'000U);
}

// More bodies than are scanned: each pair has the violations that it has when the two are alone.
TEST(BroadPhase, InACrowdPairsViolateAsTheyDoAlone) {
  Floor floor;
  const auto live = [&](Timeline& body) {
    while (body.now() < at_seconds(20.0))
      body.wait_until(to_seconds(body.now()) + floor.within(0.0, 2.0))
          .turn(floor.within(-3.0, 3.0))
          .drive(floor.within(1.0, 6.0));
  };
  Scene crowd(20.0);
  for (std::size_t i = 0; i < BroadPhase::kScanned + 8; ++i) {
    live(crowd.agv({Vec2(floor.within(0.0, 35.0), floor.within(0.0, 35.0)), Vec2::UnitX()}));
  }
  std::vector<Violation> expected;
  std::deque<std::vector<Piece>> pieces;
  for (const Timeline& body : crowd.bodies) pieces.push_back(body.until(crowd.end));
  const auto alone = [&](std::size_t a, std::size_t b) {
    Scenario scenario;
    scenario.agvs.resize(crowd.bodies.size());
    const auto law = find_law("exact")->make(scenario);
    Teller teller(*law, crowd.bodies.size());
    std::vector<std::pair<Piece, bool>> all;  // in the order of announcement: by instant, ends before beginnings
    for (const std::size_t i : {a, b}) {
      for (Piece& piece : pieces[i])
        piece.planned_box = piece.swept_box(piece.end), all.emplace_back(piece, true), all.emplace_back(piece, false);
    }
    std::ranges::stable_sort(all, {},
                             [](const auto& p) { return std::pair(p.second ? p.first.begin : p.first.end, p.second); });
    for (const auto& [piece, begins] : all) begins ? teller.begins(piece) : teller.ends(piece);
    law->finish(crowd.end);
    return law->findings().violations;
  };
  for (std::size_t b = 1; b < pieces.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      for (const Violation& violation : alone(a, b)) expected.push_back(violation);
    }
  }
  std::ranges::sort(expected, {}, [](const Violation& v) { return std::tuple(v.first, v.a, v.b); });
  EXPECT_GT(expected.size(), 20U);
  EXPECT_EQ(play(crowd, "exact").violations, expected);
}

}  // namespace
}  // namespace fleetproof::test::broad_phase_test
