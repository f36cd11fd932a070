#include "core/bridges/lockstep/command.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

namespace fleetproof::lockstep {
namespace {

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::optional<std::string> word;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_space = c == ' ' || c == '\t' || c == '\n';
    if (quote == 0 && is_space) {
      if (word) words.push_back(*std::exchange(word, std::nullopt));
      continue;
    }
    if (!word) word.emplace();
    if (c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == '\\' && quote != '\'' && i + 1 < text.size()) {
      word->push_back(text[++i]);
    } else {
      word->push_back(c);
    }
  }
  if (quote != 0) throw std::invalid_argument("has a quote that does not end");
  if (word) words.push_back(*word);
  if (words.empty()) throw std::invalid_argument("names no program");
  return words;
}

std::string replaced(std::string word, std::string_view place, const std::string& value) {
  for (auto at = word.find(place); at != std::string::npos; at = word.find(place, at + value.size()))
    word.replace(at, place.size(), value);
  return word;
}

constexpr std::array<std::string_view, 3> kPlaces{"{agv}", "{name}", "{seed}"};

// A word in braces that is misspelt would reach the program as it stands.
void require_known_places(const std::string& word) {
  for (auto at = word.find('{'); at != std::string::npos; at = word.find('{', at + 1)) {
    const auto end = word.find('}', at);
    if (end == std::string::npos) return;
    const std::string_view place = std::string_view(word).substr(at, end - at + 1);
    const bool is_name = place.size() > 2 && std::ranges::all_of(place.substr(1, place.size() - 2), [](char c) {
                           return (c >= 'a' && c <= 'z') || c == '_';
                         });
    if (is_name && std::ranges::find(kPlaces, place) == kPlaces.end())
      throw std::invalid_argument("has " + std::string(place) + ", which means nothing; {agv}, {name} and {seed} do");
  }
}

}  // namespace

Command::Command(std::string_view text) : words_(words_of(text)) {
  for (const std::string& word : words_) require_known_places(word);
}

bool Command::has(std::string_view place) const {
  return std::ranges::any_of(words_, [&](const std::string& word) { return word.find(place) != std::string::npos; });
}

std::vector<std::string> Command::words_for(const Recipient& recipient) const {
  std::vector<std::string> words = words_;
  for (std::string& word : words) {
    word = replaced(std::move(word), kPlaces[0], recipient.agv);
    word = replaced(std::move(word), kPlaces[2], recipient.seed);
    word = replaced(std::move(word), kPlaces[1], recipient.name);  // last: a name may hold anything
  }
  return words;
}

std::string command_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text.push_back(' ');
    const bool is_plain = !word.empty() && word.find_first_of(" \t\n'\"\\") == std::string::npos;
    text += is_plain ? word : "'" + replaced(word, "'", "'\\''") + "'";
  }
  return text;
}

}  // namespace fleetproof::lockstep
