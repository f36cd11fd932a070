// The seam to code that is not part of this program: what a plug-in holds, who may call by it, and what is put right
// after each call.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/strong_id.hpp"
#include "core/engine/agent_call.hpp"
#include "core/engine/processor_state.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

class ForeignHandles;

// What an agent of a plug-in gets as its fp_controller. It stays in memory after the agent's end, so that a thread that
// still calls by it is refused and noticed. Only the thread that has called the agent may call back, and only while it
// does. Threads: any number call `admits`.
struct ForeignHandle {
  explicit ForeignHandle(ForeignHandles& owner) : home(owner) {}

  ForeignHandles& home;
  fp_controller* controller = nullptr;  // of the AGV; valid while `caller` is set
  std::atomic<std::uint32_t> agv{0};
  std::atomic<const void*> caller{nullptr};  // the thread that is in a call of this agent; null: none is
  std::atomic<const void*> thread{nullptr};  // the thread on which the agent lives; null: it has been destroyed
  std::atomic<bool> called_by_other_thread{false};

  // False: nothing of the run may be touched. The call is noted as a fault of the agent, unless the agent has called
  // for another AGV of its fleet from its own thread.
  bool admits();
};

// The handles of one plug-in, for all runs in this process. A handle rests for long before another agent gets it.
// Threads: any number.
class ForeignHandles {
 public:
  // Whether the plug-in was loaded with another state of the processor than the engine's: its runs count that, too.
  explicit ForeignHandles(bool changed_processor = false) : changed_processor_(changed_processor) {}

  bool changed_processor() const { return changed_processor_; }
  ForeignHandle& lend(AgvId agv, fp_controller* controller);
  void take_back(ForeignHandle& handle);
  // The AGV of an agent that has called after its end, since the last question. Not valid: none has.
  AgvId take_late_caller();

 private:
  friend struct ForeignHandle;
  static constexpr std::size_t kMostResting = 16'384;

  const bool changed_processor_;
  std::mutex mutex_;
  std::deque<ForeignHandle> all_;
  std::deque<ForeignHandle*> resting_;
  std::atomic<std::uint32_t> late_caller_{AgvId().value};
};

// The calls into the agents of one run whose code is foreign, or which are recorded.
class ForeignCalls {
 public:
  explicit ForeignCalls(ForeignHandles& handles) : handles_(handles) {}
  ~ForeignCalls();
  ForeignCalls(const ForeignCalls&) = delete;
  ForeignCalls& operator=(const ForeignCalls&) = delete;

  // What the agent of this AGV gets when it is created.
  fp_controller* lend(AgvId agv, fp_controller* controller);
  // The agent is gone. Not empty: which calls of this software were not allowed.
  std::string take_back(AgvId agv);
  // How many calls have left another state of the processor behind.
  std::uint64_t processor_changes() const { return processor_changes_; }
  // After a call: from here on the thread computes as the engine does.
  void look_at_processor();

  // A call that is under way: the agent may call back. After it, the thread computes as the engine does.
  class UnderWay {
   public:
    UnderWay(ForeignCalls& calls, AgvId agv);
    ~UnderWay();
    UnderWay(const UnderWay&) = delete;
    UnderWay& operator=(const UnderWay&) = delete;

   private:
    ForeignCalls& calls_;
    ForeignHandle& handle_;
  };

 private:
  ForeignHandle*& handle_of(AgvId agv);

  ForeignHandles& handles_;
  std::vector<ForeignHandle*> lent_;  // by AGV; null: it has no agent
  std::uint64_t processor_changes_ = 0;
};

}  // namespace fleetproof
