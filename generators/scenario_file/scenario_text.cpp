#include <fmt/format.h>
#include <xxhash.h>

#include <span>
#include <type_traits>

#include "core/base/error.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/radio_fields.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_keys.hpp"
#include "generators/text/json_writer.hpp"

// The writer takes every struct apart with structured bindings: a field that is added to the scenario does not compile
// here until it is written, so none can be missing from files and digests.
namespace fleetproof {
namespace {

namespace keys = scenario_keys;
constexpr auto kLine = JsonWriter::Style::Line;

class ScenarioWriter {
 public:
  explicit ScenarioWriter(const Scenario& scenario) : scenario_(scenario) {}

  std::string write() {
    const auto& [name, map, vehicle_types, agvs, obstacles, faults, scanner, operator_help, radio, agent_clock, law,
                 contact_stops, horizon, stuck_after, seed, stream_seeds] = scenario_;
    ensure(map != nullptr, "a scenario has a map");
    json_.open_object();
    json_.key("version").value(keys::kVersion);
    json_.key("name").value(name);
    json_.key("seed").value(seed_text(seed));
    write_stream_seeds(stream_seeds);
    json_.key("horizon_ns").value(horizon.count());
    json_.key("stuck_after_ns").value(stuck_after.count());
    json_.key("contact_stops").value(contact_stops);
    write_radio(radio);
    const auto& [call_cost_s] = agent_clock;
    json_.key("agent_clock").open_object(kLine);
    json_.key("call_cost_s").value(call_cost_s);
    json_.close();
    const auto& [safety_distance_m, snapshot_s, reaction_s, min_transports_per_agv_hour, exempt_purposes,
                 exempt_radius_m, exempt_pairs] = law;
    json_.key("law").open_object(kLine);
    json_.key("safety_distance_m").value(safety_distance_m);
    json_.key("snapshot_s").value(snapshot_s);
    json_.key("reaction_s").value(reaction_s);
    json_.key("min_transports_per_agv_hour").value(min_transports_per_agv_hour);
    json_.key("exempt_purposes").value(purposes_text(exempt_purposes));
    json_.key("exempt_radius_m").value(exempt_radius_m);
    write_exempt_pairs(exempt_pairs);
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
    write_faults(faults);
    write_helpers(scanner, operator_help);
    json_.key("layout");
    write_layout(json_, map->layout());
    json_.close();
    return json_.take();
  }

 private:
  // As text: many JSON readers keep 53 bits only.
  static std::string seed_text(std::uint64_t seed) { return fmt::format("0x{:016x}", seed); }

  void write_exempt_pairs(const std::vector<ExemptPair>& pairs) {
    if (pairs.empty()) return;
    json_.key("exempt_pairs").open_array(kLine);
    for (const auto& [one, other] : pairs) {
      json_.open_array(kLine);
      json_.value(one);
      json_.value(other);
      json_.close();
    }
    json_.close();
  }

  void write_stream_seeds(const std::vector<StreamSeed>& stream_seeds) {
    if (stream_seeds.empty()) return;
    json_.key("stream_seeds").open_object(kLine);
    for (const auto& [stream, seed] : stream_seeds) json_.key(name_of(stream)).value(seed_text(seed));
    json_.close();
  }

  void write_radio(const RadioSetup& radio) {
    json_.key("radio").open_object();
    for_each_radio_field(radio, [&](const RadioField& field, const auto& value) {
      using Value = std::remove_cvref_t<decltype(value)>;
      json_.key(field.key);
      if constexpr (std::is_enum_v<Value>) {
        json_.value(field.words[static_cast<std::size_t>(value)]);
      } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
        json_.value(std::uint64_t{value});
      } else {
        json_.value(value);
      }
    });
    if (!radio.sources.empty()) write_sources(radio.sources);
    if (radio.trace != nullptr) write_trace(*radio.trace);
    json_.close();
  }

  void write_sources(const std::vector<RadioSource>& sources) {
    json_.key("sources").open_array();
    for (const RadioSource& source : sources) {
      json_.open_object(kLine);
      for_each_source_field(source, [&](const RadioField& field, double value) { json_.key(field.key).value(value); });
      json_.close();
    }
    json_.close();
  }

