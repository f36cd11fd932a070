#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/pose.hpp"

namespace fleetproof {

// Writes JSON in one fixed form. The indentation is two spaces; short containers stand on one line on request. A double
// is the shortest decimal that reads back as the same double. The same calls give the same bytes everywhere.
class JsonWriter {
 public:
  enum class Style : std::uint8_t { Spread, Line };

  void open_object(Style style = Style::Spread) { open('{', '}', style); }
  void open_array(Style style = Style::Spread) { open('[', ']', style); }
  void close();
  JsonWriter& key(std::string_view name);

  void value(double number);  // finite; -0 is written as 0
  void value(std::int64_t number);
  void value(std::uint64_t number);
  void value(bool flag);
  void value(std::string_view text);  // UTF-8
  void value(const char* text) { value(std::string_view(text)); }
  void value(const Vec2& vector);  // [x, y]

  // The text so far, with a final line break.
  std::string take();

 private:
  struct Level {
    char closing;
    Style style;
    bool empty = true;
  };

  void open(char opening, char closing, Style style);
  void separate();
  void new_line();
  void string(std::string_view text);

  std::string text_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

}  // namespace fleetproof
