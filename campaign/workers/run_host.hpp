#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "campaign/run/run_one.hpp"
#include "campaign/workers/isolated_runs.hpp"

namespace fleetproof {

// Simulates each run where its agent belongs: a reference agent on the thread of the caller, a plug-in in a worker
// process. Threads: as many as there are workers.
class RunHost {
 public:
  // `plan` and `programs` outlive it. An agent of the plan may be missing among the programs until one of its runs is
  // simulated.
  RunHost(const CampaignPlan& plan, const AgentPrograms& programs, const Hosting& hosting);

  // None after abandon(). Throws what RunOne and IsolatedRuns throw.
  std::optional<RunRecord> operator()(std::uint64_t run_index);
  // From now on, failed runs of the agent at this position of the plan have a recording of what it did, or have none.
  // Without this call none have. Reference agents are never recorded.
  void record(std::size_t agent, bool on) { records_[agent] = on; }
  // The runs under way end within a second, without a record.
  void abandon();
  // Of plug-ins so far; 0: none was simulated.
  std::uint64_t slowest_cpu_ns() const { return isolated_ ? isolated_->slowest_cpu_ns() : 0; }
  // Of worker processes, since the last call.
  std::vector<WorkerLoss> take_losses();
  std::vector<RunRepeat> repeats() const;  // that are under way

 private:
  RunOne run_one_;
  std::vector<bool> is_plugin_;            // by position in plan.agents
  std::deque<std::atomic<bool>> records_;  // by position in plan.agents
  std::atomic<bool> abandoned_ = false;
  std::unique_ptr<IsolatedRuns> isolated_;  // null: no agent of the plan is a plug-in
};

}  // namespace fleetproof
