#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "campaign/workers/isolated_runs.hpp"
#include "reports/evidence/audit_share.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Runs of an agent that came out differently and were looked at closer: they depend on the runs that their process has
// served before, or this could not be shown.
struct CloserLooks {
  std::uint64_t dependent = 0, other = 0;
};

// Simulates a share of the finished runs once more: in processes that are started afresh, with other addresses, other
// bytes in fresh memory, and in another order; audit_finding.hpp says what counts. Works beside the campaign, on
// threads of its own. Threads: the caller's one.
class AuditQueue {
 public:
  // `audits`: no: nothing is audited. `plan` and `programs` outlive it.
  AuditQueue(const CampaignPlan& plan, const AgentPrograms& programs, bool audits, int workers);
  ~AuditQueue();
  AuditQueue(const AuditQueue&) = delete;
  AuditQueue& operator=(const AuditQueue&) = delete;

  // Takes the run in if it belongs to the share. `slowest_cpu_ns`: what a run of the campaign took at most so far, so
  // that no audit has a lower limit than its run had.
  // A run that had ended in another way before has been audited by that.
  // True: it will be audited, unless the queue fails or is told to abandon.
  bool offer(const RunRecord& run, std::uint64_t slowest_cpu_ns = 0);
  void start();

  void no_more_runs();  // what waits is audited, in batches of any size
  void hurry();         // the same once, for what waits now
  void abandon();       // nothing more is audited; the audits under way end within a second
  bool idle() const;    // nothing waits, and neither an audit nor a closer look is under way
  std::uint64_t open_count() const;
  bool is_far_behind() const;  // of the campaign, which waits then
  // Why no more is audited, for example because the file of a plug-in was changed; empty: nothing went wrong. The
  // campaign goes on: its runs do not need the audits.
  std::string failure() const;
  // The findings since the last call.
  std::vector<AuditedRun> take_findings();
  // By agent; only of those that were looked at.
  std::map<std::string, CloserLooks> closer_looks() const;

 private:
  using Batch = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // run index, checksum of its row

  void work();
  Batch next_batch();
  std::vector<std::uint64_t> audit(const Batch& batch);  // returns the runs that came out differently
  void look_closer(std::uint64_t run_index);
  bool depends_on_earlier_runs(std::uint64_t run_index);
  HostProcess process_for(std::uint64_t run_index);

  const CampaignPlan& plan_;
  AuditShare share_;
  RunOne run_one_;               // plays tapes
  std::vector<bool> is_plugin_;  // by position of the agent in the plan
  int threads_wanted_;
  std::unique_ptr<IsolatedRuns> runs_;  // null: nothing is audited

  mutable std::mutex mutex_;
  std::condition_variable more_;
  std::map<std::uint64_t, std::uint64_t> waiting_;  // run index -> checksum of its row
  std::size_t wanted_;                              // so many runs must wait before a batch is begun
  std::uint64_t found_ = 0;
  std::vector<std::uint64_t> begun_;  // audits, by position of the agent in the plan
  int hung_ = 0;
  std::size_t under_way_ = 0, threads_looking_ = 0;
  std::map<std::string, CloserLooks> looks_;
  std::map<std::string, int> looks_begun_;
  bool closing_ = false, abandoned_ = false;
  std::atomic<bool> stop_playing_ = false;
  std::vector<AuditedRun> findings_;
  std::string failure_;
  std::vector<std::thread> threads_;
};

}  // namespace fleetproof
