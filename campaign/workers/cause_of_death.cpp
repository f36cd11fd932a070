#include "campaign/workers/cause_of_death.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <csignal>

#include "campaign/run/memory_limit.hpp"
#include "campaign/workers/worker.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {
namespace {

std::string signal_words(int number) {
  switch (number) {
    case SIGSEGV:
      return "segmentation fault (SIGSEGV)";
    case SIGBUS:
      return "bus error (SIGBUS)";
    case SIGABRT:
      return "aborted (SIGABRT)";
    case SIGFPE:
      return "arithmetic fault (SIGFPE)";
    case SIGILL:
      return "illegal instruction (SIGILL)";
    case SIGKILL:
      return "killed (SIGKILL)";
    default:
      return fmt::format("ended by signal {}", number);
  }
}

std::string end_words(WorkerState state, const WorkerDeath& death, const WorkerSlot& slot) {
  if (state == WorkerState::BeyondCpuLimit) return "uses CPU time without end";
  if (state == WorkerState::BeyondMemory) return "needs more memory than limits.memory_mb";
  if (state == WorkerState::Asleep) return "waits without end";
  if (state == WorkerState::Garbled) return "spoiled the answer of its process";
  if (death.with_forker) return "killed the process that starts the workers";
  if (slot.stack_overflow.load() != 0) return "stack overflow (SIGSEGV)";
  const bool could_not_answer = WIFEXITED(death.status) && WEXITSTATUS(death.status) == kChannelClosedExit;
  if (death.had_to_be_killed || could_not_answer) return "closed the descriptors of its process";
  if (WIFSIGNALED(death.status)) return signal_words(WTERMSIG(death.status));
  if (WEXITSTATUS(death.status) == kOutOfMemoryExit) return "needs more memory than limits.memory_mb";
  return fmt::format("ended its process with exit code {}", WEXITSTATUS(death.status));
}

std::string call_words(const CallNote& call) {
  if (call.number.load() == 0) return "before the first call of an agent";
  constexpr std::array kEvents{"event start",       "event order", "event message",  "event timer",
                               "event action done", "event fault", "event withdrawn"};
  static_assert(FP_EVENT_START == 0 && FP_EVENT_WITHDRAWN == kEvents.size() - 1);
  constexpr std::uint32_t kLastEvent = kEvents.size() - 1;
  const std::uint32_t event = call.event.load();
  const char* const called = event == CallNote::kDestroy      ? "destroy()"
                             : event == CallNote::kKnowsFault ? "knows_fault()"
                             : event == CallNote::kRunEnds    ? "run_ends()"
                                                              : kEvents.at(std::min(event, kLastEvent));
  return fmt::format("in {} at {:.9f} s", called, to_seconds(at_ns(call.at_ns.load())));
}

}  // namespace

CauseOfDeath cause_of_death(WorkerState state, const WorkerDeath& death, const WorkerSlot& slot) {
  CauseOfDeath cause;
  cause.hang = state == WorkerState::BeyondCpuLimit || state == WorkerState::Asleep;
  cause.with_forker = death.with_forker;
  cause.from_outside = state == WorkerState::Closed && !death.with_forker && !death.had_to_be_killed &&
                       WIFSIGNALED(death.status) && WTERMSIG(death.status) == SIGKILL;
  cause.maybe_outside = cause.from_outside || cause.with_forker || state == WorkerState::Asleep;
  cause.call = slot.call.number.load();
  cause.message = fmt::format("{} {}", end_words(state, death, slot), call_words(slot.call));
  return cause;
}

}  // namespace fleetproof
