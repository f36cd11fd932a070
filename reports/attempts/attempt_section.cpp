#include "reports/attempts/attempt_section.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostAttempts = 20;

// Of one attempt, by its weakest gate.
double risk_of(const Evidence& evidence) {
  double risk = 0.0;
  for (const GateRecord& gate : evidence.gates()) {
    if (gate.decides) risk = std::max(risk, 1.0 - gate.confidence);
  }
  return risk;
}

std::string plan_sentence(const AttemptHistory& history, const CampaignRecord& campaign) {
  const auto& own = history.own;
  const std::string plan = hex_text(campaign.plan_hash);
  if (!own || own->begun_utc.empty()) return fmt::format("When plan digest {} was fixed is not known.", plan);
  const std::string begun = printable(own->begun_utc, 40);
  if (own->plan_hash == campaign.plan_hash)
    return fmt::format("Plan digest {} was fixed before run 0, at {}.", plan, begun);
  return fmt::format(
      "Plan digest {} was fixed before run 0, at {}; the number of replicates was changed since: digest {}.",
      hex_text(own->plan_hash), begun, plan);
}

std::string seed_sentence(const AttemptHistory& history, std::uint64_t seed) {
  const auto& own = history.own;
  if (own && own->fresh_seed) return fmt::format("Seed {} follows from the digests of release and plan.", seed);
  std::string text = fmt::format("Seed {} was chosen by a person", seed);
  if (!history.overrides.empty()) text += fmt::format("; options changed the campaign file: {}", history.overrides);
  return text + ".";
}

std::string obedience_sentence(const AttemptHistory& history, const Evidence& evidence) {
  const std::string done = fmt::format("{} of {}", evidence.complete_replicates(),
                                       count_text(evidence.planned_replicates(), "planned replicate"));
  const std::uint64_t planned = evidence.planned_replicates() * evidence.cells().size();
  std::string text = evidence.complete() ? fmt::format("The data obey the plan: {} complete.", done)
                                         : fmt::format("The data are a part of the plan: {} complete.", done);
  const auto& own = history.own;
  if (own && own->planned_runs != 0 && own->planned_runs != planned)
    text += fmt::format(" The plan had {} runs when it began and has {} now.", own->planned_runs, planned);
  return text;
}

std::string looks_sentence(const AttemptHistory& history, const std::vector<GateRecord>& gates) {
  const bool fixed = std::ranges::any_of(
      gates, [](const GateRecord& gate) { return gate.decides && gate.method == GateMethod::Fixed; });
  std::string text = "How often the results were looked at is not known: there is no session log beside the file.";
  if (history.looks == 1U) text = "The results were looked at with one number of runs.";
  if (history.looks.value_or(0) > 1)
    text = fmt::format("The results were looked at with {} numbers of runs.", *history.looks);
  return text + (fixed ? " A gate of the method fixed may be looked at once, when all is complete."
                       : " Gates of the method any-time allow that.");
}

std::vector<std::string> row(const Attempt& attempt, const std::string& verdict) {
  return {attempt.begun_utc.empty() ? "not known" : printable(attempt.begun_utc, 40),
          printable(attempt.campaign, 40),
          std::to_string(attempt.seed),
          hex_text(attempt.plan_hash),
          fmt::format("{} of {}", attempt.runs, attempt.planned_runs),
          verdict};
}

}  // namespace

std::string attempts_headline(const AttemptHistory& history, const Evidence& evidence) {
  return evidence.counts_only() ? "" : attempts_sentence(history, risk_of(evidence));
}

Section attempt_section(const AttemptHistory& history, const CampaignRecord& campaign, const Evidence& evidence) {
  Section section{"Attempts, plan and looks", {}, {}};
  if (evidence.counts_only()) {
    section.remarks.emplace_back().text = "A search claims nothing, so no ledger counts its attempts.";
    return section;
  }
  const auto& others = history.others;
  if (!others.empty()) {
    for (const char* head : {"begun", "campaign", "seed", "plan digest", "runs", "verdict"})
      section.table.columns.push_back({head, false});
  }
  if (!others.empty()) section.table.rows.push_back(row(*history.own, "this page"));
  for (std::size_t i = others.size(); i-- > 0 && section.table.rows.size() < kMostAttempts;) {
    const Attempt& other = others[i];
    const std::string state = other.ended_utc.empty() ? "aborted or still under way" : printable(other.verdict, 40);
    section.table.rows.push_back(row(other, state + (other.replaced ? ", overwritten" : "")));
  }
  for (std::string text :
       {attempts_headline(history, evidence), plan_sentence(history, campaign), seed_sentence(history, campaign.seed),
        obedience_sentence(history, evidence), looks_sentence(history, evidence.gates())})
    section.remarks.emplace_back().text = std::move(text);
  return section;
}

}  // namespace fleetproof
