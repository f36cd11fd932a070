#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "core/base/sim_time.hpp"
#include "core/base/words.hpp"
#include "core/scenario/lenient.hpp"

namespace fleetproof {

// Who may set a field.
enum class FieldHome : std::uint8_t {
  Both,          // scenario files and campaign files
  ScenarioOnly,  // a campaign draws it, or leaves it at its default
  Factor,        // a campaign sets it cell by cell, under [factors]
};

// One parameter of a struct. Every struct of parameters has one list of fields: a function visit_fields(setup, visit)
// that calls visit(field, value) for each. Readers, writers, the validator, digests and the tables that users read all
// go over these lists.
struct Field {
  std::string_view key;   // its unit is the end of the key: unit_of
  std::string_view text;  // one line of explanation
  Lenient lenient;
  double low = 0.0, high = 1.0;  // of a number
  bool above_low = false;        // `low` itself is refused
  bool below_high = false;       // `high` itself is refused
  std::string_view place = {};   // in scenario files, where it is not `key`: "drive/speed_mps" stands in a group
  FieldHome home = FieldHome::Both;
  bool needed = false;    // a file must give it
  bool left_out = false;  // neither written nor part of a digest: it has its default, or means nothing here
  bool is_later = false;  // added after digests were stored: a digest without it is as it was before
  bool is_seed = false;   // a file may give it as "0x" and hexadecimal digits

  constexpr std::string_view scenario_place() const { return place.empty() ? key : place; }
  constexpr Field named(std::string_view other) const { return with(&Field::key, other); }
  constexpr Field left_out_if(bool absent) const { return with(&Field::left_out, absent); }

 private:
  template <class Value, class Given>
  constexpr Field with(Value Field::*member, const Given& value) const {
    Field changed = *this;
    changed.*member = value;
    return changed;
  }
};

// For visit_fields(setup, visit), which is written once for a struct and for a const struct.
template <class Given, class Setup>
concept FieldsOf = std::same_as<std::remove_const_t<Given>, Setup>;

// "m/s" of "speed_mps"; empty for a share or a count.
std::string_view unit_of(std::string_view key);

// What was wrong with a field of a setup.
struct FieldFault {
  std::string key, sentence;
};

// What a file gives for a field, before it is known whether that suits. std::monostate: an array, a table or null.
using GivenValue = std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string>;

// As an error quotes it.
std::string text_of(const GivenValue& given);

// "expected a number from 0.001 to 100 m/s" and the like. Every error about a field's value ends in these words,
// whatever kind of file it is in.
std::string expected_number(const Field& field);
std::string expected_whole(const Field& field);
std::string expected_word(const GivenValue& given, std::span<const std::string_view> words);

// Empty if the value is within the field's bounds; else what was expected. Infinities and NaN are outside.
std::string fault_of(const Field& field, double value);
std::string fault_of(const Field& field, Duration value);  // bounds are seconds
inline std::string fault_of(const Field& field, std::uint32_t value) {
  return value >= field.low && value <= field.high ? std::string() : expected_whole(field);
}
inline std::string fault_of(const Field& field, std::uint64_t value) {
  const auto number = static_cast<double>(value);
  return field.is_seed || (number >= field.low && number <= field.high) ? std::string() : expected_whole(field);
}

// Sets `target` and returns an empty text; or leaves it as it is and returns what was expected instead. An integer that
// no double holds exactly is refused where a double is wanted.
std::string take(const Field& field, const GivenValue& given, double& target);
std::string take(const Field& field, const GivenValue& given, bool& target);
std::string take(const Field& field, const GivenValue& given, std::uint32_t& target);
std::string take(const Field& field, const GivenValue& given, std::uint64_t& target);
std::string take(const Field& field, const GivenValue& given, std::string& target);
std::string take(const Field& field, const GivenValue& given, Duration& target);  // given in seconds

template <HasWords Enum>
std::string take(const Field&, const GivenValue& given, Enum& target) {
  const auto* word = std::get_if<std::string>(&given);
  const auto value = word != nullptr ? value_of<Enum>(*word) : std::nullopt;
  if (!value) return expected_word(given, kWordsOf<Enum>);
  target = *value;
  return {};
}

// The types that `take` reads: plain values, as opposed to groups, lists and references.
template <class Value>
concept PlainValue =
    HasWords<Value> || std::same_as<Value, double> || std::same_as<Value, bool> || std::same_as<Value, std::uint32_t> ||
    std::same_as<Value, std::uint64_t> || std::same_as<Value, std::string> || std::same_as<Value, Duration>;
template <class Value>
concept NumberValue = std::same_as<Value, double> || std::same_as<Value, std::uint32_t> ||
    std::same_as<Value, std::uint64_t> || std::same_as<Value, Duration>;
// A plain value that may be absent.
template <class Value>
concept OptionalPlain = requires {
  typename Value::value_type;
}
&&std::same_as<Value, std::optional<typename Value::value_type>>&& PlainValue<typename Value::value_type>;

}  // namespace fleetproof
