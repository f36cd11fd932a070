#include "reports/attempts/attempt_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostTold = 3;

// Something of this name is there, but it is a folder, or a file without the permission.
bool is_unreadable(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) &&
         !(std::filesystem::is_regular_file(path, ignored) && std::ifstream(path).is_open());
}

// Software that does not always do the same may be run until its verdict is the right one.
bool had_other_luck(const Attempt& attempt, const Attempt& own) {
  return attempt.id != own.id && !attempt.ended_utc.empty() && !own.ended_utc.empty() && attempt.runs == own.runs &&
         attempt.verdict != own.verdict;
}

std::string told(const Attempt& attempt) {
  const std::string state = attempt.ended_utc.empty() ? "aborted or still under way" : attempt.verdict;
  return fmt::format("seed {}, plan digest {}: {}{}", attempt.seed, hex_text(attempt.plan_hash), printable(state, 40),
                     attempt.replaced ? ", overwritten" : "");
}

}  // namespace

AttemptHistory attempt_history(const AttemptLedger& ledger, const CampaignRecord& campaign) {
  AttemptHistory history;
  const auto& attempts = ledger.attempts();
  if (is_unreadable(ledger.path())) history.ledger = ledger.path();
  if (attempts.empty()) return history;
  history.ledger = ledger.path();
  history.broken_lines = ledger.broken_lines();
  for (const Attempt& attempt : attempts) {
    if (history.since_utc.empty()) history.since_utc = attempt.begun_utc;
  }
  const Attempt wanted = attempt_of(campaign);
  const auto own = std::ranges::find_if(attempts.rbegin(), attempts.rend(), [&](const Attempt& attempt) {
    return attempt.worlds == wanted.worlds && attempt.software == wanted.software;
  });
  if (own == attempts.rend()) return history;
  history.own = *own;
  for (auto attempt = attempts.begin(); attempt != attempts.end(); ++attempt) {
    const bool same_release = attempt->release == own->release, same_worlds = attempt->worlds == own->worlds;
    if (same_release && same_worlds && had_other_luck(*attempt, *own)) history.others.push_back(*attempt);
    if (same_worlds == same_release) continue;
    if (!same_release) {
      if (attempt < own.base() - 1) history.same_worlds.push_back(*attempt);
      continue;
    }
    std::erase_if(history.others, [&](const Attempt& other) { return other.worlds == attempt->worlds; });
    history.others.push_back(*attempt);
  }
  return history;
}

std::string attempts_sentence(const AttemptHistory& history, double risk) {
  if (is_unreadable(history.ledger))
    return fmt::format("Earlier attempts unknown: the ledger {} cannot be read.", printable(history.ledger));
  if (history.ledger.empty() || !history.own)
    return "Earlier attempts unknown: no ledger of attempts tells of this campaign.";
  const auto& others = history.others;
  std::string text;
  if (others.empty()) {
    text = "Earlier attempts unknown: the ledger names no other attempt for this release" +
           (history.since_utc.empty() ? "." : fmt::format(", and begins on {}.", history.since_utc));
  } else {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < std::min(kMostTold, others.size()); ++i)
      words.push_back(told(others[others.size() - 1 - i]));
    if (others.size() > kMostTold) words.push_back(fmt::format("{} more", others.size() - kMostTold));
    const double all = std::min(1.0, risk * static_cast<double>(others.size() + 1));
    text = fmt::format(
        "The ledger names {} attempts for this release: this one and {} ({}). The bounds hold for one attempt and are "
        "not adjusted for their number: a limit that is not met is demonstrated by one attempt in at most {} of cases, "
        "by one of {} in up to {}.",
        others.size() + 1, count_text(others.size(), "other"), joined(words, "; "), percent(risk), others.size() + 1,
        percent(all));
  }
  if (!history.same_worlds.empty()) {
    text += fmt::format(
        " Another release was tried in the same worlds before ({}): failures that were mended since do not count as "
        "evidence. seed = \"fresh\" gives each release worlds of its own.",
        history.same_worlds.back().begun_utc.empty() ? "date unknown" : history.same_worlds.back().begun_utc);
  }
  if (history.broken_lines > 0)
    text += fmt::format(" {} of the ledger cannot be read.", count_text(history.broken_lines, "line"));
  return text;
}

}  // namespace fleetproof
