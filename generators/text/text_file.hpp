#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/outside_text.hpp"
#include "core/base/regular_file.hpp"

namespace fleetproof {

// Throws InputError if a text that has to be UTF-8 begins as UTF-16 does, or has a byte that is none of UTF-8, as texts
// in Latin-1 have.
void require_utf8(std::string_view text, std::string_view source);
// The same of such a byte alone. `source` with the line of the byte is in the error.
void refuse_latin1(std::string_view text, std::string_view source);

// Writes `text` to `path`, whole or not at all. The text goes into a new file in the same folder and is brought to the
// disk. Then the new file takes the name at one instant. A link stays, and the file behind it is replaced. InputError,
// which ends in `remedy`, if the place is wrong; MachineError if the disk is full or fails. Either leaves what was
// there as it was.
void write_text_file(const std::string& path, std::string_view text, std::string_view remedy);

// Counted from 1; columns are bytes.
struct TextPosition {
  std::size_t line = 1, column = 1;
};

TextPosition position_in(std::string_view text, std::size_t offset);

// "file:line", the way compilers say it.
std::string at_line(std::string_view source, std::size_t line);

}  // namespace fleetproof
