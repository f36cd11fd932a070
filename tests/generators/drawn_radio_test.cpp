#include "generators/worlds/drawn_radio.hpp"

#include <gtest/gtest.h>

#include "tests/support/exact_binomial.hpp"

namespace fleetproof::drawn_radio_test {
namespace {

Layout hall() {
  Layout layout;
  layout.floor_low_m = {-10.0, 5.0};
  layout.floor_high_m = {30.0, 25.0};
  return layout;
}

TEST(DrawnRadioSources, LieAnywhereOnTheFloor) {
  std::vector<double> x_m, y_m;
  std::uint64_t lower_left = 0;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    for (const RadioSource& source : draw_radio_sources({.count = 3, .like = {}}, hall(), seed)) {
      x_m.push_back(source.x_m);
      y_m.push_back(source.y_m);
      lower_left += source.x_m < 10.0 && source.y_m < 15.0 ? 1 : 0;
    }
  }
  test::expect_quantiles(x_m, [](double p) { return -10.0 + 40.0 * p; });
  test::expect_quantiles(y_m, [](double p) { return 5.0 + 20.0 * p; });
  EXPECT_TRUE(test::is_binomial(lower_left, x_m.size(), 0.25));  // x and y are independent
}

TEST(DrawnRadioSources, AreAlikeAndOneMoreLeavesTheOthersWhereTheyWere) {
  const RadioSource like{.range_m = 7.0, .mean_on_s = 0.5, .mean_off_s = 2.0, .loss = 0.3};
  EXPECT_TRUE(draw_radio_sources({.count = 0, .like = like}, hall(), 4).empty());
  auto two = draw_radio_sources({.count = 2, .like = like}, hall(), 4);
  const auto three = draw_radio_sources({.count = 3, .like = like}, hall(), 4);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_NE(two[0].x_m, two[1].x_m);
  EXPECT_TRUE(std::ranges::equal(two, std::span(three).first(2)));
  for (RadioSource source : three) {
    source.x_m = source.y_m = 0.0;
    EXPECT_EQ(source, like);
  }
}

}  // namespace
}  // namespace fleetproof::drawn_radio_test
