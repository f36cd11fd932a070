#include "generators/formats/opentcs_purposes.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

namespace fleetproof {
namespace {

struct KnownWord {
  std::string_view word;
  Purpose purpose;
};
constexpr KnownWord kKnownWords[] = {
    {"charg", Purpose::Charging},  {"load", Purpose::Storage},    {"transfer", Purpose::Storage},
    {"storage", Purpose::Storage}, {"store", Purpose::Storage},   {"pick", Purpose::Storage},
    {"drop", Purpose::Storage},    {"deliver", Purpose::Storage}, {"fetch", Purpose::Storage},
    {"jacking", Purpose::Storage}, {"pack", Purpose::Storage},    {"work", Purpose::Storage},
    {"park", Purpose::Parking},
};

std::optional<Purposes> known_in(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  std::optional<Purposes> purposes;
  for (const auto& [word, purpose] : kKnownWords) {
    if (text.find(word) != std::string::npos) purposes = purposes.value_or(Purpose::Routing) | purpose;
  }
  return purposes;
}

std::optional<Purposes> either(std::optional<Purposes> a, std::optional<Purposes> b) {
  return a && b ? *a | *b : a ? a : b;
}

}  // namespace

LocationPurpose purpose_of(const LocationWords& words, const PurposeWords& own) {
  std::optional<Purposes> by_user = either(said_of(own, words.name), said_of(own, words.symbol)), by_operations;
  for (const auto& operation : words.operations) {
    by_user = either(by_user, said_of(own, operation));
    by_operations = either(by_operations, known_in(operation));
  }
  if (by_user) return {*by_user, "user"};
  if (by_operations) return {*by_operations, "operations"};
  if (const auto purposes = known_in(words.name)) return {*purposes, "name"};
  if (const auto purposes = known_in(words.symbol)) return {*purposes, "symbol"};
  return {Purpose::Routing, nullptr};
}

}  // namespace fleetproof
