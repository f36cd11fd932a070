#pragma once

#include "core/base/error.hpp"

namespace fleetproof {

// The machine failed: a full or failing disk, no memory or process to be had, a helper process that somebody killed.
// It is no fault of the engine, and nothing is damaged. `what` ends with the remedy.
class MachineError : public EngineError {
 public:
  using EngineError::EngineError;
};

}  // namespace fleetproof
