#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/geometry/pose.hpp"

namespace fleetproof {

// A JSON text as a tree that remembers the line of every value, so that an error can point at it.
struct JsonValue {
  enum class Shape : std::uint8_t { Scalar, Array, Object };
  Shape shape = Shape::Scalar;
  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string> scalar = nullptr;
  std::vector<std::string> keys;  // Object: of the item with the same index
  std::vector<JsonValue> items;
  std::size_t line = 1;

  const JsonValue* find(std::string_view key) const;
};

// InputError with line and column where `text` is not JSON, repeats a key in an object or nests deeper than 32 levels.
JsonValue parse_json(std::string_view text, std::string_view source);

// Reads one value of a tree and complains like a person: file and line, JSON pointer, value, remedy. Views: tree and
// source outlive it.
class JsonReader {
 public:
  JsonReader(const JsonValue& value, std::string_view source, std::string pointer = "")
      : value_(&value), source_(source), pointer_(std::move(pointer)) {}

  // The value is an object with no other keys than these.
  void expect_object(std::span<const std::string_view> keys) const;
  JsonReader at(std::string_view key) const;  // InputError if absent
  std::optional<JsonReader> find(std::string_view key) const;
  std::vector<JsonReader> items() const;  // of an array

  std::string text() const;
  double number() const;
  bool boolean() const;
  std::int64_t integer() const;
  std::uint64_t natural() const;
  Vec2 vector() const;  // [x, y]

  // Sets `target` if the key is there.
  void read(std::string_view key, double& target) const;
  void read(std::string_view key, bool& target) const;
  void read(std::string_view key, std::string& target) const;

  [[noreturn]] void refuse(std::string_view sentence) const;
  // Refuses the value at a pointer relative to this one, or the last value on the way to it. Where the pointer asks for
  // a duration "..._ns" and the file gives it as "..._s", that one is meant.
  [[noreturn]] void refuse_below(std::string_view pointer, std::string_view sentence) const;
  bool is_text() const { return std::holds_alternative<std::string>(value_->scalar); }
  const std::string& pointer() const { return pointer_; }
  std::string place() const;  // "file:line"

 private:
  const JsonValue* value_;
  std::string_view source_;
  std::string pointer_;
};

}  // namespace fleetproof
