// zone-server and follower in drawn worlds, with a bad radio, when the computers of both restart, freeze, lose power
// and lose their disks at any moment: no two AGVs ever come too close, and loads arrive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <string_view>

#include "core/agents/central/programs.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/simulation.hpp"
#include "core/scenario/faults.hpp"
#include "core/scenario/scenario.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::agents::central::central_fleet_test {
namespace {

constexpr double kHorizon_s = 240.0;
constexpr std::string_view kFamilies[] = {"aisle-grid/stress",    "corridor-sidings", "loop-spurs/stress",
                                          "random-planar/stress", "fishbone/stress",  "dense-crossing/stress",
                                          "close-pass/stress",    "plant/crossing",   "plant/overhang-pass"};

Scenario drawn_world(int number) {
  WorldSpec spec;
  spec.layout = std::string(kFamilies[static_cast<std::size_t>(number) % std::size(kFamilies)]);
  spec.fleet_size = 2 + static_cast<std::uint32_t>(number % 5);
  spec.demand.transports_per_agv_hour = 120.0;
  spec.horizon = seconds(kHorizon_s);
  spec.vehicles.front().type.loaded.extra_length_m = 0.6;
  spec.vehicles.front().type.loaded.extra_width_m = 0.3;
  RejectionCounts counts;
  Scenario scenario = generate_world(spec, 100 + static_cast<std::uint64_t>(number), counts);
  scenario.computers.push_back({.name = "server"});
  scenario.radio.loss = 0.3 * (number % 3);
  scenario.radio.delay_s = number % 4;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  scenario.radio.duplicates = 0.3;
  return scenario;
}

// Each participant, the server too, has so many faults of its computer.
void add_faults(Scenario& scenario, int each, std::uint64_t seed) {
  std::mt19937_64 draws(seed);
  std::uniform_real_distribution<double> share;
  constexpr Fault::Kind kKinds[] = {Fault::Kind::Restart, Fault::Kind::Freeze, Fault::Kind::PowerFailure,
                                    Fault::Kind::DiskLoss};
  for (std::uint32_t who = 0; who <= scenario.agvs.size(); ++who) {
    for (int i = 0; i < each; ++i) {
      Fault fault;
      fault.kind = kKinds[draws() % std::size(kKinds)];
      fault.agv = EntityId(who);
      fault.at = seconds((i + share(draws)) * kHorizon_s / each);
      fault.lasts = seconds(0.1 + 6.0 * share(draws));
      scenario.faults.push_back(fault);
    }
  }
}

struct Sums {
  std::uint64_t runs = 0, unsafe = 0, broken = 0, drops = 0, lost_books = 0, recalled = 0, restarts = 0, fenced = 0;
};

std::uint64_t probe(const Outcome& outcome, std::string_view name) {
  const auto found = std::ranges::find(outcome.probes, name, &ProbeCount::name);
  return found == outcome.probes.end() ? 0 : found->count;
}

Sums simulate_drawn_worlds(int first, int count, int faults_each) {
  Sums sums;
  for (int number = first; number < first + count; ++number) {
    Scenario scenario = drawn_world(number);
    add_faults(scenario, faults_each, static_cast<std::uint64_t>(number));
    const auto laws = make_default_laws(scenario, {});
    const Outcome outcome = simulate(scenario, FleetSoftware({&kFollower}, {{&kZoneServer}}), laws);
    ++sums.runs;
    sums.unsafe += outcome.violation || outcome.contact ? 1 : 0;
    sums.broken += outcome.crash || outcome.hang || outcome.engine_error ? 1 : 0;
    sums.drops += outcome.counters.transports_done;
    sums.lost_books += probe(outcome, "server-restarted");
    sums.recalled += probe(outcome, "recalled");
    sums.restarts += probe(outcome, "restarted");
    sums.fenced += probe(outcome, "grant-of-another-way");
    EXPECT_FALSE(outcome.violation || outcome.contact || outcome.crash || outcome.engine_error)
        << "world " << number << ": " << outcome.message;
  }
  return sums;
}

// FLEETPROOF_SEEDS: so many worlds, for releases.
TEST(CentralFleet, KeepsItsDistanceWhateverRestarts) {
  const char* wanted = std::getenv("FLEETPROOF_SEEDS");
  const Sums sums = simulate_drawn_worlds(0, wanted != nullptr ? std::atoi(wanted) : 90, 4);
  EXPECT_EQ(sums.unsafe, 0U);
  EXPECT_EQ(sums.broken, 0U);
  EXPECT_GT(sums.drops, sums.runs) << "or this tests less than it should";
  EXPECT_GT(sums.restarts, 5 * sums.runs);
  EXPECT_GT(sums.lost_books, sums.runs);
  EXPECT_GT(sums.recalled, sums.runs);
  EXPECT_GT(sums.fenced, sums.runs);
}

// One AGV of four is broken down from the beginning, and the server starts again each minute.
std::uint64_t drops_beside_a_failed_one(std::optional<Fault::Kind> of_server) {
  std::uint64_t drops = 0;
  for (int number = 12; number < 300; number += 15) {  // four AGVs each
    Scenario scenario = drawn_world(number);
    Fault fault;
    fault.kind = Fault::Kind::Breakdown;
    fault.agv = EntityId(std::uint32_t{0});
    fault.at = seconds(20.0);
    fault.lasts = seconds(kHorizon_s);
    scenario.faults.push_back(fault);
    for (int minute = 0; of_server && minute < 4; ++minute) {
      fault.kind = *of_server;
      fault.agv = EntityId(static_cast<std::uint32_t>(scenario.agvs.size()));
      fault.at = seconds(10.0 + 60.0 * minute);
      fault.lasts = seconds(2.0);
      scenario.faults.push_back(fault);
    }
    const auto laws = make_default_laws(scenario, {});
    const Outcome outcome = simulate(scenario, FleetSoftware({&kFollower}, {{&kZoneServer}}), laws);
    EXPECT_FALSE(outcome.violation || outcome.contact) << "world " << number;
    drops += outcome.counters.transports_done;
  }
  return drops;
}

TEST(CentralFleet, GoesOnBesideABrokenDownAgvWhenItsServerRestarts) {
  const std::uint64_t undisturbed = drops_beside_a_failed_one(std::nullopt);
  const std::uint64_t with_disk = drops_beside_a_failed_one(Fault::Kind::Restart);
  const std::uint64_t without_disk = drops_beside_a_failed_one(Fault::Kind::DiskLoss);
  EXPECT_GT(undisturbed, 15U);
  EXPECT_GT(10 * with_disk, 8 * undisturbed) << with_disk << " of " << undisturbed;
  EXPECT_LT(10 * without_disk, 8 * with_disk) << "or this tests less than it should";
}

TEST(CentralFleet, DeliversWithoutFaults) {
  const Sums sums = simulate_drawn_worlds(1000, 45, 0);
  EXPECT_EQ(sums.unsafe, 0U);
  EXPECT_GT(sums.drops, 3 * sums.runs);
}

}  // namespace
}  // namespace fleetproof::agents::central::central_fleet_test
