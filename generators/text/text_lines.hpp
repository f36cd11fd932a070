#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace fleetproof {

// Reads a text line by line, without a byte order mark and carriage returns. Requires: the text outlives the object.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  // The next line without its line end; none after the last line.
  std::optional<std::string_view> next();
  std::size_t number() const { return number_; }  // of the last line that was read, counted from 1

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace fleetproof
