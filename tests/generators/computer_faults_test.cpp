// What is drawn of the faults of computers: how many, when, which, for how long, and from which keys.
#include "generators/worlds/computer_faults.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "generators/worlds/drawn_faults.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::computer_faults_test {
namespace {

constexpr std::uint64_t kWorlds = 1'000;
constexpr double kHorizon_s = 3600.0;

ComputerFaultRates all_kinds() {
  ComputerFaultRates rates;
  rates.restarts_per_hour = 5.0;
  rates.restart_s = 7.0;
  rates.power_failures_per_hour = 4.0;
  rates.power_back_s = 20.0;
  rates.freezes_per_hour = 6.0;
  rates.freeze_least_s = 1.0, rates.freeze_most_s = 3.0;
  rates.disk_losses_per_hour = 3.0;
  rates.disk_loss_s = 9.0;
  rates.named = {{"cut", 8.0, 0, 3, 1.0, 2.0}, {"drop", 2.0, 5, 5, 0.0, 0.0}};
  return rates;
}

// With faults of the computer at `place` of these.
Scenario world(const ComputerFaultRates& rates, std::uint64_t key, std::size_t agvs = 2, std::uint32_t place = 0) {
  Scenario scenario = test::row_scenario(12, {}, kHorizon_s);
  for (std::size_t i = 0; i < agvs; ++i) scenario.agvs.emplace_back().name = fmt::format("AGV {}", i);
  scenario.computers.push_back({.name = "server"});
  if (place != 0) scenario.computers[0].draws_as = place;
  draw_computer_faults(scenario, scenario.first_computer(), rates, key);
  return scenario;
}

std::vector<std::string> drawn(const Scenario& scenario) {
  std::vector<std::string> all;
  for (const Fault& f : scenario.faults)
    all.push_back(fmt::format("{} at {} for {}", text_of(f), f.at.count(), f.lasts.count()));
  return all;
}

TEST(ComputerFaults, StrikeAsOftenAndAsLongAsTheirRatesSay) {
  std::map<std::string, std::vector<double>> lasts_s;  // by kind, or word
  std::map<std::uint32_t, std::uint64_t> cuts;         // by number
  for (std::uint64_t key = 0; key < kWorlds; ++key) {
    const Scenario scenario = world(all_kinds(), key);
    for (const Fault& fault : scenario.faults) {
      EXPECT_EQ(fault.agv, scenario.first_computer());
      EXPECT_LT(fault.at, scenario.horizon);
      lasts_s[fault.kind == Fault::Kind::Named ? fault.word : name_of(fault.kind)].push_back(to_seconds(fault.lasts));
      if (fault.word == "cut") ++cuts[fault.number];
      EXPECT_TRUE(fault.word != "drop" || fault.number == 5U);
    }
  }
  EXPECT_EQ(lasts_s.size(), 6U);
  for (const auto& [what, per_hour, least_s, most_s] :
       std::vector<std::tuple<std::string, double, double, double>>{{"restart", 5.0, 7.0, 7.0},
                                                                    {"power-failure", 4.0, 0.0, 1e9},
                                                                    {"freeze", 6.0, 1.0, 3.0},
                                                                    {"disk-loss", 3.0, 9.0, 9.0},
                                                                    {"cut", 8.0, 1.0, 2.0},
                                                                    {"drop", 2.0, 0.0, 0.0}}) {
    const double expected = per_hour * kWorlds, count = static_cast<double>(lasts_s[what].size());
    EXPECT_NEAR(count, expected, 5.0 * std::sqrt(expected)) << what;
    EXPECT_GE(*std::ranges::min_element(lasts_s[what]), least_s) << what;
    EXPECT_LE(*std::ranges::max_element(lasts_s[what]), most_s) << what;
  }
  EXPECT_EQ(cuts.size(), 4U) << "numbers from 0 to 3";
  const auto all_cuts = lasts_s["cut"].size();
  for (const auto& [number, count] : cuts) EXPECT_TRUE(test::is_binomial(count, all_cuts, 0.25)) << number;
}

TEST(ComputerFaults, DependOnNoOtherParticipant) {
  for (std::uint64_t key = 0; key < 50; ++key) {
    const auto small = drawn(world(all_kinds(), key, 1)), large = drawn(world(all_kinds(), key, 9));
    EXPECT_EQ(small, large) << "the size of the fleet";
    EXPECT_NE(small, drawn(world(all_kinds(), key, 1, 1))) << "another computer has other ones";
  }
  Scenario fleet = test::row_scenario(3, {0, 2}, kHorizon_s);
  draw_faults(fleet, {.restarts_per_agv_hour = 20.0}, 7);
  Scenario both = fleet;
  both.computers.push_back({.name = "server"});
  draw_computer_faults(both, both.first_computer(), all_kinds(), 7);
  ASSERT_GT(both.faults.size(), fleet.faults.size());
  for (std::size_t i = 0; i < fleet.faults.size(); ++i) EXPECT_EQ(both.faults[i].at, fleet.faults[i].at);
}

TEST(ComputerFaults, OfOneKindDoNotMoveThoseOfAnother) {
  ComputerFaultRates restarts, cuts, drops;
  const ComputerFaultRates all = all_kinds();
  restarts.restarts_per_hour = all.restarts_per_hour, restarts.restart_s = all.restart_s;
  cuts.named = {all.named[0]};
  drops.named = {{"none", 0.0, 0, 0, 0.0, 0.0}, all.named[1]};
  const auto together = drawn(world(all, 3));
  for (const ComputerFaultRates& one : {restarts, cuts, drops}) {
    const auto alone = drawn(world(one, 3));
    EXPECT_FALSE(alone.empty());
    for (const std::string& fault : alone) EXPECT_THAT(together, testing::Contains(fault));
  }
}

TEST(ComputerFaults, RatesInAnotherOrderAreRefused) {
  const auto keys = [](const auto& rates) {
    std::vector<std::string> found;
    for (const FieldFault& fault : rule_faults(rates)) found.push_back(fault.key);
    return found;
  };
  EXPECT_THAT(keys(all_kinds()), testing::IsEmpty());
  ComputerFaultRates freezes;
  freezes.freeze_least_s = 6.0;
  EXPECT_THAT(keys(freezes), testing::ElementsAre("freeze_most_s"));
  freezes.named.resize(kMostNamedFaults + 1);
  EXPECT_THAT(keys(freezes), testing::ElementsAre("freeze_most_s", "named"));
  ComputerFaultRates twice = all_kinds();
  twice.named.push_back(twice.named.front());
  EXPECT_THAT(keys(twice), testing::ElementsAre("named")) << "one word, two rates";
  EXPECT_THAT(keys(NamedFaultRate{"cut", 1.0, 2, 1, 4.0, 3.0}), testing::ElementsAre("number_most", "most_s"));
  EXPECT_THAT(keys(NamedFaultRate{"", 1.0, 0, 0, 0.0, 0.0}), testing::ElementsAre("word"));
}

}  // namespace
}  // namespace fleetproof::computer_faults_test
