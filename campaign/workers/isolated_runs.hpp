#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/case_run.hpp"
#include "campaign/run/run_one.hpp"
#include "campaign/workers/cause_of_death.hpp"
#include "campaign/workers/forker.hpp"
#include "campaign/workers/run_order.hpp"
#include "campaign/workers/shared_slots.hpp"
#include "campaign/workers/worker_logs.hpp"
#include "campaign/workers/worker_watch.hpp"

namespace fleetproof {

// A run that a worker process did not bring to its end. For the log of the session, not for the archive.
struct WorkerLoss {
  std::uint64_t run_index = 0;
  std::string message, log;        // what happened; the file with what the worker printed
  std::vector<std::string> stack;  // of a worker that ended with a signal, as its log has it
  bool in_fresh_worker = false;
  WorkerDeath death;
};

// A run that did not end within its limit, and is repeated.
struct RunRepeat {
  std::uint64_t run_index = 0;
  double limit_s = 0.0;     // of CPU time, beyond which it was
  double at_most_s = 0.0;   // the CPU time of the next attempt
  std::uint64_t hangs = 0;  // calls of it that were found to hang
  friend bool operator==(const RunRepeat&, const RunRepeat&) = default;
};

// How runs are hosted.
struct Hosting {
  int workers = 1;
  std::string log_prefix{};  // "x" makes x.worker-0.log and so on; empty: what agents print is dropped
  EarlierLogs earlier_logs = EarlierLogs::Stay;
  bool audits = false;  // the runs have been simulated before: their memory is disturbed in another way
};

// Which process hosts a run: one that hosts others, too, or one that hosts no other.
enum class HostProcess : bool { Shared, Own };

// How one scenario is simulated.
struct CaseWishes {
  Deliveries deliveries = Deliveries::Ignored;
  FailureChoice choice{};
  const std::atomic<bool>* abandon = nullptr;  // true: its worker is ended within a second, and RunAbandoned thrown
  bool recorded = false;                       // what its agents do
  std::optional<std::uint64_t> as_audit{};     // in a process of its own, with a memory disturbed as by this audit
};

// Simulates runs of plug-ins in worker processes: software that crashes or hangs there costs its run, and no more. A
// worker hosts many runs, one after the other, until it has used 20 times the CPU time of its start and first run. Each
// run gives the record that RunOne would give, if the software allows it. A run that ends its worker is repeated in a
// fresh worker, unless it crashed in one; what ends it there is filed in the record, as a crash or hang at that call of
// an agent, and the run goes on without that agent. Threads: as many as there are workers.
class IsolatedRuns {
 public:
  // `plan` and `programs` outlive it.
  IsolatedRuns(const CampaignPlan& plan, const AgentPrograms& programs, const Hosting& hosting);

  // Throws RunAbandoned after abandon(), MachineError if no worker can be started, EngineError if a plug-in's file has
  // changed. `record`: the record of a failed run, and that of every audit, has a recording of what its agents did.
  RunRecord operator()(std::uint64_t run_index, bool record = false, HostProcess process = HostProcess::Shared);
  // The checksum of the row of a run, as the campaign simulates it in a new process that has served `before` first.
  std::uint64_t checksum_after(const std::vector<std::uint64_t>& before, std::uint64_t run_index);
  // As the operator, for one scenario and the first agent of the plan.
  CaseRun of_case(const Scenario& scenario, const CaseWishes& wishes);
  // The calls at which the agents' software crashes or hangs in it, in their order: where these are known, the scenario
  // can be simulated in this process. Nothing if the software does not end at the same call twice.
  std::optional<std::vector<KnownEnd>> ends_in(const Scenario& scenario);
  // All runs under way end within a second.
  void abandon() { abandoned_ = true; }
  // The CPU time of the slowest run so far; the limit of each run follows it. A higher one may come from elsewhere.
  std::uint64_t slowest_cpu_ns() const { return slowest_ns_; }
  void expect_cpu_ns(std::uint64_t cpu_ns);
  // The losses since the last call.
  std::vector<WorkerLoss> take_losses();
  std::vector<RunRepeat> repeats() const;  // that are under way

 private:
  struct Member {
    int slot = 0;
    Forker::Worker worker;  // pid 0: not started
    bool fresh = true;      // it has finished no run yet
  };
  struct Attempt {
    std::optional<RunAnswer> answer;
    CauseOfDeath cause;
    bool in_fresh_worker = false;
  };

  // Attempts happen beside each other. One that must tell whether it kills the forker happens alone.
  class Turn;
  // Tells of a repeat as long as it lives.
  class ToldRepeat;

  // Whether so many ends of workers are what somebody else does to them.
  bool may_be_from_outside(std::uint64_t ends) const;
  Member take_member();
  void give_back(Member member);
  Attempt attempt(Member& member, const RunOrder& order, WorkerWatch::Limits limits, bool alone = false);
  // Of these two, empty: the worker may take an order, or has answered. Throws EngineError if it says that it cannot.
  std::optional<WorkerState> start(Member& member);
  std::optional<WorkerState> take_answer(Member& member, WorkerWatch::Limits limits, RunAnswer& answer,
                                         const std::atomic<bool>* abandon = nullptr);
  void retire(Member& member);
  Attempt lost(Member& member, std::uint64_t run_index, WorkerState state);
  RunAnswer repeat(Member& member, RunOrder& order, const CauseOfDeath& first);
  RunAnswer answer_of(Member& member, RunOrder& order);
  // Leaves in it the ends that were found. The runs `before` are simulated first, by the same worker.
  RunAnswer answer_of(RunOrder& order, HostProcess process = HostProcess::Shared,
                      const std::vector<std::uint64_t>& before = {});
  RunAnswer unexplained(const RunOrder& order, const CauseOfDeath& cause) const;
  double cpu_limit_s(std::uint64_t run_index) const;

  const CampaignPlan& plan_;
  const AgentPrograms& programs_;
  Hosting hosting_;
  std::string setup_;  // of each worker
  RunOne run_one_;
  SharedSlots slots_;
  WorkerLogs logs_;
  Forker forker_;
  CaseWriter cases_;
  std::atomic<bool> abandoned_ = false;
  std::atomic<std::uint64_t> hosted_ = 0, ended_from_outside_ = 0;  // runs of the plan; of their workers
  std::atomic<std::uint64_t> slowest_ns_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable member_back_, turn_over_;
  int turns_ = 0, wait_to_be_alone_ = 0;
  std::vector<Member> idle_;
  std::vector<WorkerLoss> losses_;
  std::vector<RunRepeat> repeats_;
};

}  // namespace fleetproof
