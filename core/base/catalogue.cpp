#include "core/base/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fleetproof {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string_view> candidates) {
  // A word that is longer than every name is no mistyped name. To compare it with thousands of names would take hours.
  constexpr std::size_t kLongest = 200;
  if (word.size() > kLongest) return std::nullopt;
  // Numbers are all alike: none of them is another one, mistyped.
  if (std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; })) return std::nullopt;
  std::optional<std::string> nearest;
  // At least one letter is right.
  std::size_t smallest = std::min(std::max<std::size_t>(2, word.size() / 3) + 1, word.size());
  for (const auto candidate : candidates) {
    const auto differing = std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
    if (differing >= smallest) continue;  // at least this number of letters differs
    const auto distance = edit_distance(word, candidate);
    if (distance < smallest) {
      smallest = distance;
      nearest = std::string(candidate);
    }
  }
  return nearest;
}

std::string name_hint(std::string_view word, std::span<const std::string_view> candidates) {
  if (const auto nearest = nearest_name(word, candidates)) return fmt::format("; did you mean \"{}\"?", *nearest);
  return fmt::format("; known: {}", fmt::join(candidates, ", "));
}

}  // namespace fleetproof
