#include "generators/formats/purpose_words.hpp"

#include <algorithm>

namespace fleetproof {

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

}  // namespace fleetproof
