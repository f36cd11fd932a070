#include "core/scenario/canonical_bytes.hpp"

#include <xxhash.h>

#include <algorithm>
#include <bit>

#include "core/base/error.hpp"
#include "core/scenario/scenario_fields.hpp"

namespace fleetproof {

static_assert(std::endian::native == std::endian::little, "canonical bytes are little-endian");

void CanonicalBytes::add(double value) { add(std::bit_cast<std::uint64_t>(value + 0.0)); }

void CanonicalBytes::add(std::string_view text) {
  add(std::uint64_t{text.size()});
  bytes_.append(text);
}

void CanonicalBytes::add(const Vec2& vector) {
  add(vector.x());
  add(vector.y());
}

std::uint64_t CanonicalBytes::digest() const { return XXH3_64bits(bytes_.data(), bytes_.size()); }

namespace {

// What most layouts do not have leaves the digest of those without it as it is.
void add_properties(CanonicalBytes& bytes, const Layout& layout) {
  if (layout.blocks.empty() && std::ranges::none_of(layout.segments, &Segment::has_properties)) return;
  for (const Segment& segment : layout.segments) {
    bytes.add(segment.speed_limit_mps);
    bytes.add(segment.back_speed_limit_mps);
    bytes.add(segment.width_m);
    bytes.add(std::uint64_t{segment.blocks.size()});
    for (const std::uint32_t block : segment.blocks) bytes.add(std::uint64_t{block});
  }
  bytes.add(std::uint64_t{layout.blocks.size()});
  for (const auto& [name, kind] : layout.blocks) {
    bytes.add(std::string_view(name));
    bytes.add_byte(static_cast<std::uint8_t>(kind));
  }
}

void add_rules(CanonicalBytes& bytes, const Layout& layout) {
  if (std::ranges::none_of(layout.segments, &Segment::has_rules) &&
      std::ranges::none_of(layout.stations, &Station::has_rules))
    return;
  for (const Segment& segment : layout.segments) {
    bytes.add_byte(static_cast<std::uint8_t>(segment.travel));
    bytes.add_byte(static_cast<std::uint8_t>(segment.back_travel));
    bytes.add(std::uint64_t{segment.permissions.size()});
    for (const auto& [vehicle_type, load] : segment.permissions) {
      bytes.add(std::string_view(vehicle_type));
      bytes.add_byte(static_cast<std::uint8_t>(load));
    }
  }
  for (const Station& station : layout.stations) {
    bytes.add_byte(station.turning ? 1 : 0);
    bytes.add_byte(station.heading ? 1 : 0);
    if (station.heading) bytes.add(*station.heading);
  }
}

}  // namespace

// Structured bindings: a member that is added to a layout does not compile until it is part of the digest.
std::uint64_t layout_digest(const Layout& layout) {
  const auto& [name, floor_low_m, floor_high_m, stations, segments, blocks] = layout;
  CanonicalBytes bytes;
  bytes.add(std::string_view(name));
  bytes.add(floor_low_m);
  bytes.add(floor_high_m);
  bytes.add(std::uint64_t{stations.size()});
  for (const auto& [station, position_m, purposes, turning, heading] : stations) {
    bytes.add(std::string_view(station));
    bytes.add(position_m);
    bytes.add_byte(purposes.bits());
  }
  bytes.add(std::uint64_t{segments.size()});
  for (const auto& [segment, from, to, bidirectional, control_points_m, speed_limit_mps, back_speed_limit_mps, width_m,
                    own_blocks, travel, back_travel, permissions] : segments) {
    bytes.add(std::string_view(segment));
    bytes.add(std::uint64_t{from.value});
    bytes.add(std::uint64_t{to.value});
    bytes.add_byte(bidirectional ? 1 : 0);
    bytes.add(std::uint64_t{control_points_m.size()});
    for (const Vec2& point : control_points_m) bytes.add(point);
  }
  add_properties(bytes, layout);
  add_rules(bytes, layout);
  return bytes.digest();
}

namespace {

// Goes over the lists of fields: what stands in a list is part of the digest.
class ScenarioBytes {
 public:
  std::uint64_t digest_of(const Scenario& scenario) {
    fields(scenario);
    return bytes_.digest();
  }

 private:
  template <HasFields Setup>
  void fields(const Setup& setup) {
    visit_fields(setup, [this](const Field& field, const auto& value) {
      if (field.is_later && field.left_out) return;
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, ExpectedOutcome>) return;
      bytes_.add_byte(field.left_out ? 0 : 1);
      if (!field.left_out) add(value);
    });
  }

  template <HasFields Setup>
  void add(const Setup& setup) {
    fields(setup);
  }
  template <class Item>
  void add(const std::vector<Item>& items) {
    bytes_.add(std::uint64_t{items.size()});
    for (const Item& item : items) add(item);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void add(Enum value) { bytes_.add_byte(static_cast<std::uint8_t>(value)); }
  void add(double value) { bytes_.add(value); }
  void add(bool value) { bytes_.add_byte(value ? 1 : 0); }
  void add(std::uint32_t value) { bytes_.add(std::uint64_t{value}); }
  void add(std::uint64_t value) { bytes_.add(value); }
  void add(const std::string& text) { bytes_.add(std::string_view(text)); }
  void add(Duration value) { bytes_.add(std::int64_t{value.count()}); }
  void add(const std::optional<std::uint32_t>& value) { add(value.value_or(0)); }
  void add(const Vec2& vector) { bytes_.add(vector); }
  void add(const std::optional<Vec2>& place_m) { add(place_m.value_or(Vec2::Zero())); }
  void add(Purposes purposes) { bytes_.add_byte(purposes.bits()); }
  template <class Tag>
  void add(StrongId<Tag> id) {
    add(id.value);
  }
  template <class Vector>
  void add(const Direction<Vector>& direction) {
    add(direction.vector);
  }
  template <class Index>
  void add(const TypeIndex<Index>& type) {
    add(std::uint32_t{type.index});
  }
  void add(const StreamSeed& own) {
    const auto& [stream, seed] = own;
    add(stream);
    add(seed);
  }
  void add(const ExemptPair& pair) {
    const auto& [one, other] = pair;
    add(one);
    add(other);
  }
  void add(const RecordedMessage& message) {
    const auto& [sender, receiver, sent, delay] = message;
    add(sender);
    add(receiver);
    add(sent);
    add(delay.has_value());
    add(delay.value_or(Duration::zero()));
  }
  void add(const std::shared_ptr<const RadioTrace>& trace) { add(*trace); }
  void add(const std::shared_ptr<const LogicalMap>& map) {
    ensure(map != nullptr, "a scenario has a map");
    bytes_.add(map->digest());
  }

  CanonicalBytes bytes_;
};

}  // namespace

std::uint64_t scenario_digest(const Scenario& scenario) { return ScenarioBytes().digest_of(scenario); }

}  // namespace fleetproof
