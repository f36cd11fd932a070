#include "campaign/batch/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "campaign/batch/audit_book.hpp"
#include "campaign/batch/audit_desk.hpp"
#include "campaign/batch/run_ledger.hpp"
#include "campaign/batch/same_campaign.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/batch/task_pool.hpp"
#include "campaign/batch/verdict_watch.hpp"
#include "campaign/plan/first_worlds.hpp"
#include "campaign/workers/run_host.hpp"
#include "reports/evidence/quiet_run.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"

namespace fleetproof {
namespace {

// Runs between the oldest unfinished and the newest handed out: one slow run stalls nothing, and memory stays bounded.
constexpr std::uint64_t kLiveWindow = 65'536;

constexpr std::chrono::seconds kDrain{4};  // what runs under way get after the stop; then they are abandoned
constexpr std::size_t kLossesKept = 1000;

}  // namespace

void CampaignResult::add(std::vector<WorkerLoss> lost) {
  loss_count += lost.size();
  for (WorkerLoss& loss : lost) {
    if (losses.size() < kLossesKept) losses.push_back(std::move(loss));
  }
}

bool must_stop(const RunOptions& options) {
  const bool interrupted = options.interrupted != nullptr && options.interrupted->load() != 0;
  return interrupted || (options.deadline && std::chrono::steady_clock::now() >= *options.deadline);
}

namespace {

// One session of a campaign: takes over what the file holds, hands out the other runs, stores those that finish, has a
// share of them audited, and publishes the gap-free prefix. It counts, stops and reports on the caller's thread.
class Session {
 public:
  Session(const CampaignPlan& plan, const AgentPrograms& programs, const StoredPlan& stored, const std::string& path,
          const RunOptions& options, const CampaignListener& listener)
      : options_(options),
        listener_(listener),
        stretch_(plan.cells_per_world()),
        audit_book_(plan, programs),
        runs_(plan, programs, {.workers = options.workers, .log_prefix = options.worker_logs}),
        audits_(plan, programs, options.audit_program, options.workers),
        verdict_(stored),
        archive_(path, stored, options.overwrite ? Existing::Replace : Existing::Resume, resumption(path)) {
    result_.progress.planned = plan.run_count();
    for (std::size_t agent = 0; agent < audit_book_.agent_count(); ++agent)
      runs_.record(agent, audit_book_.needs_recordings(agent));
  }

