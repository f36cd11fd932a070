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

bool says_purpose(const std::string& operation, const PurposeWords& own) {
  return own.said_of(operation) || known_in(operation);
}

LocationPurpose purpose_of(const LocationWords& words, const PurposeWords& own) {
  std::optional<Purposes> by_user = either(own.said_of(words.name), own.said_of(words.symbol)), by_operations;
  for (const auto& operation : words.operations) {
    by_user = either(by_user, own.said_of(operation));
    by_operations = either(by_operations, known_in(operation));
  }
  if (by_user) return {*by_user, "user"};
  const auto by_name = known_in(words.name), by_symbol = known_in(words.symbol);
  if (by_operations) {
    const auto differs = [&](const auto& other) { return other && (*other | *by_operations) != *by_operations; };
    return {*by_operations, "operations", differs(by_name) ? "name" : differs(by_symbol) ? "symbol" : nullptr};
  }
  if (by_name) return {*by_name, "name"};
  if (by_symbol) return {*by_symbol, "symbol"};
  return {Purpose::Routing, nullptr};
}

}  // namespace fleetproof
