#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace fleetproof {

// Goes through a text line by line; a byte order mark and carriage returns are left out. A view: the text outlives it.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  // The next line without its end; none after the last one.
  std::optional<std::string_view> next();
  std::size_t number() const { return number_; }  // of the line that came last, counted from 1

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace fleetproof
