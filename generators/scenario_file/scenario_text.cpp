#include "generators/scenario_file/scenario_text.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/scenario/scenario_fields.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/text/json_writer.hpp"

namespace fleetproof {
namespace {

using Style = JsonWriter::Style;

// As text: many JSON readers keep 53 bits only.
std::string seed_text(std::uint64_t seed) { return fmt::format("0x{:016x}", seed); }

// Writes a struct by its list of fields.
class ScenarioWriter {
 public:
  enum class Layouts : bool { LeftOut, Written };
  explicit ScenarioWriter(const Scenario& scenario, Layouts layouts) : scenario_(scenario), layouts_(layouts) {}

  std::string write() {
    ensure(scenario_.map != nullptr, "a scenario has a map");
    json_.open_object();
    json_.key("version").value(kScenarioFileVersion);
    fields(scenario_);
    json_.close();
    return json_.take();
  }

 private:
  template <HasFields Setup>
  void fields(const Setup& setup) {
    std::string_view group;
    visit_fields(setup, [&](const Field& field, const auto& value) {
      if (field.left_out) return;
      const auto place = field.scenario_place();
      const auto slash = place.find('/');
      const auto next = slash == std::string_view::npos ? std::string_view{} : place.substr(0, slash);
      if (next != group) {
        if (!group.empty()) json_.close();
        if (!next.empty()) json_.key(next).open_object(Style::Line);
        group = next;
      }
      member(place.substr(next.empty() ? 0 : slash + 1), value);
    });
    if (!group.empty()) json_.close();
  }

  template <class Value>
  void member(std::string_view key, const Value& value) {
    json_.key(key);
    write(value);
  }
  void member(std::string_view key, Duration value) {
    json_.key(std::string(key.substr(0, key.size() - 1)) + "ns").value(std::int64_t{value.count()});
  }

  void member(std::string_view key, const std::shared_ptr<const LogicalMap>& map) {
    if (layouts_ == Layouts::LeftOut) return;
    json_.key(key);
    write_layout(json_, map->layout());
  }

  // Short structs stand on one line.
  template <HasFields Setup>
  void write(const Setup& setup) {
    constexpr bool kLong =
        std::is_same_v<Setup, RadioSetup> || std::is_same_v<Setup, VehicleType> || std::is_same_v<Setup, AgvSetup>;
    json_.open_object(kLong ? Style::Spread : Style::Line);
    fields(setup);
    json_.close();
  }
  template <class Item>
  void write(const std::vector<Item>& items) {
    json_.open_array(std::is_same_v<Item, ExemptPair> ? Style::Line : Style::Spread);
    for (const Item& item : items) write(item);
    json_.close();
  }
  template <HasWords Enum>
  void write(Enum value) {
    json_.value(name_of(value));
  }
  void write(double value) { json_.value(value); }
  void write(bool value) { json_.value(value); }
  void write(std::uint32_t value) { json_.value(std::uint64_t{value}); }
  void write(std::uint64_t seed) { json_.value(seed_text(seed)); }
  void write(const std::string& text) { json_.value(text); }
  void write(const std::optional<std::uint32_t>& value) { json_.value(std::uint64_t{value.value_or(0)}); }
  void write(const Vec2& vector) { json_.value(vector); }
  void write(const std::optional<Vec2>& place_m) { json_.value(place_m.value_or(Vec2::Zero())); }
  template <class Vector>
  void write(const Direction<Vector>& direction) {
    json_.value(direction.vector);
  }
  template <class Index>
  void write(const TypeIndex<Index>& type) {
    json_.value(scenario_.vehicle_types.at(type.index).name);
  }
  void write(StationId id) { json_.value(scenario_.map->layout().stations.at(id.index()).name); }
  void write(SegmentId id) { json_.value(scenario_.map->layout().segments.at(id.index()).name); }
  void write(EntityId participant) { json_.value(scenario_.name_of(participant)); }
  void write(Purposes purposes) { json_.value(purposes_text(purposes)); }
  void write(const ExemptPair& pair) {
    json_.open_array(Style::Line);
    json_.value(pair.one);
    json_.value(pair.other);
    json_.close();
  }
  void write(const std::vector<StreamSeed>& stream_seeds) {
    json_.open_object(Style::Line);
    for (const auto& [stream, seed] : stream_seeds) json_.key(name_of(stream)).value(seed_text(seed));
    json_.close();
  }
  // [sender, receiver, sent_ns, delay_ns], without a delay if the message was lost.
  void write(const std::shared_ptr<const RadioTrace>& trace) {
    json_.open_array();
    for (const auto& [sender, receiver, sent, delay] : *trace) {
      json_.open_array(Style::Line);
      json_.value(std::uint64_t{sender.value});
      json_.value(std::uint64_t{receiver.value});
      json_.value(std::int64_t{sent.count()});
      if (delay) json_.value(std::int64_t{delay->count()});
      json_.close();
    }
    json_.close();
  }

  const Scenario& scenario_;
  Layouts layouts_;
  JsonWriter json_;
};

}  // namespace

std::string to_text(const Scenario& scenario) {
  return ScenarioWriter(scenario, ScenarioWriter::Layouts::Written).write();
}

std::string text_without_layout(const Scenario& scenario) {
  return ScenarioWriter(scenario, ScenarioWriter::Layouts::LeftOut).write();
}

}  // namespace fleetproof
