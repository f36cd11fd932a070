#include "campaign/batch/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "campaign/batch/audit_counts.hpp"
#include "campaign/batch/same_campaign.hpp"
#include "campaign/batch/stop_rules.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/batch/stored_sample.hpp"
#include "campaign/plan/first_worlds.hpp"
#include "reports/evidence/quiet_run.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"

namespace fleetproof {
namespace {

// Runs between the oldest unfinished and the newest handed out: one slow run stalls nothing, and memory stays bounded.
constexpr std::uint64_t kLiveWindow = 65'536;

// Stores the runs of a session in the results file. A results file that goes on gives the runs that it holds.
class CampaignPolicy final : public SessionPolicy {
 public:
  CampaignPolicy(Session& session, const CampaignPlan& plan, const AgentPrograms& programs, const StoredPlan& stored,
                 const std::string& path)
      : session_(session),
        plan_(plan),
        programs_(programs),
        stored_(stored),
        audit_counts_(plan, programs),
        verdict_(stored),
        archive_(path, stored, session.options().overwrite ? Existing::Replace : Existing::Resume, resumption(path)) {
    session_.progress().planned = plan.run_count();
    if (!session_.options().audits) verdict_.audits_end();
    for (std::size_t agent = 0; agent < audit_counts_.agent_count(); ++agent)
      session_.runs().record(agent, audit_counts_.needs_recordings(agent));
  }

  // Before any other run: rows that are not those of this campaign would count in what is published. Nothing if the
  // file held none.
  std::optional<TakenOver> simulate_some_again(const std::string& path) const {
    const std::uint64_t held = session_.progress().done;
    if (held == 0) return std::nullopt;
    TakenOver taken = sample_.simulate_again(session_, plan_, programs_, path);
    taken.runs = held;
    return taken;
  }

  TaskRange runs_to_do() const {
    return {.begin = ledger_.prefix_length(),
            .end = session_.progress().planned,
            .window = kLiveWindow,
            .done = ledger_.ahead()};
  }

  void keep(const RunRecord& run, bool) override {
    count(run);
    archive_.add(run);
  }

  void keep(const AuditedRun& finding) override {
    archive_.add(finding.audit);
    count(finding);
  }

  bool is_far_ahead() const override { return verdict_.waits_for_audits() && verdict_.waiting_runs() >= kLiveWindow; }

  void tick() override {
    const auto now = Clock::now();
    if (!session_.audits().failure().empty()) verdict_.audits_end();
    if (!verdict_.waits_for_audits()) last_without_waiting_ = now;
    if (now - last_without_waiting_ >= std::chrono::milliseconds(200)) session_.audits().hurry();
    if (now - last_commit_ < std::chrono::seconds(1)) return;  // even while one slow run lets no other finish
    last_commit_ = now;
    archive_.commit();
  }

  bool is_decided() const override { return stop_length().has_value(); }

  // The gap-free prefix of runs becomes the results file.
  void publish(CampaignResult& result, Keep keep) {
    result.stored = stop_length().value_or(ledger_.prefix_length());
    const bool goes_on = !result.complete() || result.progress.audits_open > 0 || !result.audit_failure.empty();
    archive_.publish(result.stored, keep == Keep::Failing && !goes_on ? quiet_runs_of(stored_) : MayFold());
  }

 private:
  using Clock = std::chrono::steady_clock;

  Resumption resumption(const std::string& path) {
    return {[this, path](const CampaignRecord& stored, CampaignRecord& continued) {
              stored_runs_are_ours_ = has_one_engine(stored.engine, continued.engine);
              require_same_campaign(path, stored, continued, session_.options().allow_drift);
            },
            [this](const AuditRecord& audit, bool same) {
              ++session_.progress().audited;
              count({audit, same});
              audited_before_.emplace(audit.run_index, same);
            },
            [this](const RunRecord& run) {
              session_.count(run);
              count(run);
              if (stored_runs_are_ours_) take_over(run);  // another engine's run may well differ
            },
            [this](const std::vector<std::uint64_t>& runs) {
              recorded_clean_ = {runs.begin(), runs.end()};
            }};
  }

