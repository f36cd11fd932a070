#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/scenario/layout.hpp"

namespace fleetproof::fuzz {

// Throws std::logic_error with the sentence unless it holds: the reader, or its writer, is at fault.
void require(bool holds, const std::string& sentence);

// A message or warning can be printed, has an end, and begins with the name of the file.
void require_sentence(std::string_view sentence, std::string_view file);

// The result of `read`; none if it refused its bytes with a correct message.
template <class Read>
auto accepted(Read read, std::string_view file) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const InputError& error) {
    require_sentence(error.what(), file);
    return std::nullopt;
  }
}

// A layout that a reader accepted has no fault and can be driven on.
void require_sound(const Layout& layout, const std::vector<std::string>& warnings, std::string_view file);

// It comes back from every format in which layouts are written.
void require_same_when_written(const Layout& layout);

}  // namespace fleetproof::fuzz
