#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign/batch/audit_queue.hpp"
#include "campaign/batch/task_pool.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/workers/run_host.hpp"
#include "reports/evidence/taken_over.hpp"
#include "storage/records.hpp"

namespace fleetproof {

struct RunOptions {
  int workers = 1;
  std::string worker_logs;  // prefix of the files that take what plug-ins print; empty: it is dropped
  EarlierLogs earlier_logs = EarlierLogs::Stay;  // of a campaign that goes on
  bool audits = false;                           // simulate a share of the runs once more
  bool overwrite = false;    // replace an existing results file, once the new one is complete; else it goes on
  bool allow_drift = false;  // go on in a file that another engine wrote, and record it
  // Stop cleanly then; the time before the first run counts, too.
  std::optional<std::chrono::steady_clock::time_point> deadline;
  std::uint64_t fail_fast = 0;                    // stop after so many failed runs, in order of run index; 0: never
  bool until_verdict = false;                     // stop when the gates that decide have given the verdict
  const std::atomic<int>* interrupted = nullptr;  // non-zero: a signal number; stop handing out runs
};

// Whether a signal or the deadline ends a session.
bool must_stop(const RunOptions& options);

// Runs are counted with those that an earlier session stored, but for `simulated`.
struct Progress {
  std::uint64_t simulated = 0, done = 0, planned = 0, violating = 0, engine_errors = 0;
  std::uint64_t audited = 0, audits_open = 0;  // open: still to do
  std::uint64_t disturbed = 0;                 // runs whose worker somebody else may have ended
  double elapsed_s = 0.0;
  std::vector<RunRepeat> repeats{};  // of runs beyond their limit, under way
};

struct CampaignResult {
  Progress progress;
  std::vector<WorkerLoss> losses;  // the first of them
  std::uint64_t loss_count = 0;
  std::uint64_t audits_differing = 0;               // of the audits of this session
  std::map<std::string, CloserLooks> closer_looks;  // of this session, by agent
  std::string audit_failure;                        // why audits ended before their time; empty: they did not
  std::uint64_t stored = 0;  // the number of runs in the gap-free prefix that the results file contains
  int threads = 0;
  bool complete() const { return stored == progress.planned; }
  // Counts them, and keeps the first of them.
  void add(std::vector<WorkerLoss> lost);
};

// A run that was handed out and has not finished.
struct RunUnderWay {
  std::uint64_t run_index = 0;
  double since_s = 0.0;  // for so long
};

// What a running campaign reports, on the caller's thread.
struct CampaignListener {
  std::function<void()> started = [] {};  // the file was found or opened, no run has begun
  std::function<void(const RunRecord&)> run_finished = [](const RunRecord&) {};
  std::function<void(const Progress&)> tick = [](const Progress&) {};  // about ten times a second
  // Asked about ten times a second; true: `status` is called once.
  std::function<bool()> wants_status = [] { return false; };
  std::function<void(const Progress&, const std::vector<RunUnderWay>&)> status = [](const auto&, const auto&) {};
  std::function<void(const std::string&)> warned = [](const std::string&) {};  // before the file is opened
  std::function<void(const TakenOver&)> took_over = [](const TakenOver&) {};  // of a file that goes on, after `started`
};

// What differs between a session of a campaign and one of a shard: where runs and audits go, and what ends it.
class SessionPolicy {
 public:
  virtual ~SessionPolicy() = default;

  // The run at this place among those to do.
  virtual std::uint64_t run_at(std::uint64_t place) const { return place; }
  // `audited`: the audit of the run will follow.
  virtual void keep(const RunRecord& run, bool audited) = 0;
  virtual void keep(const AuditedRun& finding) = 0;
  virtual void tick() = 0;  // about ten times a second
  // Whether no more runs should finish before their audits do.
  virtual bool is_far_ahead() const { return false; }
  // Whether the results so far end the session.
  virtual bool is_decided() const { return false; }
  // If a session is asked to stop, each piece of so many places that was begun comes to its end, with its audits. 0: no
  // other run begins, the runs under way get four seconds, and audits stay open.
  virtual std::uint64_t piece() const { return 0; }
};

// Hands out runs, hands those that finish and their audits to the policy, and reports. It counts, stops and reports on
// the caller's thread.
class Session {
 public:
  // All that it is given outlives it.
  Session(const CampaignPlan& plan, const AgentPrograms& programs, const RunOptions& options,
          const CampaignListener& listener);

  const RunOptions& options() const { return options_; }
  RunHost& runs() { return runs_; }
  AuditQueue& audits() { return audits_; }
  Progress& progress() { return result_.progress; }
  // A run of the campaign is done, in this session or in an earlier one.
  void count(const RunRecord& run);

  // `places`: the runs to do, as `run_at` names them; workers and group are those of the session. The policy says how
  // many runs are stored.
  CampaignResult run(SessionPolicy& policy, TaskRange places);

 private:
  using Clock = std::chrono::steady_clock;
  using UnderWay = std::function<std::vector<RunUnderWay>()>;

  void simulate(SessionPolicy& policy, TaskRange places);
  void finish_audits(SessionPolicy& policy);
  void take(SessionPolicy& policy, const RunRecord& run);
  void stop_if_due(const SessionPolicy& policy, AnyTaskPool& pool);
  void tick_if_due(SessionPolicy& policy, const UnderWay& under_way);
  void keep_findings(SessionPolicy& policy);
  double elapsed_s() const;

  const RunOptions& options_;
  const CampaignListener& listener_;
  const std::uint64_t group_;  // of runs in one world
  RunHost runs_;
  AuditQueue audits_;
  CampaignResult result_;
  Clock::time_point started_, last_tick_;
  std::optional<Clock::time_point> stopped_;  // nothing that was begun is brought to its end
};

}  // namespace fleetproof
