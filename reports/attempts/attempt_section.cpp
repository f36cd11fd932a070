#include "reports/attempts/attempt_section.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostRows = 20;

// Of one attempt, by its weakest gate.
double risk_of(const ReportInput& input) {
  double risk = 0.0;
  for (const GateRecord& gate : input.evidence.gates()) {
    if (gate.decides) risk = std::max(risk, 1.0 - gate.confidence);
  }
  return risk;
}

std::string plan_sentence(const ReportInput& input) {
  const auto& own = input.attempts.own;
  const std::string plan = hex_text(input.campaign.plan_hash);
  if (!own || own->begun_utc.empty()) return fmt::format("When plan digest {} was fixed is not known.", plan);
  const std::string begun = printable(own->begun_utc, 40);
  if (own->plan_hash == input.campaign.plan_hash)
    return fmt::format("Plan digest {} was fixed before run 0, at {}.", plan, begun);
  return fmt::format(
      "Plan digest {} was fixed before run 0, at {}; the number of replicates was changed since: digest {}.",
      hex_text(own->plan_hash), begun, plan);
}

std::string seed_sentence(const ReportInput& input) {
  const auto& own = input.attempts.own;
  if (own && own->fresh_seed)
    return fmt::format("Seed {} follows from the digests of release and plan; nobody chose it.", input.campaign.seed);
  std::string text = fmt::format("Seed {} was chosen by a person", input.campaign.seed);
  if (!input.overrides.empty()) text += fmt::format("; options changed the campaign file: {}", input.overrides);
  return text + ".";
}

std::string obedience_sentence(const ReportInput& input) {
  const Evidence& evidence = input.evidence;
  const std::string done = fmt::format("{} of {}", evidence.complete_replicates(),
                                       count_text(evidence.planned_replicates(), "planned replicate"));
  const std::uint64_t planned = evidence.planned_replicates() * evidence.cells().size();
  std::string text = evidence.complete() ? fmt::format("The data obey the plan: {} complete.", done)
                                         : fmt::format("The data are a part of the plan: {} complete.", done);
  const auto& own = input.attempts.own;
  if (own && own->planned_runs != 0 && own->planned_runs != planned)
    text += fmt::format(" The plan had {} runs when it began and has {} now.", own->planned_runs, planned);
  return text;
}

std::string looks_sentence(const ReportInput& input) {
  const auto& gates = input.evidence.gates();
  const bool fixed = std::ranges::any_of(
      gates, [](const GateRecord& gate) { return gate.decides && gate.method == GateMethod::Fixed; });
  std::string text = "How often the results were looked at is not known: there is no session log beside the file.";
  if (input.looks == 1U) text = "The results were looked at with one number of runs.";
  if (input.looks.value_or(0) > 1)
    text = fmt::format("The results were looked at with {} numbers of runs.", *input.looks);
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

std::string attempts_headline(const ReportInput& input) {
  return input.evidence.counts_only() ? "" : attempts_sentence(input.attempts, risk_of(input));
}

Section attempt_section(const ReportInput& input) {
  Section section{"Attempts, plan and looks", {}, {}};
  if (input.evidence.counts_only()) {
    section.remarks.emplace_back().text = "A search claims nothing, so no ledger counts its attempts.";
    return section;
  }
  const auto& others = input.attempts.others;
  if (!others.empty()) {
    for (const char* head : {"begun", "campaign", "seed", "plan digest", "runs", "verdict"})
      section.table.columns.push_back({head, false});
  }
  if (!others.empty()) section.table.rows.push_back(row(*input.attempts.own, "this page"));
  for (std::size_t i = others.size(); i-- > 0 && section.table.rows.size() < kMostRows;) {
    const Attempt& other = others[i];
    const std::string state = other.ended_utc.empty() ? "aborted or still under way" : printable(other.verdict, 40);
    section.table.rows.push_back(row(other, state + (other.replaced ? ", overwritten" : "")));
  }
  for (std::string text : {attempts_headline(input), plan_sentence(input), seed_sentence(input),
                           obedience_sentence(input), looks_sentence(input)})
    section.remarks.emplace_back().text = std::move(text);
  return section;
}

}  // namespace fleetproof
