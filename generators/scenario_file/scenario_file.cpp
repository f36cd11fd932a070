#include "generators/scenario_file/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>

#include "core/base/catalogue.hpp"
#include "core/base/tolerances.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/radio_fields.hpp"
#include "generators/scenario_file/scenario_keys.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"

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
    reader.refuse(
        fmt::format("there is no such {}{}", noun_, nearest ? "; did you mean " + in_quotes(*nearest) + "?" : ""));
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
  if (!(norm > kShortestHeading) || !(norm < 1e9)) reader.refuse("a heading is a direction [x, y] other than [0, 0]");
  // A vector that is a unit vector to the last digits stays as it is, so that reading again what was written changes
  // nothing.
  return std::abs(heading.squaredNorm() - 1.0) <= kUnitVectorToTheLastDigits ? heading : Vec2(heading / norm);
}

void read_limits(const JsonReader& vehicle, std::string_view key, std::span<const std::string_view> names,
                 MotionLimits& limits) {
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
  if (const auto loaded = reader.find("loaded")) {
    loaded->expect_object(keys::kLoaded);
    loaded->read("extra_length_m", vehicle.loaded.extra_length_m);
    loaded->read("extra_width_m", vehicle.loaded.extra_width_m);
    loaded->read("speed_share", vehicle.loaded.speed_share);
    loaded->read("acceleration_share", vehicle.loaded.acceleration_share);
  }
  reader.read("lateral_mps2", vehicle.lateral_mps2);
  reader.read("speed_deviation", vehicle.speed_deviation);
  reader.read("settle_s", vehicle.settle_s);
  reader.read("battery_per_m", vehicle.battery_per_m);
  reader.read("battery_idle_per_s", vehicle.battery_idle_per_s);
  reader.read("charge_per_s", vehicle.charge_per_s);
  reader.read("pick_s", vehicle.pick_s);
  reader.read("drop_s", vehicle.drop_s);
  reader.read("storage_spread_s", vehicle.storage_spread_s);
  reader.read("other_spread_s", vehicle.other_spread_s);
  return vehicle;
}

ObstacleSetup read_obstacle(const JsonReader& reader) {
  reader.expect_object(keys::kObstacle);
  ObstacleSetup obstacle;
  obstacle.name = reader.at("name").text();
  obstacle.footprint = {reader.at("length_m").number(), reader.at("width_m").number()};
  obstacle.pose.position_m = reader.at("position_m").vector();
  if (const auto heading = reader.find("heading")) obstacle.pose.heading = read_heading(*heading);
  read_duration(reader, "appears", obstacle.appears);
  read_duration(reader, "leaves", obstacle.leaves);
  return obstacle;
}

SensingSetup read_sensing(const JsonReader& reader) {
  reader.expect_object(keys::kSensing);
  SensingSetup sensing;
  reader.read("clock_offset_s", sensing.clock_offset_s);
  reader.read("clock_drift_ppm", sensing.clock_drift_ppm);
  reader.read("position_error_m", sensing.position_error_m);
  reader.read("position_late_s", sensing.position_late_s);
  return sensing;
}

Fault read_fault(const JsonReader& reader, const Names<AgvId>& agvs) {
  reader.expect_object(keys::kFault);
  Fault fault;
  fault.kind = static_cast<Fault::Kind>(one_of(reader.at("kind"), keys::kFaultKinds) + 1);
  fault.agv = agvs.at(reader.at("agv"));
  fault.at = duration_at(reader, "at");
  if (const auto transport = reader.find("transport"))
    fault.transport = static_cast<std::uint32_t>(std::min<std::uint64_t>(transport->natural(), 0xffffffff));
  fault.lasts = duration_at(reader, "lasts");
  reader.read("length_m", fault.load.length_m);
  reader.read("width_m", fault.load.width_m);
  reader.read("ahead_m", fault.ahead_m);
  reader.read("left_m", fault.left_m);
  return fault;
}

