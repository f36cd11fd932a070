#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/outside_text.hpp"

namespace fleetproof {

// The whole file. InputError if it cannot be read or is larger than 64 MiB.
std::string read_text_file(const std::string& path);

// Counted from 1; columns are bytes.
struct TextPosition {
  std::size_t line = 1, column = 1;
};

TextPosition position_in(std::string_view text, std::size_t offset);

// "file:line", the way compilers say it.
std::string at_line(std::string_view source, std::size_t line);

}  // namespace fleetproof
