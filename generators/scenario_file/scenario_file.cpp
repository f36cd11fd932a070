#include "generators/scenario_file/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/base/tolerances.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "core/scenario/scenario_fields.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "generators/scenario_file/field_rules.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

// The keys that a scenario file may contain for a struct, collected from the list of fields of the struct.
class KnownKeys {
 public:
  // `place` is "key" or "group/key". A time may be given in seconds ("at_s") or in whole nanoseconds ("at_ns").
  void add(std::string_view place, bool is_time);
  // Throws InputError, with the nearest valid key, if `object` or a group in it contains another key.
  void expect(const JsonReader& object) const;

 private:
  struct Group {
    std::string name;  // empty: the object itself
    std::vector<std::string> keys;
  };
  std::vector<Group> groups_{Group{}};
};

template <HasFields Setup>
void expect_keys_of(const JsonReader& object, Setup& setup) {
  KnownKeys known;
  visit_fields(setup, [&](const Field& field, const auto& value) {
    known.add(field.scenario_place(), std::is_same_v<std::remove_cvref_t<decltype(value)>, Duration>);
  });
  known.expect(object);
}

// A time. Its key ends in "_s" or "_ns"; a file that has both is refused. `in_ns`: whether the key ended in "_ns".
struct FoundTime {
  JsonReader reader;
  bool in_ns = false;
};

// "drive" and "speed_mps" of "drive/speed_mps"; "" and "name" of "name".
std::pair<std::string_view, std::string_view> parts_of(std::string_view place) {
  const auto slash = place.find('/');
  if (slash == std::string_view::npos) return {"", place};
  return {place.substr(0, slash), place.substr(slash + 1)};
}

std::string in_nanoseconds(std::string_view key) { return std::string(key.substr(0, key.size() - 1)) + "ns"; }

template <class Scalar>
GivenValue as_given(const Scalar& value) {
  return value;
}
GivenValue as_given(std::nullptr_t) { return std::monostate{}; }

void KnownKeys::add(std::string_view place, bool is_time) {
  const auto [name, key] = parts_of(place);
  auto group = std::ranges::find(groups_, name, &Group::name);
  if (group == groups_.end()) {
    groups_.front().keys.emplace_back(name);
    group = groups_.insert(groups_.end(), Group{std::string(name), {}});
  }
  group->keys.emplace_back(key);
  if (is_time) group->keys.push_back(in_nanoseconds(key));
}

void KnownKeys::expect(const JsonReader& object) const {
  for (const auto& [name, keys] : groups_) {
    const auto reader = name.empty() ? std::optional(object) : object.find(name);
    if (reader) reader->expect_object(std::vector<std::string_view>(keys.begin(), keys.end()));
  }
}

// The value at "key" or "group/key". Throws InputError if it is absent and needed.
std::optional<JsonReader> find_field(const JsonReader& object, const Field& field) {
  const auto [group, key] = parts_of(field.scenario_place());
  if (group.empty()) return field.needed ? object.at(key) : object.find(key);
  const auto inner = object.find(group);
  return inner ? inner->find(key) : std::nullopt;
}

std::optional<FoundTime> find_time(const JsonReader& object, const Field& field) {
  const std::string ns_key = in_nanoseconds(field.key);
  const auto in_s = object.find(field.key), in_ns = object.find(ns_key);
  if (in_s && in_ns) in_s->refuse(fmt::format("the same duration is given as {}; keep one of them", ns_key));
  if (in_ns) return FoundTime{*in_ns, true};
  if (in_s) return FoundTime{*in_s, false};
  if (field.needed) object.at(field.key);  // refuses
  return std::nullopt;
}

// As `take` wants it.
GivenValue given_by(const JsonReader& reader) {
  if (reader.value().shape != JsonValue::Shape::Scalar) return std::monostate{};
  return std::visit([](const auto& value) { return as_given(value); }, reader.value().scalar);
}

// A plain value: what `take` says of it, with its place.
template <PlainValue Value>
void read_value(const JsonReader& reader, const Field& field, Value& target) {
  if (const auto sentence = take(field, given_by(reader), target); !sentence.empty()) reader.refuse(sentence);
}

