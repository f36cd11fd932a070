#pragma once

#include <memory>

#include "core/bridges/wrapped/fault_words.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::wrapped {

// A program with a fault around it, as an agent type with data of its own. What is disturbed follows from the events
// that the program hears and from its own clock, so a run has the same digest every time. Threads: those that the
// program inside serves.
class WrappedProgram {
 public:
  // `inside` outlives this object; it may be a wrapped program.
  WrappedProgram(const fp_agent_type& inside, const Fault& fault);
  ~WrappedProgram();
  WrappedProgram(const WrappedProgram&) = delete;
  WrappedProgram& operator=(const WrappedProgram&) = delete;

  // Lives as long as this object. Its name is that of the program inside, kWith, and the words of the fault.
  const fp_agent_type& type() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetproof::wrapped
