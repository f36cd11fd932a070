#include "campaign/cli/attempt_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <vector>

#include "campaign/batch/session_log.hpp"
#include "campaign/plan/plan.hpp"
#include "core/base/error.hpp"
#include "reports/attempts/looks.hpp"
#include "storage/line_log.hpp"

namespace fleetproof::cli {
namespace {

std::string named_ledger(const std::string& ledger, const std::string& archive) {
  return std::filesystem::absolute(ledger.empty() ? default_ledger(archive) : ledger).lexically_normal().string();
}

bool has_runs(const std::string& archive) {
  return std::filesystem::exists(archive) || std::filesystem::exists(archive + ".partial");
}

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
  attempt_.archive = std::filesystem::absolute(campaign.archive).lexically_normal().string();
  attempt_.release = campaign.release;
  attempt_.planned_runs = campaign.planned_runs;
  attempt_.fresh_seed = campaign.fresh_seed;
  // One that is not named and not there yet is made beside the results file, whose place is looked at by itself.
  if (is_claim_ && (!ledger.empty() || std::filesystem::exists(ledger_.path())))
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

void add_history(ReportInput& input, const std::string& ledger) {
  std::string path = ledger.empty() ? remembered_ledger(input.archive_path) : ledger;
  if (ledger.empty() && !std::filesystem::exists(path)) path = default_ledger(input.archive_path);
  const std::vector<LogLine> begins = remembered_ledger_lines(input.archive_path);
  input.attempts.ledger_lost_line = !begins.empty();
  try {
    const AttemptLedger known(path);
    input.attempts = attempt_history(known, input.campaign);
    input.attempts.ledger_lost_line =
        !std::ranges::all_of(begins, [&](const LogLine& line) { return known.has(line); });
  } catch (const InputError&) {
    if (!ledger.empty()) throw;  // nobody named it: a foreign file of this name tells nothing, and stops no report
  }
  input.attempts.has_session_log = std::filesystem::exists(session_log_path(input.archive_path));
  input.attempts.names_no_ledger = begins.empty() && input.campaign.kind == name_of(CampaignKind::Claim);
  input.attempts.was_merged = !remembered_shard(input.archive_path).empty();
  input.attempts.looks = looks_at(input.archive_path);
  input.sensitivity = sensitivity_beside(input.archive_path, input.campaign);
  input.findings = findings_beside(input.archive_path, input.campaign.plan_hash, input.stored_runs);
  input.attempts.overrides = remembered_overrides(input.archive_path);
  input.attempts.disturbed_runs = remembered_disturbed(input.archive_path);
}

}  // namespace fleetproof::cli
