#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/workers/channel.hpp"
#include "campaign/workers/run_order.hpp"
#include "campaign/workers/shared_slots.hpp"

namespace fleetproof {

// With this exit code a worker says that a run needed more than the memory limit.
inline constexpr int kOutOfMemoryExit = 96;
// And with this one that it could not answer.
inline constexpr int kChannelClosedExit = 97;

// What every worker process has from the process that it was forked from.
struct WorkerSetup {
  const CampaignPlan& plan;
  const AgentPrograms& programs;  // known here, loaded in the worker
  const SharedSlots& slots;
  std::vector<int> logs;  // by slot: the descriptor that takes what agents print; -1: nothing does
  std::string program;    // not empty: the worker becomes this program (fresh_program.hpp)
};

// The life of a worker: loads the plug-ins, then takes one order after the other until the channel is closed. Call this
// in a process of its own.
[[noreturn]] void work(const WorkerSetup& setup, int slot, Channel channel);

// Takes one order after the other until the channel is closed. `programs` are loaded here.
void take_orders(
    const CampaignPlan& plan, const AgentPrograms& programs, WorkerSlot& slot, Channel& channel,
    const std::function<void(const RunOrder& order)>& before_each = [](const RunOrder&) {});

// The addresses that this process has mapped, in bytes.
std::uint64_t mapped_bytes();

// From now on this process may map so many megabytes beyond `own_bytes`; 0: no limit. A lower limit can be lifted
// again.
void limit_memory(std::uint64_t memory_mb, std::uint64_t own_bytes);

// Calls `life` and ends the process. If it throws, the channel or the exit code says why.
[[noreturn]] void answer_failures(Channel& channel, const std::function<void()>& life);

}  // namespace fleetproof