  // What else the file has of a run speaks for its row, or against it.
  void take_over(const RunRecord& run) {
    const auto audit = audited_before_.find(run.run_index);
    const bool was_audited = audit != audited_before_.end();
    if (!was_audited && session_.audits().offer(run)) return;  // it is simulated again anyway
    if (was_audited && !audit->second) return;                 // it counts as different already
    if (!is_sampled(run)) return;
    if (was_audited || recorded_clean_.contains(run.run_index) || contradicts_itself(run.outcome)) {
      sample_.add_named(run);
    } else {
      sample_.add(run);
    }
  }

  // What a plug-in failed in would take a worker and its limits again. A claim counts it as failing anyway.
  bool is_sampled(const RunRecord& run) const {
    return !run.outcome.is_failure() || !programs_.needs_worker(plan_.agent_of_cell(run.run_index));
  }

  // Somebody may have taken the failure out of a row, and not what belongs to it.
  bool contradicts_itself(const Outcome& outcome) const {
    if (outcome.is_failure()) return false;
    const bool too_close = outcome.min_clearance_um &&
                           static_cast<double>(*outcome.min_clearance_um + 1) < plan_.law.safety_distance_m * 1e6;
    return outcome.counters.contacts > 0 || !outcome.violations.empty() || !outcome.message.empty() || too_close;
  }

  void count(const RunRecord& run) {
    ledger_.add(run.run_index, run.outcome.is_failure());
    if (session_.options().until_verdict) verdict_.add(run);
  }

  void count(const AuditedRun& finding) {
    audit_counts_.add(finding);
    if (session_.options().until_verdict) verdict_.add(finding);
    const std::size_t agent = audit_counts_.agent_of(finding.audit.run_index);
    session_.runs().record(agent, audit_counts_.needs_recordings(agent));
  }

  // How many runs the campaign keeps if its failures or its verdict end it.
  std::optional<std::uint64_t> stop_length() const {
    const std::uint64_t most_failures = session_.options().fail_fast;
    const auto failures = most_failures > 0 ? ledger_.length_with_failures(most_failures) : std::nullopt;
    const auto verdict = verdict_.decided_length();
    return failures && verdict ? std::min(failures, verdict) : (failures ? failures : verdict);
  }

  Session& session_;
  const CampaignPlan& plan_;
  const AgentPrograms& programs_;
  const StoredPlan& stored_;
  RunLedger ledger_;
  bool stored_runs_are_ours_ = true;
  std::unordered_map<std::uint64_t, bool> audited_before_;  // in an earlier session: whether it came out the same
  std::unordered_set<std::uint64_t> recorded_clean_;
  StoredSample sample_;
  AuditCounts audit_counts_;
  VerdictWatch verdict_;
  ArchiveWriter archive_;
  Clock::time_point last_commit_ = Clock::now(), last_without_waiting_ = last_commit_;
};

// Nothing is left to do in a folded file: the campaign was complete.
std::optional<CampaignResult> folded_before(const StoredPlan& plan, const std::string& path,
                                            const RunOptions& options) {
  std::error_code ignored;
  namespace fs = std::filesystem;
  if (options.overwrite || !fs::exists(path, ignored) || fs::exists(path + ".partial", ignored)) return std::nullopt;
  const ArchiveReader archive(path);
  if (!archive.is_folded() || archive.campaign().replicates != plan.campaign.replicates) return std::nullopt;
  CampaignRecord now = plan.campaign;
  require_same_campaign(path, archive.campaign(), now, options.allow_drift);
  CampaignResult result;
  result.stored = result.progress.done = result.progress.planned = plan.campaign.replicates * plan.cells.size();
  return result;
}

}  // namespace

CampaignResult run_campaign(const CampaignPlan& plan, const AgentPrograms& programs, const std::string& path,
                            const RunOptions& options, const CampaignListener& listener) {
  for (const AgentFactor& agent : plan.agents) (void)programs.parts_of(agent, "factors.agents");
  const StoredPlan stored = stored_plan(plan, programs);
  if (auto result = folded_before(stored, path, options)) {
    listener.started();
    return *std::move(result);
  }
  // What cannot be built is said before anything is written.
  for (const std::string& sentence : build_first_worlds(plan)) listener.warned(sentence);
  Session session(plan, programs, options, listener);
  CampaignPolicy policy(session, plan, programs, stored, path);
  listener.started();
  if (const auto taken = policy.simulate_some_again(path)) listener.took_over(*taken);
  CampaignResult result = session.run(policy, policy.runs_to_do());
  policy.publish(result, plan.keep);
  return result;
}

}  // namespace fleetproof
