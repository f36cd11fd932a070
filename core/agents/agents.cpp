#include "core/agents/agents.h"

#include <iterator>

#include "core/agents/agent_type.hpp"
#include "core/agents/central/programs.hpp"
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace {
using namespace fleetproof::agents;

struct ReferenceAgent {
  const fp_agent_type* type;
  uint32_t most_of_each;  // stations, drives, AGVs; FP_NONE: any number
};
constexpr ReferenceAgent kWithoutPlantedFault[] = {{&kScripted, FP_NONE},
                                                   {&kHullLock, kNumbersOnTheWire},
                                                   {&kReckless, FP_NONE},
                                                   {&central::kFollower, kNumbersOnTheWire},
                                                   {&central::kZoneServer, kNumbersOnTheWire}};
}  // namespace

extern "C" {
const fp_agent_type* fp_reference_agent(uint32_t number) {
  constexpr uint32_t others = std::size(kWithoutPlantedFault);
  return number < others ? kWithoutPlantedFault[number].type : fp_faulty_agent(number - others);
}

const fp_agent_type* fp_faulty_agent(uint32_t number) {
  return number < kFaultyAgents.size() ? &kFaultyAgents[number].type : nullptr;
}

const fp_agent_type* fp_sound_agent(const fp_agent_type* faulty) {
  for (const FaultyAgent& known : kFaultyAgents) {
    if (&known.type == faulty) return known.sound;
  }
  return nullptr;
}

uint32_t fp_reference_agent_limit(const fp_agent_type* agent) {
  for (const ReferenceAgent& known : kWithoutPlantedFault) {
    if (known.type == agent) return known.most_of_each;
  }
  return kNumbersOnTheWire;  // one with a planted fault
}
}
