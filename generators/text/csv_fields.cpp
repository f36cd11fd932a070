#include "generators/text/csv_fields.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostFields = 100;

}  // namespace

std::vector<std::string> csv_fields(std::string_view line, std::string_view source, std::size_t number) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[i++];
    } else if (c == '"' && (quoted || fields.back().empty())) {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      // Refused at once, because a long line of commas would fill the memory with empty fields.
      if (fields.size() == kMostFields)
        throw InputError(at_line(source, number), fmt::format("the line has more than {} fields", kMostFields));
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  if (quoted) throw InputError(at_line(source, number), "a double quote is not closed; close it on the same line");
  return fields;
}

bool is_csv_remark(std::string_view line) {
  return line.find_first_not_of(" ,\t") == std::string_view::npos || line.starts_with('#');
}

}  // namespace fleetproof
