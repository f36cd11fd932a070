#include "reports/replay_page/answers_in_short.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/page/wording.hpp"

namespace fleetproof::web {
namespace {

constexpr std::size_t kMostNamedInShort = 4;

std::string asked_text(const Film& film, const Setting& setting, const std::vector<std::size_t>& asked,
                       std::size_t others) {
  if (setting.ask.empty()) return {};
  const std::string whom = asked.size() == others ? "all" : names_text(film, asked);
  return fmt::format("Since {} s, {} had sent {}. ", time_text(setting.from_us), film.bodies[setting.body].name,
                     asked.empty() ? "no " + setting.ask : setting.ask + " to " + whom);
}

}  // namespace

std::string names_text(const Film& film, const std::vector<std::size_t>& bodies) {
  std::string text;
  for (std::size_t i = 0; i < std::min(bodies.size(), kMostNamedInShort); ++i)
    text += (i == 0 ? "" : ", ") + film.bodies[bodies[i]].name;
  return bodies.size() > kMostNamedInShort ? fmt::format("{} and {} more", text, bodies.size() - kMostNamedInShort)
                                           : text;
}

// Of messages to all nobody knows whom they ask: an AGV that is silent then may have nothing to say.
AnswersInShort answers_in_short(const Film& film, const Setting& setting, const std::vector<SenderAnswers>& others) {
  AnswersInShort brief;
  if (others.size() < 2) return brief;
  std::map<std::string, std::vector<std::size_t>> in_time;
  std::vector<std::size_t> asked, late, silent, unasked;
  for (const SenderAnswers& answers : others) {
    const bool was_asked = setting.ask.empty() || answers.was_asked != WasAsked::Not;
    if (was_asked) asked.push_back(answers.sender);
    if (answers.in_time) {
      in_time[answers.in_time->message->kind].push_back(answers.sender);
    } else if (was_asked) {
      (answers.has_answers ? late : silent).push_back(answers.sender);
      brief.owes = brief.owes || answers.has_answers || answers.was_asked == WasAsked::Alone;
    } else if (answers.has_answers) {
      unasked.push_back(answers.sender);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [kind, senders] : in_time)
    texts.push_back(fmt::format("{} from {}", kind, names_text(film, senders)));
  brief.text = asked_text(film, setting, asked, others.size()) +
               fmt::format("Answers in time: {}.", texts.empty() ? "none" : joined(texts, "; "));
  if (!late.empty()) brief.text += fmt::format(" Lost or late: {}.", names_text(film, late));
  if (!silent.empty()) brief.text += fmt::format(" No answer sent to it alone: {}.", names_text(film, silent));
  if (!unasked.empty())
    brief.text += fmt::format(" Lost or late, of those without a {}: {}.", setting.ask, names_text(film, unasked));
  return brief;
}

}  // namespace fleetproof::web
