#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// "routing", "storage", "charging", "parking": by bit.
inline constexpr auto kPurposeNames = kWordsOf<Purpose>;

// "storage parking"; empty for none.
std::string purposes_text(Purposes purposes);

// Of words with blanks between them; none if one of them is no purpose.
std::optional<Purposes> purposes_of_text(std::string_view words);

// A word that a user gave, in any script: the name of a location type, operation, action or symbol.
struct PurposeWord {
  std::string word;
  Purposes purposes;
};
using PurposeWords = std::vector<PurposeWord>;

// "PACK=storage,Dock 7=storage parking,Fire door=routing". Throws InputError that begins with `place`.
PurposeWords purpose_words_of(std::string_view text, const std::string& place);

// One of them: `purposes` is "storage parking".
PurposeWord purpose_word(std::string_view word, std::string_view purposes, const std::string& place);

// What these words say about `text`, which must be one of them; letters A to Z and a to z are the same.
std::optional<Purposes> said_of(const PurposeWords& words, std::string_view text);

}  // namespace fleetproof
