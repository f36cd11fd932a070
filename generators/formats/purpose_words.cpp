#include "generators/formats/purpose_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/letter_case.hpp"
#include "core/base/outside_text.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kTextsListed = 12;  // texts of files in a sentence

}  // namespace

std::string purposes_text(Purposes purposes) {
  std::string text;
  for (std::size_t bit = 0; bit < kPurposeNames.size(); ++bit) {
    if (!purposes.has(static_cast<Purpose>(1 << bit))) continue;
    if (!text.empty()) text += ' ';
    text += kPurposeNames[bit];
  }
  return text;
}

std::optional<Purposes> purposes_of_text(std::string_view words) {
  auto purposes = Purposes::from_bits(0);
  while (true) {
    words.remove_prefix(std::min(words.find_first_not_of(' '), words.size()));
    if (words.empty()) return purposes;
    const auto word = words.substr(0, words.find(' '));
    const auto found = std::ranges::find(kPurposeNames, word);
    if (found == kPurposeNames.end()) return std::nullopt;
    purposes = purposes | Purposes::from_bits(static_cast<std::uint8_t>(1U << (found - kPurposeNames.begin())));
    words.remove_prefix(word.size());
  }
}

PurposeWord purpose_word(std::string_view word, std::string_view purposes, const std::string& place) {
  const auto known = purposes_of_text(purposes);
  if (!known || known->bits() == 0) {
    throw InputError(place, fmt::format("{} is said to be for {}; expected routing, storage, charging or parking{}",
                                        in_quotes(word), in_quotes(purposes), name_hint(purposes, kPurposeNames)));
  }
  return {std::string(word), *known | Purpose::Routing, place};
}

PurposeWords purpose_words_of(std::string_view text, const std::string& place) {
  PurposeWords words;
  while (!text.empty()) {
    // A word may hold commas, or signs: "Dock, left=storage", "op=2=storage".
    const auto pair = text.substr(0, text.starts_with(',') ? 0 : text.find(',', std::min(text.find('='), text.size())));
    const auto sign = pair.rfind('=');
    if (sign == std::string_view::npos || sign == 0) {
      throw InputError(
          place, fmt::format("{} is not a word with its purpose; expected \"PACK=storage,...\"", in_quotes(pair)));
    }
    words.add(purpose_word(pair.substr(0, sign), pair.substr(sign + 1), place));
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
  }
  return words;
}

void PurposeWords::add(PurposeWord word) {
  for (const auto& other : words_) {
    if (same_letters(other.word, word.word))
      throw InputError(word.place, fmt::format("{} is there twice; remove one of them", in_quotes(word.word)));
  }
  words_.push_back(std::move(word));
}

std::optional<Purposes> PurposeWords::said_of(std::string_view text) const {
  if (words_.empty() || text.empty()) return std::nullopt;
  texts_->emplace(text);
  const auto found =
      std::ranges::find_if(words_, [&](const PurposeWord& word) { return same_letters(word.word, text); });
  return found == words_.end() ? std::nullopt : std::optional(found->purposes);
}

std::vector<PurposeWords::Unheard> PurposeWords::unheard() const {
  const std::vector<std::string> texts(texts_->begin(), texts_->end());
  const std::vector<std::string_view> known(texts.begin(), texts.end());
  std::vector<Unheard> found;
  for (const auto& [word, purposes, place] : words_) {
    if (std::ranges::any_of(texts, [&](const std::string& text) { return same_letters(text, word); })) continue;
    const auto nearest = nearest_name(word, known);
    found.push_back({place, fmt::format("{} is no word of the layouts{}", in_quotes(word),
                                        nearest         ? "; did you mean " + in_quotes(*nearest) + "?"
                                        : texts.empty() ? ", which have none; remove it"
                                                        : "; their words: " + name_list(texts, kTextsListed))});
  }
  return found;
}

}  // namespace fleetproof
