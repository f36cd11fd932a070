// zone-server and follower on floors where AGVs can only pass each other if several of them move out of the way, one
// after the other. Every transport is delivered.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/agents/central/programs.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/simulation.hpp"
#include "core/scenario/scenario.hpp"
#include "laws/laws.hpp"

namespace fleetproof::agents::central::central_progress_test {
namespace {

using Links = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

std::shared_ptr<const LogicalMap> two_way_map(const std::vector<Vec2>& stations_m, const Links& links) {
  Layout layout;
  for (const Vec2& at_m : stations_m) {
    layout.stations.push_back(
        {"s" + std::to_string(layout.stations.size()), at_m, Purposes(Purpose::Storage) | Purpose::Routing});
  }
  for (const auto& [from, to] : links) {
    layout.segments.push_back({"e" + std::to_string(layout.segments.size()), StationId{from}, StationId{to}, true, {}});
  }
  return std::make_shared<const LogicalMap>(layout);
}

std::shared_ptr<const LogicalMap> ring(std::uint32_t stations) {
  const double radius_m = 4.0 * stations / (2.0 * std::numbers::pi);
  std::vector<Vec2> at_m;
  Links links;
  for (std::uint32_t i = 0; i < stations; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / stations;
    at_m.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle));
    links.emplace_back(i, (i + 1) % stations);
  }
  return two_way_map(at_m, links);
}

// A row of stations; the last ones of them stand beside it.
std::shared_ptr<const LogicalMap> row(std::uint32_t stations, const std::vector<std::uint32_t>& sidings_at) {
  std::vector<Vec2> at_m;
  Links links;
  for (std::uint32_t i = 0; i < stations; ++i) at_m.emplace_back(4.0 * i, 0.0);
  for (std::uint32_t i = 0; i + 1 < stations; ++i) links.emplace_back(i, i + 1);
  for (const std::uint32_t beside : sidings_at) {
    links.emplace_back(beside, static_cast<std::uint32_t>(at_m.size()));
    at_m.emplace_back(4.0 * beside, 4.0);
  }
  return two_way_map(at_m, links);
}

std::shared_ptr<const LogicalMap> grid(std::uint32_t side) {
  std::vector<Vec2> at_m;
  Links links;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    at_m.emplace_back(4.0 * (i % side), 4.0 * (i / side));
    if (i % side > 0) links.emplace_back(i - 1, i);
    if (i >= side) links.emplace_back(i - side, i);
  }
  return two_way_map(at_m, links);
}

struct World {
  std::string name;
  std::shared_ptr<const LogicalMap> map;
  std::uint32_t agvs = 2, transports = 12;
};

// Each AGV begins at a station of its own, and each transport joins two others; open orders, or of the AGVs in turn.
Scenario scenario_of(const World& world, bool open, std::uint64_t seed) {
  Scenario scenario;
  scenario.name = world.name;
  scenario.map = world.map;
  scenario.seed = seed;
  scenario.horizon = seconds(1200.0);
  scenario.computers.push_back({.name = "server"});
  std::mt19937_64 draws(seed);
  std::vector<StationId> stations;
  for (std::uint32_t i = 0; i < world.map->station_count(); ++i) stations.emplace_back(i);
  for (std::uint32_t i = 0; i < world.agvs; ++i) {
    std::swap(stations[i], stations[i + draws() % (stations.size() - i)]);
    AgvSetup agv;
    agv.name = "AGV " + std::to_string(i);
    agv.start = stations[i];
    scenario.agvs.push_back(agv);
  }
  for (std::uint32_t i = 0; i < world.transports; ++i) {
    const std::size_t from = draws() % stations.size();
    const std::size_t to = (from + 1 + draws() % (stations.size() - 1)) % stations.size();
    const TransportOrder order{stations[from], stations[to], seconds(1.0 + i)};
    (open ? scenario.open_orders : scenario.agvs[i % world.agvs].transports).push_back(order);
  }
  return scenario;
}

struct Radio {
  double loss = 0.0, delay_s = 0.0;
};

void expect_all_delivered(const World& world, std::uint64_t seed) {
  for (const Radio& radio : {Radio{}, Radio{0.4, 2.0}}) {
    for (const bool open : {true, false}) {
      Scenario scenario = scenario_of(world, open, seed);
      scenario.radio.loss = radio.loss;
      scenario.radio.delay_s = radio.delay_s;
      const auto laws = make_default_laws(scenario, {});
      const Outcome outcome = simulate(scenario, FleetSoftware({&kFollower}, {{&kZoneServer}}), laws);
      EXPECT_EQ(outcome.counters.transports_done, world.transports)
          << world.name << ", seed " << seed << (open ? ", open orders" : "") << ", loss " << radio.loss;
      EXPECT_FALSE(outcome.violation || outcome.contact || outcome.crash || outcome.engine_error) << world.name;
    }
  }
}

void expect_all_delivered(const World& world) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) expect_all_delivered(world, seed);
}

TEST(CentralProgress, OnRings) {
  for (const std::uint32_t stations : {8U, 12U, 20U}) {
    for (std::uint32_t agvs = 2; agvs <= 5; ++agvs) {
      const std::string name = "ring of " + std::to_string(stations) + " with " + std::to_string(agvs) + " AGVs";
      expect_all_delivered({name, ring(stations), agvs}, agvs);
    }
  }
}

TEST(CentralProgress, OnARowWithOneSiding) { expect_all_delivered({"row", row(5, {2}), 2}); }

TEST(CentralProgress, InADeadEnd) {
  // Behind station 2, a row of three stations; before it, a square.
  expect_all_delivered({"dead end",
                        two_way_map({{0.0, 0.0}, {0.0, 4.0}, {4.0, 4.0}, {4.0, 0.0}, {8.0, 4.0}, {12.0, 4.0}},
                                    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 4}, {4, 5}}),
                        2});
}

TEST(CentralProgress, OnACrowdedGrid) {
  for (const std::uint32_t agvs : {4U, 6U})
    expect_all_delivered({"grid with " + std::to_string(agvs) + " AGVs", grid(3), agvs, 16});
}

}  // namespace
}  // namespace fleetproof::agents::central::central_progress_test
