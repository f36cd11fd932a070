#include "generators/formats/opentcs_purposes.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/letter_case.hpp"

namespace fleetproof {
namespace {

struct KnownWord {
  std::string_view word;
  Purpose purpose;
};
// Beginnings of words, but for those of kWholeWords.
constexpr KnownWord kKnownWords[] = {
    {"charg", Purpose::Charging},   {"recharg", Purpose::Charging}, {"load", Purpose::Storage},
    {"unload", Purpose::Storage},   {"offload", Purpose::Storage},  {"reload", Purpose::Storage},
    {"transfer", Purpose::Storage}, {"storage", Purpose::Storage},  {"store", Purpose::Storage},
    {"pick", Purpose::Storage},     {"drop", Purpose::Storage},     {"deliver", Purpose::Storage},
    {"fetch", Purpose::Storage},    {"jacking", Purpose::Storage},  {"park", Purpose::Parking},
};
// A package or a worker says nothing.
constexpr std::string_view kWholeWords[] = {"pack", "packing", "work", "working", "workstation", "workplace"};

bool names_storage(const std::string& said) { return std::ranges::find(kWholeWords, said) != std::end(kWholeWords); }

// "Load cargo", "LOAD_CARGO", "load:2", "LoadCargo" and "AGVLoad": in small letters; digits are words, too. All else
// parts words.
std::vector<std::string> words_in(std::string_view text) {
  enum class Kind : std::uint8_t { Other, Small, Large, Digit };
  const auto kind_of = [](char c) {
    return is_small(c) ? Kind::Small : is_capital(c) ? Kind::Large : c >= '0' && c <= '9' ? Kind::Digit : Kind::Other;
  };
  std::vector<std::string> words(1);
  Kind before = Kind::Other;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const Kind kind = kind_of(text[i]), after = i + 1 < text.size() ? kind_of(text[i + 1]) : Kind::Other;
    const bool hump = kind == Kind::Large && (before == Kind::Small || (before == Kind::Large && after == Kind::Small));
    const bool goes_on = kind == before || (before == Kind::Large && kind == Kind::Small);
    if (hump || !goes_on) words.emplace_back();
    if (kind != Kind::Other) words.back() += to_small(text[i]);
    before = kind;
  }
  std::erase(words, "");
  return words;
}

std::optional<Purposes> known_in(std::string_view text) {
  std::optional<Purposes> purposes;
  bool denied = false;  // "no parking"
  for (const std::string& said : words_in(text)) {
    for (const auto& [word, purpose] : kKnownWords) {
      if (!denied && said.starts_with(word)) purposes = purposes.value_or(Purpose::Routing) | purpose;
    }
    if (!denied && names_storage(said)) purposes = purposes.value_or(Purpose::Routing) | Purpose::Storage;
    denied = said == "no" || said == "not" || said == "non" || said == "without";
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
  const auto of_the_whole = either(own.said_of(words.name), own.said_of(words.symbol));
  std::optional<Purposes> by_user, by_operations;
  for (const auto& operation : words.operations) {
    const auto said = own.said_of(operation);
    by_user = either(by_user, said);
    by_operations = either(by_operations, said ? said : known_in(operation));
  }
  if (of_the_whole) return {*either(of_the_whole, by_user), "user"};
  if (by_user) return {*by_operations, "user"};
  const auto by_name = known_in(words.name), by_symbol = known_in(words.symbol);
  if (by_operations) {
    const auto differs = [&](const auto& other) { return other && (*other | *by_operations) != *by_operations; };
    return {*by_operations, "operations", differs(by_name) ? "name" : differs(by_symbol) ? "symbol" : nullptr};
  }
  if (by_name) return {*by_name, "name"};
  if (by_symbol) return {*by_symbol, "symbol"};
  return {Purpose::Routing, nullptr};
}

LocationPurpose purpose_of_link(const LocationWords& type, const LocationWords& link, const PurposeWords& own) {
  const auto says = [](const LocationPurpose& purpose, std::string_view source) {
    return purpose.source != nullptr && purpose.source == source;
  };
  const auto of_link = purpose_of(link, own);
  const bool by_type = says(purpose_of(type, PurposeWords()), "operations");
  if (!by_type || says(of_link, "operations") || says(of_link, "user")) return of_link;
  return {Purpose::Routing, kNothingAllowed};
}

}  // namespace fleetproof
