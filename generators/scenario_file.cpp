#include "generators/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "core/catalogue.hpp"
#include "generators/json_value.hpp"
#include "generators/layout_file.hpp"
#include "generators/purpose_words.hpp"
#include "generators/scenario_keys.hpp"
#include "generators/text_file.hpp"
#include "generators/validator.hpp"

namespace fleetproof {
namespace {

namespace keys = scenario_keys;

// Ids by name, with a hint where there is none.
template <class Id>
class Names {
 public:
  Names(std::string_view noun, const auto& things) : noun_(noun) {
    for (std::size_t i = 0; i < things.size(); ++i) ids_.emplace(things[i].name, Id{i});
  }

  Id at(const JsonReader& reader) const {
    const auto name = reader.text();
    if (const auto found = ids_.find(name); found != ids_.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [other, id] : ids_) known.push_back(other);
    const auto nearest = nearest_name(name, known);
    reader.refuse(fmt::format("there is no such {}{}", noun_, nearest ? "; did you mean " + in_quotes(*nearest) + "?" : ""));
  }

 private:
  std::string_view noun_;
  std::map<std::string, Id> ids_;
};

using VehicleTypeId = StrongId<struct VehicleTypeTag>;

// The place of a word in a list of words.
std::size_t one_of(const JsonReader& reader, std::span<const std::string_view> words) {
  const auto word = reader.text();
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) reader.refuse("there is no such word here" + name_hint(word, words));
  return static_cast<std::size_t>(found - words.begin());
}

// "`name`_s" in seconds or "`name`_ns" in whole nanoseconds.
std::optional<Duration> find_duration(const JsonReader& reader, const std::string& name) {
  constexpr double kLongest_s = 9e9;
  const auto in_s = reader.find(name + "_s"), in_ns = reader.find(name + "_ns");
  if (in_s && in_ns) in_s->refuse(fmt::format("the same duration is given as {}_ns; keep one of them", name));
  if (in_ns) return Duration{in_ns->integer()};
  if (!in_s) return std::nullopt;
  if (!(std::abs(in_s->number()) <= kLongest_s)) in_s->refuse("a duration is shorter than 9e9 s");
  return seconds(in_s->number());
}

Duration duration_at(const JsonReader& reader, const std::string& name) {
  const auto found = find_duration(reader, name);
  return found ? *found : Duration{reader.at(name + "_s").integer()};  // absent: complains
}

void read_duration(const JsonReader& reader, const std::string& name, Duration& target) {
  if (const auto found = find_duration(reader, name)) target = *found;
}

Vec2 read_heading(const JsonReader& reader) {
  const Vec2 heading = reader.vector();
  const double norm = heading.norm();
  if (!(norm > 1e-9) || !(norm < 1e9)) reader.refuse("a heading is a direction [x, y] other than [0, 0]");
  // A vector that is a unit vector to the last digits stays as it is, so that reading again what was written changes nothing.
  return std::abs(heading.squaredNorm() - 1.0) <= 1e-12 ? heading : Vec2(heading / norm);
}

void read_limits(const JsonReader& vehicle, std::string_view key, std::span<const std::string_view> names, MotionLimits& limits) {
  const auto reader = vehicle.find(key);
  if (!reader) return;
  reader->expect_object(names);
  reader->read(names[0], limits.speed_mps);
  reader->read(names[1], limits.acceleration_mps2);
  reader->read(names[2], limits.deceleration_mps2);
}

VehicleType read_vehicle(const JsonReader& reader) {
  reader.expect_object(keys::kVehicle);
  VehicleType vehicle;
  reader.read("name", vehicle.name);
  reader.read("length_m", vehicle.footprint.length_m);
  reader.read("width_m", vehicle.footprint.width_m);
  read_limits(reader, "drive", keys::kDriveLimits, vehicle.drive);
  read_limits(reader, "turn", keys::kTurnLimits, vehicle.turn);
  reader.read("battery_per_m", vehicle.battery_per_m);
  reader.read("charge_per_s", vehicle.charge_per_s);
  reader.read("pick_s", vehicle.pick_s);
  reader.read("drop_s", vehicle.drop_s);
  return vehicle;
}

ObstacleSetup read_obstacle(const JsonReader& reader) {
  reader.expect_object(keys::kObstacle);
  ObstacleSetup obstacle;
  obstacle.name = reader.at("name").text();
  obstacle.footprint = {reader.at("length_m").number(), reader.at("width_m").number()};
  obstacle.pose.position_m = reader.at("position_m").vector();
  if (const auto heading = reader.find("heading")) obstacle.pose.heading = read_heading(*heading);
  return obstacle;
}

class AgvReader {
 public:
  explicit AgvReader(const Scenario& scenario)
      : types_("vehicle type", scenario.vehicle_types),
        stations_("station", scenario.map->layout().stations),
        segments_("segment", scenario.map->layout().segments) {}

