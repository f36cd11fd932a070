#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::lockstep {

// One line of JSON, written from its beginning to its end. A number reads back as exactly the same bits.
class LineWriter {
 public:
  explicit LineWriter(std::string& line) : line_(line) { line_.clear(); }

  void open(char bracket) {
    comma();
    line_.push_back(bracket);
    is_first_ = true;
  }
  void close(char bracket) {
    line_.push_back(bracket);
    is_first_ = false;
  }
  // A member of an object; its value comes next.
  void key(std::string_view name) {
    string(name);
    line_.push_back(':');
    is_first_ = true;
  }
  template <class Value>
  void member(std::string_view name, const Value& what) {
    key(name);
    value(what);
  }

  void value(std::integral auto number) {
    comma();
    char digits[24];
    line_.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  }
  // JSON has no infinity, and many readers take -0 for the integer.
  void value(double number) {
    if (!std::isfinite(number)) return none();
    if (number == 0.0 && std::signbit(number)) return raw("-0.0");
    comma();
    char digits[32];
    line_.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  }
  void value(bool is_so) { raw(is_so ? "true" : "false"); }
  void value(std::string_view text) { string(text); }
  void value(const char* text) { string(text); }
  void value(const fp_pose& pose) { values({pose.x_m, pose.y_m, pose.heading_x, pose.heading_y}); }
  void values(std::initializer_list<double> numbers) {
    open('[');
    for (const double number : numbers) value(number);
    close(']');
  }
  void none() { raw("null"); }
  // FP_NONE is null.
  void id(std::string_view name, std::uint32_t number) {
    key(name);
    if (number == FP_NONE) return none();
    value(number);
  }
  // 16 hexadecimal digits.
  void bits(std::string_view name, std::uint64_t word);
  // One character for each byte.
  void bytes(std::string_view name, const void* bytes, std::uint32_t size);

 private:
  void comma() {
    if (!is_first_) line_.push_back(',');
    is_first_ = false;
  }
  void raw(std::string_view word) {
    comma();
    line_ += word;
  }
  void string(std::string_view text);
  void escaped(unsigned char byte);

  std::string& line_;
  bool is_first_ = true;
};

}  // namespace fleetproof::lockstep