// Ids by name. An error for an unknown name suggests the nearest name.
class Names {
 public:
  Names(std::string_view noun, const auto& things) : noun_(noun) { add(things); }
  // Of the participants.
  explicit Names(const Scenario& scenario)
      : Names(scenario.computers.empty() ? "AGV" : "AGV or computer", scenario.agvs) {
    add(scenario.computers);
  }

  std::uint32_t at(const JsonReader& reader) const {
    const auto name = reader.text();
    if (const auto found = ids_.find(name); found != ids_.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [other, id] : ids_) known.push_back(other);
    const auto nearest = nearest_name(name, known);
    reader.refuse(
        fmt::format("there is no such {}{}", noun_, nearest ? "; did you mean " + in_quotes(*nearest) + "?" : ""));
  }

 private:
  void add(const auto& things) {
    for (const auto& thing : things) ids_.emplace(thing.name, count_++);
  }

  std::string_view noun_;
  std::map<std::string, std::uint32_t> ids_;
  std::uint32_t count_ = 0;
};

RecordedMessage recorded_message(const JsonReader& reader) {
  const auto items = reader.items();
  if (items.size() != 3 && items.size() != 4)
    reader.refuse("a recorded message is [sender, receiver, sent_ns, delay_ns], without a delay if it was lost");
  const auto agv = [](const JsonReader& number) {
    if (number.natural() >= kAgvNumbers) number.refuse("an AGV has a number below 65536");
    return AgvId{static_cast<std::uint32_t>(number.natural())};
  };
  RecordedMessage message{agv(items[0]), agv(items[1]), Duration{items[2].integer()}, std::nullopt};
  if (items.size() == 4) message.delay = Duration{items[3].integer()};
  return message;
}

// Reads a struct by its list of fields. Names of stations, segments, vehicle types and participants must be read before
// they are used: layout and vehicle types come first, AGVs and computers before what names them.
class ScenarioReader {
 public:
  // Null: the map is that of the layout in the text.
  Scenario read(const JsonReader& root, std::shared_ptr<const LogicalMap> map) {
    Scenario scenario;
    if (!map) map = std::make_shared<const LogicalMap>(read_layout(root.at("layout")));
    scenario.map = std::move(map);
    stations_.emplace("station", scenario.map->layout().stations);
    segments_.emplace("segment", scenario.map->layout().segments);
    if (const auto types = root.find("vehicle_types"))
      value({.key = "vehicle_types", .text = "", .lenient = kOfScenarios}, *types, scenario.vehicle_types);
    types_.emplace("vehicle type", scenario.vehicle_types);
    visit_fields(scenario, [&](const Field& field, auto&& target) {
      member(root, field, target);
      if (field.key == "computers") participants_.emplace(scenario);
    });
    return scenario;
  }

 private:
  template <HasFields Setup>
  void fields(const JsonReader& object, Setup& setup) {
    expect_keys_of(object, setup);
    visit_fields(setup, [&](const Field& field, auto&& target) { member(object, field, target); });
  }

  template <class Target>
  void member(const JsonReader& object, const Field& field, Target&& target) {
    if (const auto found = find_field(object, field)) value(field, *found, target);
  }
  void member(const JsonReader& object, const Field& field, Duration& target) {
    const auto found = find_time(object, field);
    if (!found) return;
    if (!found->in_ns) return read_value(found->reader, field, target);
    target = Duration{found->reader.integer()};
    if (const auto fault = fault_of(field, target); !fault.empty()) found->reader.refuse(fault);
  }
  void member(const JsonReader&, const Field&, std::shared_ptr<const LogicalMap>&) {}  // read first
  void member(const JsonReader&, const Field&, std::vector<VehicleType>&) {}           // read first

