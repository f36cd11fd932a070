#include "campaign/batch/session.hpp"

#include <thread>
#include <utility>

namespace fleetproof {
namespace {

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

Session::Session(const CampaignPlan& plan, const AgentPrograms& programs, const RunOptions& options,
                 const CampaignListener& listener)
    : options_(options),
      listener_(listener),
      group_(plan.cells_per_world()),
      runs_(plan, programs,
            {.workers = options.workers, .log_prefix = options.worker_logs, .earlier_logs = options.earlier_logs}),
      audits_(plan, programs, options.audits, options.workers) {}

void Session::count(const RunRecord& run) {
  Progress& progress = result_.progress;
  ++progress.done;
  progress.violating += run.outcome.violation ? 1 : 0;
  progress.engine_errors += run.outcome.engine_error ? 1 : 0;
}

CampaignResult Session::run(SessionPolicy& policy, TaskRange places) {
  started_ = last_tick_ = Clock::now();
  audits_.start();
  simulate(policy, std::move(places));
  finish_audits(policy);
  result_.add(runs_.take_losses());
  return std::move(result_);
}

void Session::simulate(SessionPolicy& policy, TaskRange places) {
  // Worker threads simulate; this thread alone counts, stores and prints.
  places.workers = options_.workers;
  places.group = group_;
  TaskPool<RunRecord> pool(std::move(places), [&](std::uint64_t place) { return runs_(policy.run_at(place)); });
  // Progress names the runs under way by their run index; the pool knows only their places in the task list.
  const UnderWay under_way = [&] {
    std::vector<RunUnderWay> runs;
    for (const TaskUnderWay& task : pool.under_way()) runs.push_back({policy.run_at(task.index), task.since_s});
    return runs;
  };
  const auto look = [&] {
    stop_if_due(policy, pool);
    tick_if_due(policy, under_way);
  };
  pool.take_all([&](std::uint64_t, const RunRecord& run) { take(policy, run); },
                [&] {
                  look();
                  // With a large share the audits set the pace.
                  while ((audits_.is_far_behind() || policy.is_far_ahead()) && !stopped_) {
                    std::this_thread::sleep_for(std::chrono::milliseconds(5));
                    look();
                  }
                });
  // All runs that were handed out have finished, also after a stop.
  result_.threads = pool.threads_seen();
  result_.progress.elapsed_s = elapsed_s();
}

// A verdict needs the audits of its runs: after a stop they get what is left of the time that runs get. What is open
// then is done by the session that goes on.
void Session::finish_audits(SessionPolicy& policy) {
  audits_.no_more_runs();
  while (!audits_.idle()) {
    if (policy.piece() == 0 && !stopped_ && must_stop(options_)) stopped_ = Clock::now();
    if (stopped_ && Clock::now() - *stopped_ >= kDrain) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    tick_if_due(policy, [] { return std::vector<RunUnderWay>(); });
  }
  // No audit is under way, or a stop left some open. These are counted, and the others are stored.
  result_.progress.audits_open = audits_.open_count();
  audits_.abandon();
  keep_findings(policy);
  result_.closer_looks = audits_.closer_looks();
  result_.audit_failure = audits_.failure();
}

void Session::take(SessionPolicy& policy, const RunRecord& run) {
  ++result_.progress.simulated;
  result_.progress.disturbed += run.was_disturbed ? 1 : 0;
  count(run);
  policy.keep(run, audits_.offer(run, runs_.slowest_cpu_ns()));
  listener_.run_finished(run);
}

void Session::stop_if_due(const SessionPolicy& policy, AnyTaskPool& pool) {
  const bool asked = must_stop(options_);
  if (policy.piece() > 0) {
    if (asked) pool.stop_after_group(policy.piece());
    return;
  }
  const auto now = Clock::now();
  if (!stopped_ && (asked || policy.is_decided())) {
    stopped_ = now;
    pool.stop();
  }
  if (stopped_ && now - *stopped_ >= kDrain) runs_.abandon();
}

void Session::tick_if_due(SessionPolicy& policy, const UnderWay& under_way) {
  const auto now = Clock::now();
  if (now - last_tick_ < std::chrono::milliseconds(100)) return;
  last_tick_ = now;
  result_.add(runs_.take_losses());
  keep_findings(policy);
  policy.tick();
  Progress& progress = result_.progress;
  progress.elapsed_s = elapsed_s();
  progress.audits_open = audits_.open_count();
  progress.repeats = runs_.repeats();
  listener_.tick(progress);
  if (listener_.wants_status()) listener_.status(progress, under_way());
}

void Session::keep_findings(SessionPolicy& policy) {
  for (const AuditedRun& finding : audits_.take_findings()) {
    policy.keep(finding);
    ++result_.progress.audited;
    if (!finding.same) ++result_.audits_differing;
  }
}

double Session::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

}  // namespace fleetproof
