// What is drawn of each kind of fault: how many, when, for how long, where. Every law is that which the table of the
// campaign file promises, and no kind moves another one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/poisson.hpp>
#include <cmath>
#include <functional>

#include "generators/worlds/drawn_faults.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::fault_kinds_test {
namespace {

constexpr std::uint64_t kWorlds = 2'000;
constexpr double kHorizon_s = 600.0, kHours = kHorizon_s / 3600.0, kTransports = 3;

// Two AGVs with three transports each, on four lanes from (0, 0) to (8, 0) and back.
Scenario plain_world() {
  Scenario scenario = test::row_scenario(3, {0, 2}, kHorizon_s);
  for (AgvSetup& agv : scenario.agvs) agv.transports.resize(static_cast<std::size_t>(kTransports));
  return scenario;
}

std::vector<Scenario> worlds_with(const FaultRates& rates) {
  std::vector<Scenario> worlds(kWorlds, plain_world());
  for (std::uint64_t key = 0; key < kWorlds; ++key) draw_faults(worlds[key], rates, key);
  return worlds;
}

std::function<double(double)> exponential(double mean) {
  return [=](double p) { return -mean * std::log1p(-p); };
}
std::function<double(double)> uniform(double least, double most) {
  return [=](double p) { return least + p * (most - least); };
}

void expect_poisson(const std::vector<std::uint64_t>& counts, double mean) {
  const boost::math::poisson_distribution<double> law(mean);
  for (std::uint64_t k = 0; k <= static_cast<std::uint64_t>(mean + 3.0 * std::sqrt(mean)); ++k) {
    const auto at_most = static_cast<std::uint64_t>(std::ranges::count_if(counts, [&](auto n) { return n <= k; }));
    EXPECT_TRUE(test::is_binomial(at_most, counts.size(), boost::math::cdf(law, static_cast<double>(k))))
        << "worlds with " << k << " or fewer, of a mean of " << mean;
  }
}

struct Seen {
  std::vector<std::uint64_t> counts;  // of each AGV in each world
  std::vector<double> at_s, lasts_s;
};
Seen of_kind(const std::vector<Scenario>& worlds, Fault::Kind kind, bool within_transport) {
  Seen seen;
  for (const Scenario& world : worlds) {
    for (std::uint32_t agv = 0; agv < world.agvs.size(); ++agv) {
      std::uint64_t count = 0;
      for (const Fault& fault : world.faults) {
        if (fault.kind != kind || fault.agv != AgvId{agv} || fault.transport.has_value() != within_transport) continue;
        ++count;
        seen.at_s.push_back(to_seconds(fault.at));
        seen.lasts_s.push_back(to_seconds(fault.lasts));
      }
      seen.counts.push_back(count);
    }
  }
  return seen;
}

// A Poisson process: given their number, the instants are uniform.
Seen expect_process(const FaultRates& rates, Fault::Kind kind, double per_hour) {
  Seen seen = of_kind(worlds_with(rates), kind, false);
  expect_poisson(seen.counts, per_hour * kHours);
  test::expect_quantiles(seen.at_s, uniform(0.0, kHorizon_s));
  return seen;
}

TEST(FaultKinds, BreakdownsArePoissonAndTheirRepairIsExponential) {
  const auto seen = expect_process({.breakdowns_per_agv_hour = 20.0, .repair_s = 40.0}, Fault::Kind::Breakdown, 20.0);
  test::expect_quantiles(seen.lasts_s, exponential(40.0));
}

TEST(FaultKinds, ProtectiveStopsArePoissonAndUniformlyLong) {
  const auto seen = expect_process(
      {.protective_stops_per_agv_hour = 30.0, .protective_stop_least_s = 3.0, .protective_stop_most_s = 11.0},
      Fault::Kind::ProtectiveStop, 30.0);
  test::expect_quantiles(seen.lasts_s, uniform(3.0, 11.0));
}

TEST(FaultKinds, RestartsArePoissonAndEquallyLong) {
  const auto seen = expect_process({.restarts_per_agv_hour = 25.0, .restart_s = 7.0}, Fault::Kind::Restart, 25.0);
  EXPECT_TRUE(std::ranges::all_of(seen.lasts_s, [](double s) { return s == 7.0; }));
}

TEST(FaultKinds, FreezesArePoissonAndUniformlyLong) {
  const auto seen = expect_process({.freezes_per_agv_hour = 15.0, .freeze_least_s = 0.5, .freeze_most_s = 4.5},
                                   Fault::Kind::Freeze, 15.0);
  test::expect_quantiles(seen.lasts_s, uniform(0.5, 4.5));
}

TEST(FaultKinds, PowerFailuresArePoissonAndExponentiallyLong) {
  const auto seen =
      expect_process({.power_failures_per_agv_hour = 18.0, .power_back_s = 25.0}, Fault::Kind::PowerFailure, 18.0);
  test::expect_quantiles(seen.lasts_s, exponential(25.0));
}

TEST(FaultKinds, DiskLossesArePoissonAndEquallyLong) {
  const auto seen = expect_process({.disk_losses_per_agv_hour = 16.0, .disk_loss_s = 9.0}, Fault::Kind::DiskLoss, 16.0);
  EXPECT_TRUE(std::ranges::all_of(seen.lasts_s, [](double s) { return s == 9.0; }));
}

// Within a minute after the pick, independently for each transport.
void expect_share_of_transports(const Seen& seen, double share, double mean_s) {
  const auto transports = static_cast<std::uint64_t>(kTransports) * seen.counts.size();
  EXPECT_TRUE(test::is_binomial(seen.at_s.size(), transports, share));
  const auto none = static_cast<std::uint64_t>(std::ranges::count(seen.counts, 0U));
  EXPECT_TRUE(test::is_binomial(none, seen.counts.size(), std::pow(1.0 - share, kTransports)));
  test::expect_quantiles(seen.at_s, uniform(0.0, 60.0));
  test::expect_quantiles(seen.lasts_s, exponential(mean_s));
}

TEST(FaultKinds, ATransportBreaksDownWithTheProbabilityAskedFor) {
  const auto worlds = worlds_with({.breakdowns_per_transport = 0.3, .repair_s = 40.0});
  expect_share_of_transports(of_kind(worlds, Fault::Kind::Breakdown, true), 0.3, 40.0);
}

TEST(FaultKinds, ALoadFallsBehindTheAgvWithTheProbabilityAskedFor) {
  const auto worlds = worlds_with({.load_drops_per_transport = 0.2, .load_lies_s = 90.0});
  expect_share_of_transports(of_kind(worlds, Fault::Kind::LoadDrop, true), 0.2, 90.0);
  std::vector<double> left_m;
  for (const Scenario& world : worlds) {
    const double body_m = world.type_of(world.agvs[0]).footprint_with(true).length_m;
    for (const Fault& fault : world.faults) {
      left_m.push_back(fault.left_m);
      EXPECT_NEAR(-fault.ahead_m, 0.5 * (body_m + fault.load.length_m) + 0.2, 1e-12) << "0.2 m behind the AGV";
    }
  }
  test::expect_quantiles(left_m, uniform(-0.8, 0.8));
}

TEST(FaultKinds, ObstaclesArePoissonAnywhereBesideTheLanes) {
  std::vector<std::uint64_t> counts;
  std::vector<double> at_s, stays_s, x_m, y_m;
  std::uint64_t forward = 0;
  for (const Scenario& world : worlds_with({.obstacles_per_hour = 12.0, .obstacle_stays_s = 80.0})) {
    counts.push_back(world.obstacles.size());
    for (const ObstacleSetup& obstacle : world.obstacles) {
      at_s.push_back(to_seconds(obstacle.appears));
      stays_s.push_back(to_seconds(obstacle.leaves - obstacle.appears));
      x_m.push_back(obstacle.pose.position_m.x());
      y_m.push_back(obstacle.pose.position_m.y());
      forward += obstacle.pose.heading.x() > 0.0 ? 1 : 0;
    }
  }
  expect_poisson(counts, 12.0 * kHours);
  test::expect_quantiles(at_s, uniform(0.0, kHorizon_s));
  test::expect_quantiles(stays_s, exponential(80.0));
  test::expect_quantiles(x_m, uniform(0.0, 8.0));
  test::expect_quantiles(y_m, uniform(-1.5, 1.5));
  EXPECT_TRUE(test::is_binomial(forward, x_m.size(), 0.5)) << "half of the lanes lead forward";
}

TEST(FaultKinds, ClocksAndPositionsAreWrongByUpToTheNumbers) {
  std::vector<double> offset_s, drift_ppm;
  for (const Scenario& world : worlds_with(
           {.clock_offset_s = 2.0, .clock_drift_ppm = 300.0, .position_error_m = 0.04, .position_late_s = 0.6})) {
    for (const AgvSetup& agv : world.agvs) {
      offset_s.push_back(agv.sensing.clock_offset_s);
      drift_ppm.push_back(agv.sensing.clock_drift_ppm);
      EXPECT_EQ(agv.sensing.position_error_m, 0.04);
      EXPECT_EQ(agv.sensing.position_late_s, 0.6);
    }
  }
  test::expect_quantiles(offset_s, uniform(0.0, 2.0));
  test::expect_quantiles(drift_ppm, uniform(-300.0, 300.0));
}

TEST(FaultKinds, ABatteryIsLowWithTheProbabilityAskedFor) {
  std::vector<double> low;
  for (const Scenario& world : worlds_with({.low_battery_share = 0.35})) {
    for (const AgvSetup& agv : world.agvs) {
      if (agv.battery < 1.0) low.push_back(agv.battery);
    }
  }
  EXPECT_TRUE(test::is_binomial(low.size(), 2 * kWorlds, 0.35));
  test::expect_quantiles(low, uniform(0.12, 0.20));
}

// As text: what a kind adds to a world.
std::vector<std::string> drawn(const FaultRates& rates, std::uint64_t key) {
  Scenario world = plain_world();
  draw_faults(world, rates, key);
  std::vector<std::string> all;
  for (const Fault& f : world.faults) {
    all.push_back(fmt::format("{} {} {} {} {} {} {}", name_of(f.kind), f.agv.value, f.at.count(),
                              f.transport ? int(*f.transport) : -1, f.lasts.count(), f.ahead_m, f.left_m));
  }
  for (const ObstacleSetup& o : world.obstacles) {
    all.push_back(fmt::format("obstacle {} {} {} {}", o.appears.count(), o.leaves.count(), o.pose.position_m.x(),
                              o.pose.position_m.y()));
  }
  for (const AgvSetup& agv : world.agvs) {
    if (agv.battery != 1.0) all.push_back(fmt::format("battery {} {}", agv.name, agv.battery));
    if (agv.sensing.clock_offset_s != 0.0)
      all.push_back(fmt::format("clock {} {}", agv.name, agv.sensing.clock_offset_s));
  }
  std::ranges::sort(all);
  return all;
}

TEST(FaultKinds, NoKindMovesAnother) {
  const std::vector<FaultRates> kinds = {
      {.breakdowns_per_agv_hour = 20.0}, {.breakdowns_per_transport = 0.3},     {.protective_stops_per_agv_hour = 30.0},
      {.load_drops_per_transport = 0.3}, {.obstacles_per_hour = 12.0},          {.restarts_per_agv_hour = 25.0},
      {.freezes_per_agv_hour = 15.0},    {.power_failures_per_agv_hour = 18.0}, {.clock_offset_s = 1.0},
      {.low_battery_share = 0.5},        {.disk_losses_per_agv_hour = 16.0}};
  const FaultRates all{.breakdowns_per_agv_hour = 20.0,
                       .breakdowns_per_transport = 0.3,
                       .protective_stops_per_agv_hour = 30.0,
                       .load_drops_per_transport = 0.3,
                       .obstacles_per_hour = 12.0,
                       .restarts_per_agv_hour = 25.0,
                       .freezes_per_agv_hour = 15.0,
                       .power_failures_per_agv_hour = 18.0,
                       .clock_offset_s = 1.0,
                       .low_battery_share = 0.5,
                       .disk_losses_per_agv_hour = 16.0};
  for (std::uint64_t key = 0; key < 200; ++key) {
    std::vector<std::string> alone;
    for (const FaultRates& kind : kinds) {
      const auto of_kind = drawn(kind, key);
      alone.insert(alone.end(), of_kind.begin(), of_kind.end());
    }
    std::ranges::sort(alone);
    ASSERT_EQ(drawn(all, key), alone) << "world " << key;
  }
}

}  // namespace
}  // namespace fleetproof::fault_kinds_test