  template <PlainValue Plain>
  void value(const Field& field, const JsonReader& reader, Plain& target) {
    read_value(reader, field, target);
  }
  template <HasFields Setup>
  void value(const Field&, const JsonReader& reader, Setup& target) {
    fields(reader, target);
  }
  template <class Item>
  void value(const Field& field, const JsonReader& reader, std::vector<Item>& target) {
    target.clear();
    for (const JsonReader& item : reader.items()) value(field, item, target.emplace_back());
  }
  void value(const Field& field, const JsonReader& reader, std::optional<std::uint32_t>& target) {
    read_value(reader, field, target.emplace());
  }
  void value(const Field& field, const JsonReader& reader, Vec2& target) {
    target = reader.vector();
    for (const double coordinate : {target.x(), target.y()}) {
      if (const auto fault = fault_of(field, coordinate); !fault.empty()) reader.refuse(fault);
    }
  }
  void value(const Field&, const JsonReader& reader, const Direction<Vec2>& target) {
    target.vector = reader.heading();
  }
  void value(const Field&, const JsonReader& reader, StationId& target) { target = StationId{stations_->at(reader)}; }
  void value(const Field&, const JsonReader& reader, SegmentId& target) { target = SegmentId{segments_->at(reader)}; }
  void value(const Field& field, const JsonReader& reader, std::optional<Vec2>& target) {
    value(field, reader, target.emplace());
  }
  void value(const Field&, const JsonReader& reader, EntityId& target) { target = EntityId{participants_->at(reader)}; }
  template <class Index>
  void value(const Field&, const JsonReader& reader, const TypeIndex<Index>& target) {
    target.index = types_->at(reader);
  }
  void value(const Field&, const JsonReader& reader, Purposes& target) {
    const auto purposes = purposes_of_text(reader.text());
    if (!purposes) reader.refuse(expected_word({}, kPurposeNames));
    target = *purposes;
  }
  void value(const Field&, const JsonReader& reader, ExemptPair& target) {
    const auto names = reader.items();
    if (const auto fault = fault_of_pair_size(names.size()); !fault.empty()) reader.refuse(fault);
    target = {names[0].text(), names[1].text()};
  }
  void value(const Field&, const JsonReader& reader, std::vector<StreamSeed>& target) {
    std::vector<std::string_view> names;
    for (const Stream stream : kRunStreams) names.emplace_back(name_of(stream));
    reader.expect_object(names);
    for (const Stream stream : kRunStreams) {
      const auto seed = reader.find(name_of(stream));
      if (seed) read_value(*seed, kSeed, target.emplace_back(StreamSeed{stream, 0}).seed);
    }
  }
  void value(const Field&, const JsonReader& reader, std::shared_ptr<const RadioTrace>& target) {
    RadioTrace messages;
    for (const auto& item : reader.items()) messages.push_back(recorded_message(item));
    if (!messages.empty()) target = std::make_shared<const RadioTrace>(std::move(messages));
  }

  std::optional<Names> stations_, segments_, types_, participants_;
};

Scenario scenario_of(std::string_view text, std::string_view source, std::shared_ptr<const LogicalMap> map) {
  const JsonValue root = parse_json(text, source);
  const JsonReader reader(root, source);
  KnownKeys known;
  Scenario nothing;
  known.add("version", false);
  visit_fields(nothing, [&](const Field& field, const auto& value) {
    known.add(field.key, std::is_same_v<std::remove_cvref_t<decltype(value)>, Duration>);
  });
  known.expect(reader);
  if (const auto version = reader.at("version"); version.integer() != kScenarioFileVersion)
    version.refuse(fmt::format("this program reads scenario files of version {}", kScenarioFileVersion));
  Scenario scenario = ScenarioReader().read(reader, std::move(map));
  const auto problems = unusable_problems(scenario);
  if (!problems.empty()) reader.refuse_below(problems[0].pointer, problems[0].sentence);
  return scenario;
}

}  // namespace

Scenario read_scenario(const std::string& path) { return parse_scenario(read_text_file(path), path); }

Scenario parse_scenario(std::string_view text, std::string_view source) { return scenario_of(text, source, nullptr); }

Scenario parse_scenario_on(std::shared_ptr<const LogicalMap> map, std::string_view text, std::string_view source) {
  return scenario_of(text, source, std::move(map));
}

}  // namespace fleetproof
