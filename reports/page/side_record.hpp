#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"

namespace fleetproof {

// What stands in a file beside a results file: the `record` of `File`, or in its `trouble` why it cannot be read. Both
// are empty if there is no such file. `parse` makes an optional record of the text; `again` says what to do about a
// file that is damaged.
template <class File, class Parse>
File side_record(const std::string& path, Parse parse, std::string_view again) {
  std::optional<std::string> text;
  try {
    text = read_text_file_if_there(path);
  } catch (const InputError& error) {
    return {{}, error.what()};
  }
  if (!text) return {};
  auto record = parse(*text);
  if (!record) return {{}, path + " is damaged, or of another version of fleetproof: " + std::string(again)};
  return {std::move(record), {}};
}

}  // namespace fleetproof
