#include "campaign/cli/attempt_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <vector>

#include "campaign/batch/session_log.hpp"
#include "campaign/plan/plan.hpp"
#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"
#include "reports/attempts/looks.hpp"
#include "storage/line_log.hpp"
#include "storage/target_file.hpp"

namespace fleetproof::cli {
namespace {

std::string named_ledger(const std::string& ledger, const std::string& archive) {
  return std::filesystem::path(absolute_name(ledger.empty() ? default_ledger(archive) : ledger))
      .lexically_normal()
      .string();
}

bool has_runs(const std::string& archive) { return is_name_taken(archive) || is_name_taken(archive + ".partial"); }

std::string random_id() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

}  // namespace

AttemptLog::AttemptLog(const std::string& ledger, const Campaign& campaign)
    : ledger_(named_ledger(ledger, campaign.archive)),
      attempt_(attempt_of(campaign.record)),
      is_claim_(campaign.record.kind == name_of(CampaignKind::Claim)),
      goes_on_(!campaign.overwrite && has_runs(campaign.archive)),
      overwrites_(campaign.overwrite && has_runs(campaign.archive)) {
  attempt_.archive = std::filesystem::path(absolute_name(campaign.archive)).lexically_normal().string();
  attempt_.release = campaign.release;
  attempt_.planned_runs = campaign.planned_runs;
  attempt_.fresh_seed = campaign.fresh_seed;
  // One that is not named and not there yet is made beside the results file, whose place is looked at by itself.
  if (is_claim_ && (!ledger.empty() || is_name_taken(ledger_.path())))
    require_appendable(ledger_.path(), "change the permissions, or name another ledger by --ledger");
}

const Attempt* AttemptLog::earlier() const {
  const std::string remembered = remembered_attempt(attempt_.archive);
  const Attempt* found = nullptr;
  for (const Attempt& each : ledger_.attempts()) {
    if (each.worlds != attempt_.worlds) continue;
    if (each.id == remembered) return &each;
    if (each.archive == attempt_.archive || (each.release == attempt_.release && !each.replaced)) found = &each;
  }
  return found;
}

void AttemptLog::begin() {
  if (!is_claim_) return;
  if (const Attempt* known = goes_on_ ? earlier() : nullptr) {
    attempt_.id = known->id;
    attempt_.line = known->line;
    return;
  }
  attempt_.id = random_id();
  attempt_.begun_utc = goes_on_ ? "" : utc_now();
  attempt_.line = ledger_.begin(attempt_, overwrites_);
}

void AttemptLog::end(const ReportInput& input) {
  if (!is_claim_) return;
  attempt_.runs = input.stored_runs;
  attempt_.verdict = name_of(overall_verdict(input.evidence, input.gates));
  ledger_.end(attempt_);
}

namespace {

// Why the session log cannot be read; empty if it can, or if there is none.
std::string session_log_trouble(const std::string& archive_path) {
  try {
    for_each_log_line(session_log_path(archive_path), [](std::string_view) {});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// A file that nobody named tells nothing if it cannot be read, and stops no report.
AttemptHistory history_in(const std::string& ledger, const std::string& path, const CampaignRecord& campaign,
                          const std::vector<LogLine>& begins) {
  AttemptHistory history;
  history.ledger_lost_line = !begins.empty();
  try {
    const AttemptLedger known(path);
    history = attempt_history(known, campaign);
    history.ledger_lost_line = !std::ranges::all_of(begins, [&](const LogLine& line) { return known.has(line); });
  } catch (const InputError& error) {
    if (!ledger.empty()) throw;
    history.ledger_trouble = error.what();
  }
  return history;
}

// Whether the session log is that of the results file. The ledger knows the plan of the attempt that it names; the seal
// that its last session left is that of the file.
void add_log_of_file(AttemptHistory& history, const ReportInput& input, const std::vector<LogLine>& begins) {
  if (!begins.empty() && !history.ledger.empty()) {
    const AttemptLedger ledger(history.ledger);
    const auto named = std::ranges::find(ledger.attempts(), begins.back(), &Attempt::line);
    history.log_is_foreign = named != ledger.attempts().end() && named->worlds != attempt_of(input.campaign).worlds;
  }
  if (!input.seal) return;
  const RememberedSeal left = remembered_seal(input.archive_path);
  history.log_has_no_end = !left.has_end;
  history.log_names_no_file = left.has_end && !left.value;
  history.log_is_foreign = history.log_is_foreign || (left.value && left.value != input.seal);
}

}  // namespace

void add_history(ReportInput& input, const std::string& ledger) {
  const std::string& archive = input.archive_path;
  const std::string trouble = session_log_trouble(archive);
  const bool has_log = trouble.empty() && is_name_taken(session_log_path(archive));
  std::string path = ledger;
  if (path.empty() && has_log) path = remembered_ledger(archive);
  if (ledger.empty() && !is_name_taken(path)) path = default_ledger(archive);
  const std::vector<LogLine> begins = has_log ? remembered_ledger_lines(archive) : std::vector<LogLine>();
  input.attempts = history_in(ledger, path, input.campaign, begins);
  input.attempts.has_session_log = has_log;
  input.attempts.session_log_trouble = trouble;
  input.attempts.names_no_ledger = begins.empty() && input.campaign.kind == name_of(CampaignKind::Claim);
  input.sensitivity = sensitivity_beside(archive, input.campaign);
  input.findings = findings_beside(archive, input.campaign.plan_hash, input.stored_runs);
  if (!has_log) return;
  add_log_of_file(input.attempts, input, begins);
  input.attempts.taken_over = remembered_taken_over(archive);
  input.attempts.was_merged = !remembered_shard(archive).empty();
  input.attempts.looks = looks_at(archive);
  input.attempts.overrides = remembered_overrides(archive);
  input.attempts.disturbed_runs = remembered_disturbed(archive);
  input.attempts.dependent_agents = remembered_dependent_agents(archive);
}

}  // namespace fleetproof::cli
