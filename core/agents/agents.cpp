#include "core/agents/agents.h"

#include <iterator>

#include "core/agents/agent_type.hpp"
#include "core/agents/faulty/faulty_agents.hpp"

namespace {
using namespace fleetproof::agents;

constexpr const fp_agent_type* kWithoutPlantedFault[] = {&kScripted, &kHullLock, &kReckless};
}  // namespace

extern "C" {
const fp_agent_type* fp_reference_agent(uint32_t number) {
  constexpr uint32_t others = std::size(kWithoutPlantedFault);
  return number < others ? kWithoutPlantedFault[number] : fp_faulty_agent(number - others);
}

const fp_agent_type* fp_faulty_agent(uint32_t number) {
  return number < kFaultyAgents.size() ? &kFaultyAgents[number] : nullptr;
}
}
