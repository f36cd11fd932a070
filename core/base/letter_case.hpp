#pragma once

#include <algorithm>
#include <string_view>

namespace fleetproof {

// The letters A to Z and a to z, in no locale; all other bytes stay as they are.
constexpr bool is_small(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
constexpr char to_small(char c) { return is_capital(c) ? static_cast<char>(c - 'A' + 'a') : c; }

// Whether two texts are the same, but for capitals.
constexpr bool same_letters(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, to_small, to_small);
}

}  // namespace fleetproof