  // [sender, receiver, sent_ns, delay_ns], without a delay if the message was lost.
  void write_trace(const RadioTrace& trace) {
    json_.key("trace").open_array();
    for (const auto& [sender, receiver, sent, delay] : trace) {
      json_.open_array(kLine);
      json_.value(std::uint64_t{sender.value});
      json_.value(std::uint64_t{receiver.value});
      json_.value(sent.count());
      if (delay) json_.value(delay->count());
      json_.close();
    }
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
    const auto& [name, footprint, drive, turn, loaded, lateral_mps2, speed_deviation, settle_s, battery_per_m,
                 battery_idle_per_s, charge_per_s, pick_s, drop_s, storage_spread_s, other_spread_s] = vehicle;
    const auto& [extra_length_m, extra_width_m, speed_share, acceleration_share] = loaded;
    json_.open_object();
    json_.key("name").value(name);
    write_footprint(footprint);
    write_limits("drive", drive, keys::kDriveLimits);
    write_limits("turn", turn, keys::kTurnLimits);
    json_.key("loaded").open_object(kLine);
    json_.key("extra_length_m").value(extra_length_m);
    json_.key("extra_width_m").value(extra_width_m);
    json_.key("speed_share").value(speed_share);
    json_.key("acceleration_share").value(acceleration_share);
    json_.close();
    json_.key("lateral_mps2").value(lateral_mps2);
    json_.key("speed_deviation").value(speed_deviation);
    json_.key("settle_s").value(settle_s);
    json_.key("battery_per_m").value(battery_per_m);
    json_.key("battery_idle_per_s").value(battery_idle_per_s);
    json_.key("charge_per_s").value(charge_per_s);
    json_.key("pick_s").value(pick_s);
    json_.key("drop_s").value(drop_s);
    json_.key("storage_spread_s").value(storage_spread_s);
    json_.key("other_spread_s").value(other_spread_s);
    json_.close();
  }

  void write_agv(const AgvSetup& agv) {
    const auto& [name, type, start, heading, battery, sensing, transports, script] = agv;
    json_.open_object();
    json_.key("name").value(name);
    json_.key("type").value(scenario_.vehicle_types.at(type).name);
    json_.key("start").value(station(start));
    json_.key("heading").value(heading);
    json_.key("battery").value(battery);
    if (sensing != SensingSetup{}) write_sensing(sensing);
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

  void write_sensing(const SensingSetup& sensing) {
    const auto& [clock_offset_s, clock_drift_ppm, position_error_m, position_late_s] = sensing;
    json_.key("sensing").open_object(kLine);
    json_.key("clock_offset_s").value(clock_offset_s);
    json_.key("clock_drift_ppm").value(clock_drift_ppm);
    json_.key("position_error_m").value(position_error_m);
    json_.key("position_late_s").value(position_late_s);
    json_.close();
  }

  void write_obstacle(const ObstacleSetup& obstacle) {
    const auto& [name, footprint, pose, appears, leaves] = obstacle;
    json_.open_object(kLine);
    json_.key("name").value(name);
    write_footprint(footprint);
    json_.key("position_m").value(pose.position_m);
    json_.key("heading").value(pose.heading);
    if (appears != Duration::zero()) json_.key("appears_ns").value(appears.count());
    if (leaves != kLongestDuration) json_.key("leaves_ns").value(leaves.count());
    json_.close();
  }

  void write_faults(const std::vector<Fault>& faults) {
    if (faults.empty()) return;
    json_.key("faults").open_array();
    for (const auto& [kind, agv, at, transport, lasts, load, ahead_m, left_m] : faults) {
      json_.open_object(kLine);
      json_.key("kind").value(name_of(kind));
      json_.key("agv").value(scenario_.agvs.at(agv.index()).name);
      json_.key("at_ns").value(at.count());
      if (transport) json_.key("transport").value(std::int64_t{*transport});
      json_.key("lasts_ns").value(lasts.count());
      if (kind == Fault::Kind::LoadDrop) {
        write_footprint(load);
        json_.key("ahead_m").value(ahead_m);
        json_.key("left_m").value(left_m);
      }
      json_.close();
    }
    json_.close();
  }

  // Left out where they are as if nobody had spoken of them.
  void write_helpers(const ScannerSetup& scanner, const OperatorSetup& operator_help) {
    if (scanner != ScannerSetup{}) {
      const auto& [on, reaction_s, margin_m, resume_s] = scanner;
      json_.key("scanner").open_object(kLine);
      json_.key("on").value(on);
      json_.key("reaction_s").value(reaction_s);
      json_.key("margin_m").value(margin_m);
      json_.key("resume_s").value(resume_s);
      json_.close();
    }
    if (operator_help != OperatorSetup{}) {
      const auto& [on, least_s, most_s, battery] = operator_help;
      json_.key("operator").open_object(kLine);
      json_.key("on").value(on);
      json_.key("least_s").value(least_s);
      json_.key("most_s").value(most_s);
      json_.key("battery").value(battery);
      json_.close();
    }
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
