#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof {

// The fields of one line of comma-separated values. A field in double quotes may contain commas, and quotes that are
// written twice. Throws InputError with `source` and line `number` if a quote is not closed, or for more than 100
// fields.
std::vector<std::string> csv_fields(std::string_view line, std::string_view source, std::size_t number);

// Whether a line is empty (only blanks and commas), or a comment that begins with #.
bool is_csv_remark(std::string_view line);

}  // namespace fleetproof