  AgvSetup read(const JsonReader& reader) const {
    reader.expect_object(keys::kAgv);
    AgvSetup agv;
    agv.name = reader.at("name").text();
    if (const auto type = reader.find("type")) agv.type = types_.at(*type).value;
    agv.start = stations_.at(reader.at("start"));
    if (const auto heading = reader.find("heading")) agv.heading = read_heading(*heading);
    reader.read("battery", agv.battery);
    if (const auto transports = reader.find("transports")) {
      for (const auto& item : transports->items()) agv.transports.push_back(transport(item));
    }
    if (const auto script = reader.find("script")) {
      for (const auto& item : script->items()) agv.script.push_back(call(item));
    }
    return agv;
  }

 private:
  TransportOrder transport(const JsonReader& reader) const {
    reader.expect_object(keys::kTransport);
    return {stations_.at(reader.at("from")), stations_.at(reader.at("to")), duration_at(reader, "release")};
  }

  ScriptedCall call(const JsonReader& reader) const {
    reader.expect_object(keys::kCall);
    const auto action = static_cast<ScriptedCall::Action>(one_of(reader.at("action"), keys::kActions));
    return {duration_at(reader, "at"), action, segments_.at(reader.at("segment"))};
  }

  Names<VehicleTypeId> types_;
  Names<StationId> stations_;
  Names<SegmentId> segments_;
};

void read_radio(const JsonReader& reader, RadioSetup& radio) {
  reader.expect_object(keys::kRadio);
  reader.read("loss", radio.loss);
  reader.read("delay_s", radio.delay_s);
  if (const auto model = reader.find("delay_model")) radio.delay_model = static_cast<RadioSetup::DelayModel>(one_of(*model, keys::kDelayModels));
  reader.read("range_m", radio.range_m);
  reader.read("air_time_s", radio.air_time_s);
}

void read_settings(const JsonReader& reader, Scenario& scenario) {
  reader.read("name", scenario.name);
  if (const auto radio = reader.find("radio")) read_radio(*radio, scenario.radio);
  if (const auto clock = reader.find("agent_clock")) {
    clock->expect_object(keys::kAgentClock);
    clock->read("call_cost_s", scenario.agent_clock.call_cost_s);
  }
  if (const auto law = reader.find("law")) {
    law->expect_object(keys::kLaw);
    law->read("safety_distance_m", scenario.law.safety_distance_m);
    law->read("snapshot_s", scenario.law.snapshot_s);
    law->read("reaction_s", scenario.law.reaction_s);
    law->read("min_transports_per_agv_hour", scenario.law.min_transports_per_agv_hour);
    law->read("exempt_radius_m", scenario.law.exempt_radius_m);
    if (const auto words = law->find("exempt_purposes")) {
      const auto purposes = purposes_of_text(words->text());
      if (!purposes) words->refuse("holds a word that is no purpose; known: routing, storage, charging, parking");
      scenario.law.exempt_purposes = *purposes;
    }
  }
  reader.read("contact_stops", scenario.contact_stops);
  read_duration(reader, "horizon", scenario.horizon);
  read_duration(reader, "stuck_after", scenario.stuck_after);
}

// A whole number, or "0x" and hexadecimal digits.
std::uint64_t read_seed(const JsonReader& reader) {
  if (!reader.is_text()) return reader.natural();
  const auto text = reader.text();
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  if (text.size() > 2 && text.starts_with("0x")) {
    const auto read = std::from_chars(text.data() + 2, end, seed, 16);
    if (read.ec == std::errc() && read.ptr == end) return seed;
  }
  reader.refuse("a seed is a whole number or a text of \"0x\" and up to 16 hexadecimal digits");
}

}  // namespace

Scenario read_scenario(const std::string& path) { return parse_scenario(read_text_file(path), path); }

Scenario parse_scenario(std::string_view text, std::string_view source) {
  const JsonValue root = parse_json(text, source);
  const JsonReader reader(root, source);
  reader.expect_object(keys::kScenario);
  if (const auto version = reader.at("version"); version.integer() != keys::kVersion) {
    version.refuse(fmt::format("this program reads scenario files of version {}", keys::kVersion));
  }
  Scenario scenario;
  read_settings(reader, scenario);
  if (const auto seed = reader.find("seed")) scenario.seed = read_seed(*seed);
  scenario.map = std::make_shared<const LogicalMap>(read_layout(reader.at("layout")));
  if (const auto types = reader.find("vehicle_types")) {
    scenario.vehicle_types.clear();
    for (const auto& item : types->items()) scenario.vehicle_types.push_back(read_vehicle(item));
  }
  const AgvReader agvs(scenario);
  for (const auto& item : reader.at("agvs").items()) scenario.agvs.push_back(agvs.read(item));
  if (const auto obstacles = reader.find("obstacles")) {
    for (const auto& item : obstacles->items()) scenario.obstacles.push_back(read_obstacle(item));
  }
  const auto problems = unusable_problems(scenario);
  if (!problems.empty()) reader.refuse_below(problems[0].pointer, problems[0].sentence);
  return scenario;
}

}  // namespace fleetproof
