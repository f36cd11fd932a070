// A VDA 5050 fleet in drawn worlds: vehicles, broker and master by streams over a bad radio, while the computers of all
// restart, freeze, lose power and lose their disks: no two AGVs ever come too close, and loads arrive.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "core/bridges/mqtt/mqtt_broker.hpp"
#include "core/bridges/vda5050/vda5050_programs.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/simulation.hpp"
#include "core/scenario/faults.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/worlds/transports.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/core/told_run.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::vda5050_fleet_test {
namespace {

using bridges::vda5050::kMaster;
using bridges::vda5050::kVehicle;

constexpr double kHorizon_s = 300.0;
constexpr std::string_view kFamilies[] = {"aisle-grid/stress",    "corridor-sidings", "loop-spurs/stress",
                                          "random-planar/stress", "fishbone/stress",  "dense-crossing/stress",
                                          "close-pass/stress",    "plant/crossing",   "plant/overhang-pass"};

FleetSoftware fleet() { return {{&kVehicle}, {{&mqtt::kMqttBroker}, {&kMaster}}}; }

Scenario drawn_world(int number, double loss, double delay_s) {
  WorldSpec spec;
  spec.layout = std::string(kFamilies[static_cast<std::size_t>(number) % std::size(kFamilies)]);
  spec.fleet_size = 2 + static_cast<std::uint32_t>(number % 4);
  spec.demand.transports_per_agv_hour = 120.0;
  spec.horizon = seconds(kHorizon_s);
  spec.vehicles.front().type.loaded.extra_length_m = 0.6;
  RejectionCounts counts;
  Scenario scenario = generate_world(spec, 500 + static_cast<std::uint64_t>(number), counts);
  open_transports(scenario);
  scenario.computers = {{.name = "broker"}, {.name = "master"}};
  scenario.radio.loss = loss;
  scenario.radio.delay_s = delay_s;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  scenario.radio.duplicates = 0.1;
  return scenario;
}

// Each participant, broker and master too, has so many faults of its computer.
void add_faults(Scenario& scenario, int each, std::uint64_t seed) {
  std::mt19937_64 draws(seed);
  std::uniform_real_distribution<double> share;
  constexpr Fault::Kind kKinds[] = {Fault::Kind::Restart, Fault::Kind::Freeze, Fault::Kind::PowerFailure,
                                    Fault::Kind::DiskLoss};
  for (std::uint32_t who = 0; who < scenario.agvs.size() + 2; ++who) {
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

std::uint64_t probe(const Outcome& outcome, std::string_view name) {
  const auto found = std::ranges::find(outcome.probes, name, &ProbeCount::name);
  return found == outcome.probes.end() ? 0 : found->count;
}

TEST(Vda5050Fleet, CarriesOutItsTransports) {
  std::uint64_t done = 0, released = 0;
  for (int number = 0; number < 9; ++number) {
    const Scenario scenario = drawn_world(number, 0.02, 0.1);
    const Outcome outcome = simulate(scenario, fleet(), make_default_laws(scenario, {}));
    EXPECT_FALSE(outcome.violation || outcome.contact || outcome.crash) << number << ": " << outcome.message;
    EXPECT_GT(outcome.counters.transports_done, 0U) << number;
    done += outcome.counters.transports_done;
    released += scenario.agvs.size();
  }
  EXPECT_GT(done, 2 * released);
}

// FLEETPROOF_SEEDS: so many worlds, for releases.
TEST(Vda5050Fleet, KeepsItsDistanceWhateverRestarts) {
  const char* wanted = std::getenv("FLEETPROOF_SEEDS");
  const int worlds = wanted != nullptr ? std::atoi(wanted) : 45;
  std::uint64_t done = 0, began_again = 0, recalled = 0;
  for (int number = 0; number < worlds; ++number) {
    Scenario scenario = drawn_world(number, 0.1 * (number % 3), 0.1 + 0.3 * (number % 4));
    add_faults(scenario, 3, static_cast<std::uint64_t>(number));
    const Outcome outcome = simulate(scenario, fleet(), make_default_laws(scenario, {}));
    EXPECT_FALSE(outcome.violation || outcome.contact || outcome.crash || outcome.hang || outcome.engine_error)
        << "world " << number << ": " << outcome.message;
    done += outcome.counters.transports_done;
    began_again += probe(outcome, "vehicle-began-again");
    recalled += probe(outcome, "recalled");
  }
  const auto least = static_cast<std::uint64_t>(worlds);
  EXPECT_GT(done, least) << "or this tests less than it should";
  EXPECT_GT(began_again, least / 2);
  EXPECT_GT(recalled, least / 2);
}

TEST(Vda5050Fleet, RepeatsToTheBit) {
  Scenario scenario = drawn_world(3, 0.2, 0.5);
  add_faults(scenario, 2, 3);
  EXPECT_EQ(simulate(scenario, fleet(), make_default_laws(scenario, {})),
            simulate(scenario, fleet(), make_default_laws(scenario, {})));
}

// Without a connection, a vehicle drives on to the end of its base, and not further.
TEST(Vda5050Fleet, DrivesBlindToTheEndOfItsBase) {
  Scenario scenario = drawn_world(0, 0.0, 0.1);
  Fault gone;
  gone.kind = Fault::Kind::PowerFailure;
  gone.agv = EntityId(static_cast<std::uint32_t>(scenario.agvs.size()));  // the broker
  gone.at = seconds(60.0);
  gone.lasts = seconds(kHorizon_s);
  const auto drives_of = [](const Scenario& world) {
    return simulate(world, fleet(), make_default_laws(world, {})).counters.drives;
  };
  Scenario short_one = scenario;
  short_one.horizon = seconds(60.0);
  const auto before = drives_of(short_one), whole = drives_of(scenario);
  scenario.faults.push_back(gone);
  const auto blind = drives_of(scenario);
  EXPECT_GE(blind, before);
  EXPECT_LT(blind, before + (whole - before) / 4);
}

}  // namespace
}  // namespace fleetproof::vda5050_fleet_test
