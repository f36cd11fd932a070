#include "reports/attempts/attempt_history.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostTold = 3;

// Software that does not always do the same may be run until its verdict is the right one.
bool had_other_luck(const Attempt& attempt, const Attempt& own) {
  return attempt.id != own.id && !attempt.ended_utc.empty() && !own.ended_utc.empty() && attempt.runs == own.runs &&
         attempt.verdict != own.verdict;
}

// Where nobody noted the release, as in shards without their session logs, it may have been this one.
bool is_same_release(const Attempt& attempt, const Attempt& own) {
  return attempt.release == own.release || attempt.release.empty() || own.release.empty();
}

// Older programs did not note the conditions.
bool is_same_plan(const Attempt& attempt, const Attempt& own) {
  if (attempt.conditions.empty() || own.conditions.empty()) return attempt.worlds == own.worlds;
  return attempt.conditions == own.conditions;
}

std::string told(const Attempt& attempt) {
  const std::string state = attempt.ended_utc.empty() ? "aborted or still under way" : attempt.verdict;
  return fmt::format("{}seed {}, plan digest {}: {}{}",
                     attempt.agents.empty() ? "" : printable(attempt.agents, 60) + ", ", attempt.seed,
                     hex_text(attempt.plan_hash), printable(state, 40), attempt.replaced ? ", overwritten" : "");
}

}  // namespace

AttemptHistory attempt_history(const AttemptLedger& ledger, const CampaignRecord& campaign) {
  AttemptHistory history;
  const auto& attempts = ledger.attempts();
  if (attempts.empty()) return history;
  history.ledger = ledger.path();
  history.broken_lines = ledger.broken_lines();
  history.first_foreign_line = ledger.first_foreign_line();
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
    const bool same_release = is_same_release(*attempt, *own), same_worlds = attempt->worlds == own->worlds;
    if (same_release) {
      if (same_worlds && !had_other_luck(*attempt, *own)) continue;
      if (!same_worlds)
        std::erase_if(history.others, [&](const Attempt& other) { return other.worlds == attempt->worlds; });
      history.others.push_back(*attempt);
    } else if (is_same_plan(*attempt, *own)) {
      std::erase_if(history.by_other_software, [&](const Attempt& other) {
        return other.release == attempt->release && other.seed == attempt->seed;
      });
      history.by_other_software.push_back(*attempt);
      if (attempt->seed == own->seed && attempt < own.base() - 1) history.same_worlds.push_back(*attempt);
    }
  }
  return history;
}

namespace {

// The last of them, and how many more there are.
std::string told(const std::vector<Attempt>& attempts) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(kMostTold, attempts.size()); ++i)
    words.push_back(told(attempts[attempts.size() - 1 - i]));
  if (attempts.size() > kMostTold) words.push_back(fmt::format("{} more", attempts.size() - kMostTold));
  return joined(words, "; ");
}

std::string others_sentence(const AttemptHistory& history, double risk) {
  const auto& others = history.others;
  if (others.empty()) {
    return "Earlier attempts unknown: the ledger names no other attempt for this release" +
           (history.since_utc.empty() ? "." : fmt::format(", and begins on {}.", history.since_utc));
  }
  const double all = std::min(1.0, risk * static_cast<double>(others.size() + 1));
  return fmt::format(
      "The ledger names {} attempts for this release: this one and {} ({}). The bounds hold for one attempt and are "
      "not adjusted for their number: a limit that is not met is demonstrated by one attempt in at most {} of cases, "
      "by one of {} in up to {}.",
      others.size() + 1, count_text(others.size(), "other"), told(others), percent(risk), others.size() + 1,
      percent(all));
}

// A new name, another parameter or one more byte makes other software.
std::string software_sentence(const AttemptHistory& history, double risk) {
  const auto& attempts = history.by_other_software;
  if (attempts.empty()) return "";
  const std::size_t tries = attempts.size() + history.others.size() + 1;
  return fmt::format(
      " It names {} at the same plan by other software ({}). If some of that is the same under another name, these are "
      "attempts, too: a limit that is not met is then demonstrated by one of {} in up to {}.",
      count_text(attempts.size(), "attempt"), told(attempts), tries,
      percent(std::min(1.0, risk * static_cast<double>(tries))));
}

