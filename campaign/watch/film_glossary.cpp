#include "campaign/watch/film_glossary.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "core/agents/vocabulary.hpp"
#include "reports/web/message_numbers.hpp"

namespace fleetproof {

void add_glossary(web::Film& film) {
  std::set<std::string> said, contents;
  for (const web::Happening& h : film.happenings) {
    if (h.is_note) said.insert(h.details);
  }
  for (const web::Declared& state : film.states) said.insert(state.word);
  for (const web::Message& message : film.messages) contents.insert(message.content);
  for (const auto& [word, meaning] : agents::vocabulary()) {
    const bool occurs = said.contains(std::string(word)) || std::ranges::any_of(contents, [&](const std::string& c) {
                          return web::after_word(c, word).has_value();
                        });
    if (occurs) film.glossary.push_back({std::string(word), std::string(meaning)});
  }
}

}  // namespace fleetproof
