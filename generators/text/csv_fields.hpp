#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof {

// The fields of one line of comma-separated values; fields in double quotes may hold commas, and quotes written twice.
// InputError at `source` and line `number` for a quote that is not closed, and for more than 100 fields.
std::vector<std::string> csv_fields(std::string_view line, std::string_view source, std::size_t number);

// Whether a line has nothing to say: blanks and commas only, or a comment that begins with #.
bool is_csv_remark(std::string_view line);

}  // namespace fleetproof
