#include "core/engine/company.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::company_test {
namespace {

constexpr double kWithin_m = 0.5;

Piece standing(std::uint32_t body, double x_m, double y_m) {
  Piece piece = rest_piece(EntityId{body}, {}, {Vec2(x_m, y_m), Vec2::UnitX()}, kStart);
  piece.planned_box = piece.swept_box(piece.end);
  return piece;
}

std::vector<std::uint32_t> near(const Company& company, std::uint32_t body) {
  const auto found = company.near(EntityId{body});
  return {found.begin(), found.end()};
}

using Bodies = std::vector<std::uint32_t>;

TEST(Company, LastsUntilOneOfTheTwoPiecesIsOver) {
  const double beside_m = Footprint{}.width_m + kWithin_m;
  const Piece low = standing(0, 0.0, 0.0), middle = standing(1, 0.0, beside_m), high = standing(2, 0.0, 2.0 * beside_m),
              away = standing(1, 100.0, 0.0);
  Company company(3, kWithin_m);
  company.begins(high);
  company.begins(middle);
  EXPECT_EQ(near(company, 2), Bodies{1}) << "it began before";
  company.begins(low);
  EXPECT_EQ(near(company, 0), Bodies{1});
  EXPECT_EQ(near(company, 1), (Bodies{0, 2})) << "in ascending order, whichever came first";
  const auto pieces = company.pieces_near(EntityId{1U});
  EXPECT_EQ(std::vector(pieces.begin(), pieces.end()), (std::vector{&low, &high}));
  company.begins(away);
  EXPECT_EQ(near(company, 0), Bodies{});
  EXPECT_EQ(near(company, 1), Bodies{});
  company.begins(middle);
  company.leaves(EntityId{0U});
  EXPECT_EQ(near(company, 1), Bodies{2});
  EXPECT_EQ(near(company, 0), Bodies{});
}

// Few bodies, which are scanned, and many.
TEST(Company, IsWhatEveryPairSaysOnItsOwn) {
  Draws draws(3);
  std::size_t found = 0;
  for (const std::uint32_t bodies : {6U, 100U}) {
    const double side_m = 3.0 * bodies / 6.0;
    Company company(bodies, kWithin_m);
    std::vector<Piece> pieces(bodies);
    std::vector<bool> there(bodies);
    for (int step = 0; step < 500; ++step) {
      const auto body = static_cast<std::uint32_t>(draws.below(bodies));
      const bool was_there = there[body];
      there[body] = draws.below(4) != 0;
      if (!there[body]) {
        company.leaves(EntityId{body});
        continue;
      }
      // Then it is somewhere else, or within the box of its last piece.
      const Box last = pieces[body].planned_box;
      pieces[body] = standing(body, draws.uniform(0.0, side_m), draws.uniform(0.0, side_m));
      const double wide_m = draws.uniform(0.0, 4.0);
      pieces[body].planned_box = pieces[body].planned_box.grown(wide_m);
      if (draws.below(2) == 0 && was_there) pieces[body].planned_box = last.grown(-draws.uniform(0.0, 0.4));
      company.begins(pieces[body]);
      for (std::uint32_t one = 0; one < bodies; ++one) {
        Bodies expected;
        for (std::uint32_t other = 0; other < bodies; ++other) {
          if (one != other && there[one] && there[other] &&
              pieces[one].planned_box.grown(kWithin_m).overlaps(pieces[other].planned_box))
            expected.push_back(other);
        }
        ASSERT_EQ(near(company, one), expected) << step;
        found += expected.size();
      }
    }
  }
  EXPECT_GT(found, 1000U);
}

}  // namespace
}  // namespace fleetproof::company_test
