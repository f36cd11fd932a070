#include "generators/scenario_file/field_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fleetproof {
namespace {

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

}  // namespace

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

GivenValue given_by(const JsonReader& reader) {
  if (reader.value().shape != JsonValue::Shape::Scalar) return std::monostate{};
  return std::visit([](const auto& value) { return as_given(value); }, reader.value().scalar);
}

}  // namespace fleetproof