void read_faults(const JsonReader& reader, Scenario& scenario) {
  if (const auto faults = reader.find("faults")) {
    const Names<AgvId> agvs("AGV", scenario.agvs);
    for (const auto& item : faults->items()) scenario.faults.push_back(read_fault(item, agvs));
  }
  if (const auto scanner = reader.find("scanner")) {
    scanner->expect_object(keys::kScanner);
    scanner->read("on", scenario.scanner.on);
    scanner->read("reaction_s", scenario.scanner.reaction_s);
    scanner->read("margin_m", scenario.scanner.margin_m);
    scanner->read("resume_s", scenario.scanner.resume_s);
  }
  if (const auto help = reader.find("operator")) {
    help->expect_object(keys::kOperator);
    help->read("on", scenario.operator_help.on);
    help->read("least_s", scenario.operator_help.least_s);
    help->read("most_s", scenario.operator_help.most_s);
    help->read("battery", scenario.operator_help.battery);
  }
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
    if (const auto sensing = reader.find("sensing")) agv.sensing = read_sensing(*sensing);
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

RecordedMessage read_recorded(const JsonReader& reader) {
  const auto items = reader.items();
  if (items.size() != 3 && items.size() != 4)
    reader.refuse("a recorded message is [sender, receiver, sent_ns, delay_ns], without a delay if it was lost");
  const auto agv = [](const JsonReader& number) {
    if (number.natural() > 0xffff) number.refuse("an AGV has a number below 65536");
    return AgvId{static_cast<std::uint32_t>(number.natural())};
  };
  RecordedMessage message{agv(items[0]), agv(items[1]), Duration{items[2].integer()}, std::nullopt};
  if (items.size() == 4) message.delay = Duration{items[3].integer()};
  return message;
}

RadioSource read_source(const JsonReader& reader) {
  RadioSource source;
  std::vector<std::string_view> known;
  for_each_source_field(source, [&](const RadioField& field, double) { known.push_back(field.key); });
  reader.expect_object(known);
  for (const std::string_view key : {"x_m", "y_m"}) {
    if (!reader.find(key)) reader.refuse("an external source needs its place, x_m and y_m");
  }
  for_each_source_field(source, [&](const RadioField& field, double& value) { reader.read(field.key, value); });
  return source;
}

void read_radio(const JsonReader& reader, RadioSetup& radio) {
  std::vector<std::string_view> known;
  for_each_radio_field(radio, [&](const RadioField& field, const auto&) { known.push_back(field.key); });
  known.push_back("sources");
  known.push_back("trace");
  reader.expect_object(known);
  for_each_radio_field(radio, [&](const RadioField& field, auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>) {
      if (const auto word = reader.find(field.key)) value = static_cast<Value>(one_of(*word, field.words));
    } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
      const auto number = reader.find(field.key);
      if (number && number->natural() > std::numeric_limits<std::uint32_t>::max())
        number->refuse(fmt::format("it is at most {}", field.high));
      if (number) value = static_cast<std::uint32_t>(number->natural());
    } else {
      reader.read(field.key, value);
    }
  });
  if (const auto sources = reader.find("sources")) {
    for (const auto& item : sources->items()) radio.sources.push_back(read_source(item));
  }
  if (const auto trace = reader.find("trace")) {
    RadioTrace messages;
    for (const auto& item : trace->items()) messages.push_back(read_recorded(item));
    if (!messages.empty()) radio.trace = std::make_shared<const RadioTrace>(std::move(messages));
  }
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
    if (const auto pairs = law->find("exempt_pairs")) {
      for (const JsonReader& pair : pairs->items()) {
        const auto names = pair.items();
        if (names.size() != 2)
          pair.refuse("is no pair; give the names of two vehicle types, or of one and \"obstacle\"");
        scenario.law.exempt_pairs.push_back({names[0].text(), names[1].text()});
      }
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

void read_stream_seeds(const JsonReader& reader, Scenario& scenario) {
  std::vector<std::string_view> names;
  for (const Stream stream : kRunStreams) names.emplace_back(name_of(stream));
  reader.expect_object(names);
  for (const Stream stream : kRunStreams) {
    if (const auto seed = reader.find(name_of(stream))) scenario.stream_seeds.push_back({stream, read_seed(*seed)});
  }
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
  if (const auto seeds = reader.find("stream_seeds")) read_stream_seeds(*seeds, scenario);
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
  read_faults(reader, scenario);
  const auto problems = unusable_problems(scenario);
  if (!problems.empty()) reader.refuse_below(problems[0].pointer, problems[0].sentence);
  return scenario;
}

}  // namespace fleetproof