// Nothing if all of them were simulated again.
std::string taken_over_sentence(const TakenOver& taken) {
  if (taken.simulated_again >= taken.runs) return "";
  constexpr double kConfidence = 0.95;
  std::string text = fmt::format(
      " {} stored by an earlier session; the last one simulated {} of them again, {} drawn at random",
      taken.runs == 1 ? "1 run was" : fmt::format("{} runs were", taken.runs), taken.simulated_again, taken.drawn);
  if (taken.drawn == 0) return text + ": whether somebody had exchanged rows is not known.";
  return text + fmt::format(": if more than {} % of the rows had been exchanged, that would have shown with {}.",
                            rounded_up(100.0 * most_exchanged(taken, kConfidence)), percent(kConfidence));
}

// What the session log says of itself and of the file beside it.
std::string session_log_sentences(const AttemptHistory& history) {
  std::string text;
  if (history.names_no_ledger)
    text += " The session log names no line of a ledger: it was changed, or an older program wrote it.";
  if (history.log_is_foreign)
    text +=
        " The session log is that of another results file, or somebody changed this file after its last session: "
        "what the log says of sessions and disturbed runs may be of other runs.";
  if (history.log_names_no_file)
    text +=
        " The session log does not say which file its last session left: it was changed, or an older program wrote "
        "it.";
  if (history.log_has_no_end)
    text += " The last session noted no end: it is under way, it was killed, or somebody changed the session log.";
  if (history.taken_over) text += taken_over_sentence(*history.taken_over);
  return text;
}

}  // namespace

std::string attempt_troubles(const AttemptHistory& history) {
  std::string text;
  if (!history.session_log_trouble.empty())
    text += fmt::format(
        " The session log beside the results file cannot be read ({}): who made it, when, and by which ledger is not "
        "known.",
        printable(history.session_log_trouble, 400));
  else if (!history.has_session_log)
    text += " There is no session log beside the results file: who made it, when, and by which ledger is not known.";
  if (history.has_session_log) text += session_log_sentences(history);
  if (history.was_merged) text += " Shards write into no ledger: what was run in shards, and not merged, is not known.";
  if (history.disturbed_runs > 0)
    text += fmt::format(
        " The worker process of {} was killed or waited too long, and another worker brought {} to an end: if nobody "
        "else did that, this software ends its process now and then.",
        count_text(history.disturbed_runs, "run"), history.disturbed_runs == 1 ? "it" : "them");
  if (history.ledger_lost_line)
    text +=
        " The session log names a line of a ledger that is not there: the ledger is missing, or was changed or "
        "replaced since.";
  if (history.first_foreign_line)
    text += fmt::format(" Line {} of the ledger does not follow the line before it: somebody has changed the ledger.",
                        *history.first_foreign_line);
  if (history.broken_lines > 0)
    text += fmt::format(" {} of the ledger cannot be read.", count_text(history.broken_lines, "line"));
  return text;
}

std::string attempts_sentence(const AttemptHistory& history, double risk) {
  if (!history.ledger_trouble.empty())
    return fmt::format("Earlier attempts unknown: the ledger cannot be read ({}).",
                       printable(history.ledger_trouble, 400)) +
           attempt_troubles(history);
  if (history.ledger.empty() || !history.own)
    return "Earlier attempts unknown: no ledger of attempts tells of this campaign." + attempt_troubles(history);
  std::string text = others_sentence(history, risk) + software_sentence(history, risk);
  if (!history.same_worlds.empty()) {
    text += fmt::format(
        " Another release was tried in the same worlds before ({}): failures that were mended since do not count as "
        "evidence. seed = \"fresh\" gives each release worlds of its own.",
        history.same_worlds.back().begun_utc.empty() ? "date unknown" : history.same_worlds.back().begun_utc);
  } else {
    text += history.own->fresh_seed
                ? " The seed follows from the digests of release and plan: whoever changes a byte of either gets other "
                  "worlds, and how many were tried no other ledger tells."
                : " A person chose the seed: whether these worlds were seen before in a search, no ledger tells.";
  }
  return text + attempt_troubles(history);
}

}  // namespace fleetproof
