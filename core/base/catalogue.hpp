#pragma once

#include <algorithm>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof {

// One line of a catalogue: the name that a user types, what the thing does, and how to make one.
template <class Factory>
struct Entry {
  std::string_view name;
  std::string_view description;
  Factory make;

  friend void PrintTo(const Entry& entry, std::ostream* out) { *out << entry.name; }
};

template <class Factory>
const Entry<Factory>* find_entry(std::span<const Entry<Factory>> entries, std::string_view name) {
  const auto found = std::ranges::find(entries, name, &Entry<Factory>::name);
  return found == entries.end() ? nullptr : &*found;
}

// The candidate nearest to `word` by edit distance, if it is near enough to be a typing error.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string_view> candidates);

// "; did you mean "x"?" or "; known: a, b, c": the end of an error about an unknown name.
std::string name_hint(std::string_view word, std::span<const std::string_view> candidates);

template <class Factory>
std::vector<std::string_view> names_of(std::span<const Entry<Factory>> entries) {
  std::vector<std::string_view> names;
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

}  // namespace fleetproof
