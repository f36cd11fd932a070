#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario_fields.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

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

// The value at "key" or "group/key". Throws InputError if it is absent and needed.
std::optional<JsonReader> find_field(const JsonReader& object, const Field& field);

// The same for a time. Its key ends in "_s" or "_ns"; a file that has both is refused. `in_ns`: whether the key ended
// in "_ns".
struct FoundTime {
  JsonReader reader;
  bool in_ns = false;
};
std::optional<FoundTime> find_time(const JsonReader& object, const Field& field);

// A plain value: what `take` says of it, with its place.
template <PlainValue Value>
void read_value(const JsonReader& reader, const Field& field, Value& target);

// As `take` wants it.
GivenValue given_by(const JsonReader& reader);

template <PlainValue Value>
void read_value(const JsonReader& reader, const Field& field, Value& target) {
  if (const auto sentence = take(field, given_by(reader), target); !sentence.empty()) reader.refuse(sentence);
}

}  // namespace fleetproof
