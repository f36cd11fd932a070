// The range that ends softly: its closed form, and that distance only ever adds losses.
#include <gtest/gtest.h>

#include <vector>

#include "core/radio/radio.hpp"
#include "tests/core/small_world.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::radio_range_test {
namespace {

using test::is_binomial;

const AgvId kA{0U}, kB{1U};

// A range of 50 m whose loss grows over the last 20 m.
RadioSetup soft(double loss = 0.0) { return {.loss = loss, .range_m = 50.0, .range_falloff_m = 20.0}; }

LinkPlaces apart(double distance_m) { return {Vec2(3.0, 4.0), Vec2(3.0 + 0.6 * distance_m, 4.0 + 0.8 * distance_m)}; }

// Over independent worlds, one message in each.
std::uint64_t lost(const RadioSetup& setup, double distance_m, std::uint64_t worlds) {
  std::uint64_t count = 0;
  for (std::uint64_t world = 0; world < worlds; ++world)
    count += Radio(setup, world).delivery(kA, kB, at_seconds(12.3), 0, apart(distance_m)).lost ? 1 : 0;
  return count;
}

TEST(RadioRange, TheLossGrowsLinearlyOverTheLastPartOfTheRange) {
  constexpr std::uint64_t kWorlds = 100'000;
  for (const double loss : {0.0, 0.3}) {
    for (const auto& [distance_m, share] : {std::pair{0.0, 0.0}, {29.0, 0.0}, {35.0, 0.25}, {40.0, 0.5}, {49.0, 0.95}})
      EXPECT_TRUE(is_binomial(lost(soft(loss), distance_m, kWorlds), kWorlds, loss + (1.0 - loss) * share))
          << loss << " at " << distance_m;
  }
  EXPECT_EQ(lost(soft(), 50.1, 1000), 1000U);
}

TEST(RadioRange, TheLossIsThatMeanWithOutagesToo) {
  constexpr std::uint64_t kWorlds = 100'000;
  RadioSetup setup = soft(0.3);
  setup.outages = {.mean_outage_s = 2.0};
  EXPECT_TRUE(is_binomial(lost(setup, 10.0, kWorlds), kWorlds, 0.3));
  EXPECT_TRUE(is_binomial(lost(setup, 40.0, kWorlds), kWorlds, 0.3 + 0.7 * 0.5));
}

TEST(RadioRange, AFallOffLongerThanTheRangeIsTheWholeRange) {
  RadioSetup setup = soft();
  setup.range_falloff_m = 1e6;
  EXPECT_EQ(lost(setup, 0.0, 1000), 0U);
  EXPECT_TRUE(is_binomial(lost(setup, 25.0, 100'000), 100'000, 0.5));
}

std::vector<Delivery> deliveries(const RadioSetup& setup, double distance_m) {
  Radio radio(setup, 11);
  std::vector<Delivery> list;
  for (int i = 0; i < 20'000; ++i) list.push_back(radio.delivery(kA, kB, at_ns(i * 1'000'003LL), 0, apart(distance_m)));
  return list;
}

// `more` has lost what `fewer` has, and some beyond; delays and copies are the same.
void expect_adds_losses(const std::vector<Delivery>& fewer, const std::vector<Delivery>& more) {
  int added = 0;
  for (std::size_t i = 0; i < fewer.size(); ++i) {
    EXPECT_TRUE(!fewer[i].lost || more[i].lost) << i;
    EXPECT_EQ(fewer[i].delay, more[i].delay);
    EXPECT_EQ(fewer[i].copy_delay, more[i].copy_delay);
    EXPECT_EQ(fewer[i].in_outage, more[i].in_outage);
    added += more[i].lost && !fewer[i].lost ? 1 : 0;
  }
  EXPECT_GT(added, 500);
}

TEST(RadioRange, DistanceFallOffAndLossOnlyAddLosses) {
  RadioSetup setup = soft(0.2);
  setup.delay_s = 1.0;
  setup.delay_model = RadioSetup::DelayModel::Uniform;
  setup.duplicates = 0.3;
  for (const double outage_s : {0.0, 0.5}) {
    setup.outages.mean_outage_s = outage_s;
    RadioSetup sharp = setup, longer = setup;
    sharp.range_falloff_m = 0.0;
    longer.range_falloff_m = 30.0;
    expect_adds_losses(deliveries(setup, 35.0), deliveries(setup, 45.0));
    expect_adds_losses(deliveries(sharp, 40.0), deliveries(setup, 40.0));
    expect_adds_losses(deliveries(setup, 40.0), deliveries(longer, 40.0));
  }
  setup.outages.mean_outage_s = 0.0;
  RadioSetup harsh = setup;
  harsh.loss = 0.4;
  expect_adds_losses(deliveries(setup, 40.0), deliveries(harsh, 40.0));
}

TEST(RadioRange, TheEngineAsksForThePlacesOnAFloorThatIsSmallerThanTheRange) {
  Scenario scenario = test::row_scenario(6, {0, 5});  // 20 m apart
  scenario.radio = {.range_m = 100.0, .range_falloff_m = 90.0};
  test::SmallWorld world(scenario);
  for (int i = 0; i < 2000; ++i) {
    world.run.now = at_ns(i * 1'000'003LL);
    const auto message = world.parts.messenger.accept(AgvId{0U}, "x", FP_NONE);
    ASSERT_TRUE(message);
    world.parts.messenger.transmit(AgvId{0U}, *message, FP_NONE);
  }
  EXPECT_EQ(world.run.counters.receptions, 2000U);
  EXPECT_TRUE(is_binomial(world.run.counters.receptions_lost, 2000, 10.0 / 90.0));
}

}  // namespace
}  // namespace fleetproof::radio_range_test
