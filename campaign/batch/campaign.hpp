#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/batch/task_pool.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/workers/isolated_runs.hpp"
#include "storage/records.hpp"

namespace fleetproof {

struct RunOptions {
  int workers = 1;
  std::string worker_logs;    // prefix of the files that take what plug-ins print; empty: it is dropped
  std::string audit_program;  // is started for audits (campaign/workers/fresh_program.hpp); empty: no audits
  bool overwrite = false;     // replace an existing results file, once the new one is complete; else it goes on
  bool allow_drift = false;   // go on in a file that another engine wrote, and record it
  // Stop cleanly then; the time before the first run counts, too.
  std::optional<std::chrono::steady_clock::time_point> deadline;
  std::uint64_t fail_fast = 0;                    // stop after so many failed runs, in order of run index; 0: never
  bool until_verdict = false;                     // stop when the gates that decide have given the verdict
  const std::atomic<int>* interrupted = nullptr;  // non-zero: a signal number; stop handing out runs
};

// Runs are counted with those that an earlier session stored, but for `simulated`.
struct Progress {
  std::uint64_t simulated = 0, done = 0, planned = 0, violating = 0, engine_errors = 0;
  std::uint64_t audited = 0, audits_open = 0;  // open: still to do
  double elapsed_s = 0.0;
};

struct CampaignResult {
  Progress progress;
  std::vector<WorkerLoss> losses;  // the first of them
  std::uint64_t loss_count = 0;
  std::uint64_t audits_differing = 0;  // of the audits of this session
  std::string audit_failure;           // why audits ended before their time; empty: they did not
  std::uint64_t stored = 0;            // the number of runs in the gap-free prefix that the results file contains
  int threads = 0;
  bool complete() const { return stored == progress.planned; }
  // Counts them, and keeps the first of them.
  void add(std::vector<WorkerLoss> lost);
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
};

// Runs the plan and leaves its results file at `path`. Agents of plug-ins run in worker processes
// (campaign/workers); reference agents run on the threads of the pool. A share of the runs is audited beside them. Rows
// are stored when their runs finish. The published file contains the gap-free prefix of run indices. The same runs
// therefore give the same bytes with any number of workers, in any order of finishing, in one session or several. A
// file that exists already goes on: its runs are not simulated again. Throws InputError and writes nothing if an agent
// is not known, if a layout has no room for its fleet, or if the file holds another campaign.
CampaignResult run_campaign(const CampaignPlan& plan, const AgentPrograms& programs, const std::string& path,
                            const RunOptions& options, const CampaignListener& listener);

// Whether a signal or the deadline ends a session.
bool must_stop(const RunOptions& options);

}  // namespace fleetproof
