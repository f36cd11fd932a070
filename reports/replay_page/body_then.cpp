#include "reports/replay_page/body_then.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/page/wording.hpp"

namespace fleetproof::web {
namespace {

// An agent says its word right before or right after its message.
constexpr std::int64_t kAtOnce_us = 1'000;
constexpr std::ptrdiff_t kMostWords = 4;

std::string doing(const Film& film, std::size_t body, Moment then) {
  const ActivityBar* found = nullptr;
  for (const ActivityBar& bar : film.activities) {
    if (bar.body == body && Moment{bar.begin_us, bar.begin_order} < then && then < Moment{bar.end_us, bar.end_order})
      found = &bar;
  }
  if (found == nullptr) return "idle";
  return fmt::format("{}{}, since {} s", found->kind, found->details.empty() ? "" : " " + found->details,
                     time_text(found->begin_us));
}

std::string saying(const Film& film, std::size_t body, Moment then) {
  const Declared* found = nullptr;
  for (const Declared& state : film.states) {
    if (state.body == body && Moment{state.at_us, state.order} < then) found = &state;
  }
  return found == nullptr || found->word.empty() ? "" : fmt::format("its agent said \"{}\"", found->word);
}

}  // namespace

std::string faults_under_way(const Film& film, std::size_t body, Moment then) {
  std::map<std::string, std::int64_t> since_us;
  for (const Happening& h : film.happenings) {
    if (!h.is_fault || h.body != body || !(Moment{h.at_us, h.order} < then)) continue;
    const std::string& fault = h.details.empty() ? h.what : h.details;
    if (h.what.ends_with(" over")) {
      since_us.erase(fault);
    } else {
      since_us.emplace(fault, h.at_us);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [fault, at_us] : since_us) texts.push_back(fmt::format("{} since {} s", fault, time_text(at_us)));
  return texts.empty() ? "" : joined(texts) + ", not over";
}

std::string changes_between(const Film& film, std::size_t body, Moment from, Moment to) {
  const bool moved = std::ranges::any_of(film.pieces, [&](const MotionPiece& piece) {
    return piece.body == body && piece.moving != Moving::Rests && piece.begin_us < to.at_us &&
           from.at_us < piece.end_us;
  });
  std::vector<std::string> words, faults;
  for (const Declared& state : film.states) {
    const bool counts = state.body == body && from.at_us <= state.at_us && state.at_us <= to.at_us + kAtOnce_us;
    if (counts && !state.word.empty())
      words.push_back(fmt::format("\"{}\" ({} s)", state.word, time_text(state.at_us)));
  }
  for (const Happening& h : film.happenings) {
    const bool counts = h.is_fault && h.body == body && from.at_us <= h.at_us && h.at_us <= to.at_us;
    if (counts)
      faults.push_back(
          fmt::format("{}{} ({} s)", h.what, h.details.empty() ? "" : ": " + h.details, time_text(h.at_us)));
  }
  std::string text = moved ? "it moved" : "it did not move";
  if (std::ssize(words) > kMostWords) words.erase(words.begin(), words.end() - kMostWords);
  if (!words.empty()) text += "; its agent said " + joined(words);
  return faults.empty() ? text : text + "; " + joined(faults);
}

std::optional<std::int64_t> stood_there_since(const Film& film, std::size_t body, std::int64_t at_us) {
  if (film.violations.empty()) return std::nullopt;
  const TooClose& first = film.violations.front();
  if (body != first.a && body != first.b) return std::nullopt;
  std::int64_t since_us = 0;
  for (const MotionPiece& piece : film.pieces) {
    const bool moves = piece.body == body && piece.moving != Moving::Rests && piece.begin_us < first.first_us;
    if (moves) since_us = std::max(since_us, piece.end_us);
  }
  return since_us < at_us ? std::optional(since_us) : std::nullopt;
}

std::string text_of_body_then(const Film& film, std::size_t body, Moment then) {
  std::string text = doing(film, body, then);
  for (const std::string& more : {saying(film, body, then), faults_under_way(film, body, then)}) {
    if (!more.empty()) text += "; " + more;
  }
  if (const auto since_us = stood_there_since(film, body, then.at_us)) {
    const TooClose& first = film.violations.front();
    text += fmt::format("; it stood where {} then met it, since {} s",
                        film.bodies[first.a == body ? first.b : first.a].name, time_text(*since_us));
  }
  return text;
}

}  // namespace fleetproof::web
