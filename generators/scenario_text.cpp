#include <fmt/format.h>
#include <xxhash.h>

#include <span>

#include "core/error.hpp"
#include "generators/json_writer.hpp"
#include "generators/layout_file.hpp"
#include "generators/purpose_words.hpp"
#include "generators/scenario_file.hpp"
#include "generators/scenario_keys.hpp"

// The writer takes every struct apart with structured bindings: a field that is added to the scenario does not compile here until it
// is written, so none can be missing from files and digests.
namespace fleetproof {
namespace {

namespace keys = scenario_keys;
constexpr auto kLine = JsonWriter::Style::Line;

class ScenarioWriter {
 public:
  explicit ScenarioWriter(const Scenario& scenario) : scenario_(scenario) {}

  std::string write() {
    const auto& [name, map, vehicle_types, agvs, obstacles, radio, agent_clock, law, contact_stops, horizon, stuck_after, seed] = scenario_;
    ensure(map != nullptr, "a scenario has a map");
    json_.open_object();
    json_.key("version").value(keys::kVersion);
    json_.key("name").value(name);
    json_.key("seed").value(fmt::format("0x{:016x}", seed));  // as text: many JSON readers keep 53 bits only
    json_.key("horizon_ns").value(horizon.count());
    json_.key("stuck_after_ns").value(stuck_after.count());
    json_.key("contact_stops").value(contact_stops);
    write_radio(radio);
    const auto& [call_cost_s] = agent_clock;
    json_.key("agent_clock").open_object(kLine);
    json_.key("call_cost_s").value(call_cost_s);
    json_.close();
    const auto& [safety_distance_m, snapshot_s, reaction_s, min_transports_per_agv_hour, exempt_purposes, exempt_radius_m] = law;
    json_.key("law").open_object(kLine);
    json_.key("safety_distance_m").value(safety_distance_m);
    json_.key("snapshot_s").value(snapshot_s);
    json_.key("reaction_s").value(reaction_s);
    json_.key("min_transports_per_agv_hour").value(min_transports_per_agv_hour);
    json_.key("exempt_purposes").value(purposes_text(exempt_purposes));
    json_.key("exempt_radius_m").value(exempt_radius_m);
    json_.close();
    json_.key("vehicle_types").open_array();
    for (const auto& vehicle : vehicle_types) write_vehicle(vehicle);
    json_.close();
    json_.key("agvs").open_array();
    for (const auto& agv : agvs) write_agv(agv);
    json_.close();
    json_.key("obstacles").open_array();
    for (const auto& obstacle : obstacles) write_obstacle(obstacle);
    json_.close();
    json_.key("layout");
    write_layout(json_, map->layout());
    json_.close();
    return json_.take();
  }

 private:
  void write_radio(const RadioSetup& radio) {
    const auto& [loss, delay_s, delay_model, range_m, air_time_s] = radio;
    json_.key("radio").open_object(kLine);
    json_.key("loss").value(loss);
    json_.key("delay_s").value(delay_s);
    json_.key("delay_model").value(keys::kDelayModels[static_cast<std::size_t>(delay_model)]);
    json_.key("range_m").value(range_m);
    json_.key("air_time_s").value(air_time_s);
    json_.close();
  }

  void write_limits(std::string_view key, const MotionLimits& limits, std::span<const std::string_view> names) {
    const auto& [speed, acceleration, deceleration] = limits;
    json_.key(key).open_object(kLine);
    json_.key(names[0]).value(speed);
    json_.key(names[1]).value(acceleration);
    json_.key(names[2]).value(deceleration);
    json_.close();
  }

  void write_footprint(const Footprint& footprint) {
    const auto& [length_m, width_m] = footprint;
    json_.key("length_m").value(length_m);
    json_.key("width_m").value(width_m);
  }

  void write_vehicle(const VehicleType& vehicle) {
    const auto& [name, footprint, drive, turn, battery_per_m, charge_per_s, pick_s, drop_s] = vehicle;
    json_.open_object();
    json_.key("name").value(name);
    write_footprint(footprint);
    write_limits("drive", drive, keys::kDriveLimits);
    write_limits("turn", turn, keys::kTurnLimits);
    json_.key("battery_per_m").value(battery_per_m);
    json_.key("charge_per_s").value(charge_per_s);
    json_.key("pick_s").value(pick_s);
    json_.key("drop_s").value(drop_s);
    json_.close();
  }

  void write_agv(const AgvSetup& agv) {
    const auto& [name, type, start, heading, battery, transports, script] = agv;
    json_.open_object();
    json_.key("name").value(name);
    json_.key("type").value(scenario_.vehicle_types.at(type).name);
    json_.key("start").value(station(start));
    json_.key("heading").value(heading);
    json_.key("battery").value(battery);
    json_.key("transports").open_array();
    for (const auto& [from, to, release] : transports) {
      json_.open_object(kLine);
      json_.key("from").value(station(from));
      json_.key("to").value(station(to));
      json_.key("release_ns").value(release.count());
      json_.close();
    }
    json_.close();
    json_.key("script").open_array();
    for (const auto& [at, action, segment] : script) {
      json_.open_object(kLine);
      json_.key("at_ns").value(at.count());
      json_.key("action").value(keys::kActions[static_cast<std::size_t>(action)]);
      json_.key("segment").value(scenario_.map->layout().segments.at(segment.index()).name);
      json_.close();
    }
    json_.close();
    json_.close();
  }

  void write_obstacle(const ObstacleSetup& obstacle) {
    const auto& [name, footprint, pose] = obstacle;
    json_.open_object(kLine);
    json_.key("name").value(name);
    write_footprint(footprint);
    json_.key("position_m").value(pose.position_m);
    json_.key("heading").value(pose.heading);
    json_.close();
  }

  std::string_view station(StationId id) const { return scenario_.map->layout().stations.at(id.index()).name; }

  const Scenario& scenario_;
  JsonWriter json_;
};

}  // namespace

std::string to_text(const Scenario& scenario) { return ScenarioWriter(scenario).write(); }

std::uint64_t scenario_digest(const Scenario& scenario) {
  const auto text = to_text(scenario);
  return XXH3_64bits(text.data(), text.size());
}

}  // namespace fleetproof
