#include "core/agents/agents.h"

#include <iterator>

#include "core/agents/agent_type.hpp"

namespace {
using namespace fleetproof::agents;
}

extern "C" {
const fp_agent_type* const fp_reference_agents[] = {&kScripted, &kHullLock, &kTimeoutGrant, &kReckless};
const uint32_t fp_reference_agent_count = std::size(fp_reference_agents);
}
