#include "core/engine/hearers.hpp"

#include <utility>
#include <vector>

#include "tests/core/small_world.hpp"

namespace fleetproof::hearers_test {
namespace {

using test::kFirst;
using test::kSecond;
using test::SmallWorld;

const AgvId kThird{2U};

using Heard = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // receiver and number

Heard heard_of(Hearers& hearers, std::uint32_t ordinal, std::uint32_t receiver = FP_NONE) {
  Heard heard;
  hearers.begin(kSecond, ordinal);
  for (const auto& [agv, number] : hearers.of(kSecond, receiver, Vec2::Zero())) heard.emplace_back(agv.value, number);
  return heard;
}

Scenario three_with_range(double range_m) {
  Scenario scenario = test::row_of_tens({0, 1, 2});
  scenario.radio.range_m = range_m;
  return scenario;
}

TEST(Hearers, NumbersCountTheMessagesToAReceiverAtOneInstant) {
  SmallWorld world(three_with_range(1000.0));
  Hearers hearers(world.run);
  EXPECT_TRUE(hearers.are_everybody());
  EXPECT_EQ(heard_of(hearers, 0), (Heard{{0, 0}, {2, 0}}));
  EXPECT_EQ(heard_of(hearers, 1, kThird.value), (Heard{{2, 1}}));
  EXPECT_EQ(heard_of(hearers, 2), (Heard{{0, 1}, {2, 2}}));
  EXPECT_EQ(heard_of(hearers, 3, kFirst.value), (Heard{{0, 2}}));
  EXPECT_EQ(heard_of(hearers, 0), (Heard{{0, 0}, {2, 0}})) << "another instant";
}

TEST(Hearers, AllHearAlikeUntilOneHearsMore) {
  SmallWorld world(three_with_range(1000.0));
  Hearers hearers(world.run);
  hearers.begin(kSecond, 0);
  EXPECT_TRUE(hearers.hear_alike(kSecond));
  EXPECT_EQ(hearers.next_number(kSecond), 0U);
  EXPECT_EQ(hearers.next_number(kSecond), 1U);
  EXPECT_EQ(heard_of(hearers, 2, kThird.value), (Heard{{2, 2}})) << "after the two messages to all";
  EXPECT_FALSE(hearers.hear_alike(kSecond));
  EXPECT_TRUE(hearers.hear_alike(kFirst)) << "who sends by itself counts by itself";
  EXPECT_EQ(heard_of(hearers, 3), (Heard{{0, 2}, {2, 3}}));
  hearers.begin(kSecond, 0);
  EXPECT_TRUE(hearers.hear_alike(kSecond)) << "another instant";
}

TEST(Hearers, OnlyThoseInRangeHear) {
  SmallWorld world(three_with_range(15.0));
  Hearers hearers(world.run);
  EXPECT_FALSE(hearers.are_everybody());
  EXPECT_EQ(heard_of(hearers, 0), (Heard{{0, 0}})) << "from the place of the first";
  EXPECT_EQ(heard_of(hearers, 1, kThird.value), Heard{});
  EXPECT_EQ(world.run.counters.out_of_range, 2U);
  EXPECT_EQ(heard_of(hearers, 2, kFirst.value), (Heard{{0, 1}})) << "after the message to all";
  EXPECT_EQ(heard_of(hearers, 3), (Heard{{0, 2}}));
}

TEST(Hearers, WhoMayBeAnywhereIsInRangeWhereItIsNow) {
  SmallWorld world(three_with_range(15.0));
  Hearers hearers(world.run);
  hearers.forget_path(kThird);
  const auto heard_at = [&](const Vec2& from_m) {
    const auto heard = hearers.in_range(kSecond, from_m);
    return std::vector<std::uint32_t>(heard.begin(), heard.end());
  };
  EXPECT_EQ(heard_at({0.0, 0.0}), (std::vector{0U}));
  EXPECT_EQ(heard_at({10.0, 0.0}), (std::vector{0U, 2U}));
  EXPECT_EQ(heard_at({20.0, 0.0}), (std::vector{2U}));
  EXPECT_EQ(world.run.counters.out_of_range, 2U);
}

}  // namespace
}  // namespace fleetproof::hearers_test
