#pragma once

#include <string>

#include "campaign/workers/forker.hpp"
#include "campaign/workers/shared_slots.hpp"

namespace fleetproof {

// What the main process found before it ended a worker.
enum class WorkerState : std::uint8_t { Closed, BeyondCpuLimit, BeyondMemory, Asleep, Garbled };

// Why the run of a worker has no outcome.
struct CauseOfDeath {
  bool hang = false;           // it did not end by itself
  bool from_outside = false;   // SIGKILL that did not come from here: the run may not be the reason
  bool with_forker = false;    // the forker was killed, perhaps by the run of another worker
  bool maybe_outside = false;  // somebody else may have ended it, stopped it, or kept it waiting
  std::uint64_t call = 0;      // the last call into an agent, as counted by CallNote; 0: none
  // For the row of the run: nothing in it depends on the machine or its load.
  std::string message;
};

CauseOfDeath cause_of_death(WorkerState state, const WorkerDeath& death, const WorkerSlot& slot);

}  // namespace fleetproof
