#pragma once

#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof {

// What the shared object at `path` says of its agent. A process of its own loads the object, so that an object that
// crashes, hangs, prints or takes all memory while it is loaded harms nothing here. It may use what one run may. The
// result has no `type`. Throws InputError with what
// is wrong with the object.
AgentProgram inspect_agent(const std::string& path, bool global_symbols, const LimitSetup& limits = {});

}  // namespace fleetproof
