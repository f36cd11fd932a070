#include "campaign/cli/film_glossary.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "core/agents/vocabulary.hpp"

namespace fleetproof::cli {
namespace {

// As whole words: "answers 3.0" has "answers", "forth" has no "for".
bool has_words(const std::string& text, std::string_view words) {
  for (auto at = text.find(words); at != text.npos; at = text.find(words, at + 1)) {
    const std::size_t end = at + words.size();
    if ((at == 0 || text[at - 1] == ' ') && (end == text.size() || text[end] == ' ')) return true;
  }
  return false;
}

}  // namespace

void add_glossary(web::Film& film) {
  std::set<std::string> said, contents;
  for (const web::Happening& h : film.happenings) {
    if (h.is_note) said.insert(h.details);
  }
  for (const web::Declared& state : film.states) said.insert(state.word);
  for (const web::Message& message : film.messages) contents.insert(message.content);
  for (const auto& [word, meaning] : agents::vocabulary()) {
    const bool occurs = said.contains(std::string(word)) ||
                        std::ranges::any_of(contents, [&](const std::string& c) { return has_words(c, word); });
    if (occurs) film.glossary.push_back({std::string(word), std::string(meaning)});
  }
}

}  // namespace fleetproof::cli
