#include "core/scenario/field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/catalogue.hpp"

namespace fleetproof {
namespace {

// The longest ending that fits counts.
constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
    {"_radps2", "rad/s2"},
    {"_radps", "rad/s"},
    {"_mps2", "m/s2"},
    {"_mps", "m/s"},
    {"_per_m", "per m"},
    {"_per_s", "per s"},
    {"_per_byte_s", "s per byte"},
    {"_per_agv_hour", "per AGV and hour"},
    {"_per_hour", "per hour"},
    {"_per_transport", "per transport"},
    {"_ppm", "ppm"},
    {"_m", "m"},
    {"_s", "s"},
};

// A double where a whole number is wanted.
std::string expected_integer(const Field& field, const GivenValue& given) {
  return expected_whole(field) +
         (std::holds_alternative<double>(given) ? ", written without a point or an exponent" : "");
}

// "from 0 to 1", "above 0, at most 10 s", "from 0 to below 1", "above 0.5, below 1".
std::string bounds_of(const Field& field) {
  const auto unit = unit_of(field.key);
  return fmt::format(
      "{} {}{} {}{}{}", field.above_low ? "above" : "from", field.low,
      field.above_low ? (field.below_high ? ", below" : ", at most") : (field.below_high ? " to below" : " to"),
      field.high, unit.empty() ? "" : " ", unit);
}

bool is_within(const Field& field, auto value, auto low, auto high) {
  return (field.above_low ? value > low : value >= low) && (field.below_high ? value < high : value <= high);
}

std::string shown(const std::string& value) {
  constexpr std::size_t kLongest = 60;
  std::string text = "\"";
  for (const char c : value.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (value.size() > kLongest ? "...\"" : "\"");
}

std::optional<std::uint64_t> hexadecimal(const std::string& text) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  if (text.size() <= 2 || !text.starts_with("0x")) return std::nullopt;
  const auto read = std::from_chars(text.data() + 2, end, number, 16);
  return read.ec == std::errc() && read.ptr == end ? std::optional(number) : std::nullopt;
}

// Of a whole number, whatever its sign and size.
std::optional<std::uint64_t> natural(const GivenValue& given) {
  if (const auto* number = std::get_if<std::uint64_t>(&given)) return *number;
  const auto* number = std::get_if<std::int64_t>(&given);
  return number != nullptr && *number >= 0 ? std::optional(static_cast<std::uint64_t>(*number)) : std::nullopt;
}

// Of a number that a double holds exactly.
std::optional<double> exact_double(const GivenValue& given) {
  constexpr double kBeyond = 0x1p63;  // no integer of a file lies beyond that can be compared as an integer
  if (const auto* number = std::get_if<double>(&given)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&given)) {
    const auto value = static_cast<double>(*number);
    return value < kBeyond && static_cast<std::int64_t>(value) == *number ? std::optional(value) : std::nullopt;
  }
  const auto* number = std::get_if<std::uint64_t>(&given);
  if (number == nullptr) return std::nullopt;
  const auto value = static_cast<double>(*number);
  return value < 2.0 * kBeyond && static_cast<std::uint64_t>(value) == *number ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string_view unit_of(std::string_view key) {
  for (const auto& [ending, unit] : kUnits) {
    if (key.ends_with(ending) && (unit != "s" || !key.ends_with("_per_s"))) return unit;
  }
  return {};
}

std::string text_of(const GivenValue& given) {
  struct Text {
    std::string operator()(std::monostate) const { return "this"; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(const std::string& value) const { return shown(value); }
    std::string operator()(double value) const { return fmt::format("{}", value); }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(std::uint64_t value) const { return fmt::format("{}", value); }
  };
  return std::visit(Text{}, given);
}

std::string expected_number(const Field& field) { return "expected a number " + bounds_of(field); }

std::string expected_whole(const Field& field) {
  return field.is_seed ? "expected a whole number from 0 to 2^64 - 1, or \"0x\" and up to 16 hexadecimal digits"
                       : "expected a whole number " + bounds_of(field);
}

std::string expected_word(const GivenValue& given, std::span<const std::string_view> words) {
  std::string sentence = fmt::format("expected one of \"{}\"", fmt::join(words, "\", \""));
  const auto* word = std::get_if<std::string>(&given);
  const auto nearest = word != nullptr ? nearest_name(*word, words) : std::nullopt;
  return nearest ? fmt::format("{}; did you mean \"{}\"?", sentence, *nearest) : sentence;
}

std::string fault_of(const Field& field, double value) {
  return is_within(field, value, field.low, field.high) ? std::string() : expected_number(field);
}

std::string fault_of(const Field& field, Duration value) {
  return is_within(field, value, seconds(field.low), seconds(field.high)) ? std::string() : expected_number(field);
}

std::string take(const Field& field, const GivenValue& given, double& target) {
  const auto value = exact_double(given);
  if (!value) return expected_number(field);
  if (auto fault = fault_of(field, *value); !fault.empty()) return fault;
  target = *value;
  return {};
}

std::string take(const Field&, const GivenValue& given, bool& target) {
  const auto* value = std::get_if<bool>(&given);
  if (value == nullptr) return "expected true or false";
  target = *value;
  return {};
}

std::string take(const Field& field, const GivenValue& given, std::uint32_t& target) {
  const auto value = natural(given);
  if (!value || *value > std::numeric_limits<std::uint32_t>::max()) return expected_integer(field, given);
  if (auto fault = fault_of(field, static_cast<std::uint32_t>(*value)); !fault.empty()) return fault;
  target = static_cast<std::uint32_t>(*value);
  return {};
}

std::string take(const Field& field, const GivenValue& given, std::uint64_t& target) {
  const auto* text = std::get_if<std::string>(&given);
  const auto value = field.is_seed && text != nullptr ? hexadecimal(*text) : natural(given);
  if (!value) return expected_integer(field, given);
  if (auto fault = fault_of(field, *value); !fault.empty()) return fault;
  target = *value;
  return {};
}

std::string take(const Field&, const GivenValue& given, std::string& target) {
  const auto* text = std::get_if<std::string>(&given);
  if (text == nullptr) return "expected a text in double quotes";
  target = *text;
  return {};
}

std::string take(const Field& field, const GivenValue& given, Duration& target) {
  const auto value = exact_double(given);
  if (!value) return expected_number(field);
  if (auto fault = fault_of(field, *value); !fault.empty()) return fault;
  // A time above 0 that rounds to no nanosecond would be none.
  const Duration rounded = seconds(*value);
  if (auto fault = fault_of(field, rounded); !fault.empty()) return fault;
  target = rounded;
  return {};
}

}  // namespace fleetproof
