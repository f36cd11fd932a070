#pragma once

#include <memory>
#include <string_view>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::lockstep {

// Control software in a process of its own, as an agent type with data of its own. Threads: one at a time.
class LockstepProgram {
 public:
  // Starts the command once and lets it introduce itself. Throws std::runtime_error, which says why it cannot be used.
  // From here on this process ignores SIGPIPE.
  explicit LockstepProgram(std::string_view command);
  ~LockstepProgram();
  LockstepProgram(const LockstepProgram&) = delete;
  LockstepProgram& operator=(const LockstepProgram&) = delete;

  // Lives as long as this object.
  const fp_agent_type& type() const;
  // The next run finds processes that have served no other.
  void renew();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetproof::lockstep
