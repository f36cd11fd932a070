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

// A JSON text as a tree. It stores the line of every value, so that an error can name it.
struct JsonValue {
  enum class Shape : std::uint8_t { Scalar, Array, Object };
  Shape shape = Shape::Scalar;
  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string> scalar = nullptr;
  std::vector<std::string> keys;  // Object: of the item with the same index
  std::vector<JsonValue> items;
  std::size_t line = 1;

  const JsonValue* find(std::string_view key) const;
};

// Throws InputError with the line if `text` is not JSON, repeats a key in an object, has more than 32 levels, or has an
// object with more than 1000 keys.
JsonValue parse_json(std::string_view text, std::string_view source);

// Reads one value of a tree. Its errors contain file and line, JSON pointer, value and remedy.
// Requires: tree and source outlive the reader.
class JsonReader {
 public:
  JsonReader(const JsonValue& value, std::string_view source, std::string pointer = "")
      : value_(&value), source_(source), pointer_(std::move(pointer)) {}

  // Throws InputError unless the value is an object with these keys only.
  void expect_object(std::span<const std::string_view> keys) const;
  JsonReader at(std::string_view key) const;  // throws InputError if the key is absent
  std::optional<JsonReader> find(std::string_view key) const;
  std::vector<JsonReader> items() const;  // of an array

  std::string text() const;
  double number() const;
  bool boolean() const;
  std::int64_t integer() const;
  std::uint64_t natural() const;
  Vec2 vector() const;   // [x, y]
  Vec2 heading() const;  // a direction [x, y], as a unit vector

  // Sets `target` if the key is there.
  void read(std::string_view key, double& target) const;
  void read(std::string_view key, bool& target) const;
  void read(std::string_view key, std::string& target) const;

  [[noreturn]] void refuse(std::string_view sentence) const;
  // Refuses the value at a pointer relative to this value, or the last value on the way to it. If the pointer names a
  // duration "..._ns" and the file has "..._s", the error names "..._s".
  [[noreturn]] void refuse_below(std::string_view pointer, std::string_view sentence) const;
  bool is_text() const { return std::holds_alternative<std::string>(value_->scalar); }
  const JsonValue& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  std::string place() const;  // "file:line"

 private:
  const JsonValue* value_;
  std::string_view source_;
  std::string pointer_;
};

}  // namespace fleetproof
