#pragma once

#include <array>
#include <memory>
#include <optional>
#include <set>
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
  std::string place{};  // where the user gave it
};

// The words of a user. They remember the texts of files with which they were compared, so that a word that stands in no
// file is noticed. Threads: copies share what they remember; one thread reads all files.
class PurposeWords {
 public:
  // Throws InputError at the place of the word if the list has it already.
  void add(PurposeWord word);

  // What these words say about `text`, which must be one of them; letters A to Z and a to z are the same.
  std::optional<Purposes> said_of(std::string_view text) const;

  // The words that were no text so far. The sentence says which texts there were.
  struct Unheard {
    std::string place, sentence;
  };
  std::vector<Unheard> unheard() const;

 private:
  std::vector<PurposeWord> words_;
  std::shared_ptr<std::set<std::string>> texts_ = std::make_shared<std::set<std::string>>();
};

// "PACK=storage,Dock 7=storage parking,Fire door=routing". Throws InputError that begins with `place`.
PurposeWords purpose_words_of(std::string_view text, const std::string& place);

// One of them: `purposes` is "storage parking".
PurposeWord purpose_word(std::string_view word, std::string_view purposes, const std::string& place);

}  // namespace fleetproof