  CampaignResult run(Keep keep) {
    listener_.started();
    audits_.start();
    simulate();
    finish_audits();
    result_.add(runs_.take_losses());
    result_.stored = stop_length().value_or(ledger_.prefix_length());
    const bool goes_on = !result_.complete() || result_.progress.audits_open > 0;
    archive_.publish(result_.stored, keep == Keep::Failing && !goes_on ? MayFold(is_quiet) : MayFold());
    return std::move(result_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void simulate() {
    TaskPool pool(
        options_.workers, ledger_.prefix_length(), result_.progress.planned, kLiveWindow,
        [this](std::uint64_t index) { return runs_(index); }, ledger_.ahead(), stretch_);
    while (!pool.finished()) {
      if (audits_.is_far_behind() && !stopped_) {  // with a large share the audits set the pace
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      } else if (const auto record = pool.next(std::chrono::milliseconds(100))) {
        take(*record);
      }
      stop_if_due(pool);
      tick_if_due([&] { return pool.under_way(); });
    }
    result_.threads = pool.threads_seen();
    result_.progress.elapsed_s = elapsed_s();
  }

  // A stopped campaign leaves audits open; the session that goes on does them.
  void finish_audits() {
    audits_.no_more_runs();
    while (!audits_.idle()) {
      if (must_stop(options_)) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      tick_if_due([] { return std::vector<RunUnderWay>(); });
    }
    result_.progress.audits_open = audits_.open_count();
    audits_.abandon();
    keep_findings();
    result_.audit_failure = audits_.failure();
  }

  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

  Resumption resumption(const std::string& path) {
    return {[this, path](const CampaignRecord& stored, CampaignRecord& continued) {
              stored_runs_are_ours_ = has_one_engine(stored.engine, continued.engine);
              require_same_campaign(path, stored, continued, options_.allow_drift);
            },
            [this](const RunRecord& record) {
              count(record);
              if (stored_runs_are_ours_) audits_.offer(record);  // another engine's run may well differ
            },
            [this](const AuditRecord& audit, bool same) {
              count({audit, same});
              audits_.forget(audit.run_index);
            }};
  }

  void count(const RunRecord& record) {
    Progress& progress = result_.progress;
    ++progress.done;
    progress.violating += record.outcome.violation ? 1 : 0;
    progress.engine_errors += record.outcome.engine_error ? 1 : 0;
    ledger_.add(record.run_index, record.outcome.is_failure());
    if (options_.until_verdict) verdict_.add(record);
  }

  void count(const AuditFinding& finding) {
    ++result_.progress.audited;
    audit_book_.add(finding);
    const std::size_t agent = audit_book_.agent_of(finding.audit.run_index);
    runs_.record(agent, audit_book_.needs_recordings(agent));
  }

  void take(const RunRecord& record) {
    ++result_.progress.simulated;
    count(record);
    archive_.add(record);
    audits_.offer(record, runs_.slowest_cpu_ns());
    listener_.run_finished(record);
  }

  // How many runs the campaign keeps if its failures or its verdict end it.
  std::optional<std::uint64_t> stop_length() const {
    const auto failures = options_.fail_fast > 0 ? ledger_.length_with_failures(options_.fail_fast) : std::nullopt;
    const auto verdict = verdict_.decided_length();
    return failures && verdict ? std::min(failures, verdict) : (failures ? failures : verdict);
  }

  void stop_if_due(TaskPool& pool) {
    const auto now = Clock::now();
    if (!stopped_ && (must_stop(options_) || stop_length())) {
      stopped_ = now;
      pool.stop();
    }
    if (stopped_ && now - *stopped_ >= kDrain) runs_.abandon();
  }

  void tick_if_due(const std::function<std::vector<RunUnderWay>()>& under_way) {
    const auto now = Clock::now();
    if (now - last_tick_ >= std::chrono::milliseconds(100)) {
      last_tick_ = now;
      result_.progress.elapsed_s = elapsed_s();
      result_.progress.audits_open = audits_.open_count();
      listener_.tick(result_.progress);
      if (listener_.wants_status()) listener_.status(result_.progress, under_way());
      result_.add(runs_.take_losses());
      keep_findings();
    }
    if (now - last_commit_ >= std::chrono::seconds(1)) {  // even while one slow run lets no other finish
      last_commit_ = now;
      archive_.commit();
    }
  }

  void keep_findings() {
    for (const AuditFinding& finding : audits_.take_findings()) {
      archive_.add(finding.audit);
      count(finding);
      if (!finding.same) ++result_.audits_differing;
    }
  }

  const RunOptions& options_;
  const CampaignListener& listener_;
  CampaignResult result_;
  const std::uint64_t stretch_;  // of runs in one world
  RunLedger ledger_;
  bool stored_runs_are_ours_ = true;
  AuditBook audit_book_;
  RunHost runs_;  // before the archive: worker processes must not hold its files
  AuditDesk audits_;
  VerdictWatch verdict_;
  ArchiveWriter archive_;
  const Clock::time_point started_ = Clock::now();
  Clock::time_point last_tick_ = started_, last_commit_ = started_;
  std::optional<Clock::time_point> stopped_;
};

}  // namespace

namespace {

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
  for (const AgentFactor& agent : plan.agents) (void)programs.program(agent.program, "factors.agents");
  const StoredPlan stored = stored_plan(plan, programs);
  if (auto result = folded_before(stored, path, options)) {
    listener.started();
    return *std::move(result);
  }
  // What cannot be built is said before anything is written.
  for (const std::string& sentence : build_first_worlds(plan)) listener.warned(sentence);
  return Session(plan, programs, stored, path, options, listener).run(plan.keep);
}

}  // namespace fleetproof
