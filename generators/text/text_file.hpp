#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fleetproof {

// The whole file. Throws InputError if it cannot be read or is larger than 64 MiB.
std::string read_text_file(const std::string& path);

// Counted from 1; columns are bytes.
struct TextPosition {
  std::size_t line = 1, column = 1;
};

TextPosition position_in(std::string_view text, std::size_t offset);

// "file:line", as compilers write it.
std::string at_line(std::string_view source, std::size_t line);

// A value as an error quotes it: in double quotes, printable ASCII only, cut after 60 characters.
std::string in_quotes(std::string_view value);

// Names from files go into JSON, pages and databases. They must be UTF-8 without control characters.
bool is_plain_utf8(std::string_view text);

}  // namespace fleetproof
