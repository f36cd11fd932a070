#pragma once

#include <cstdint>
#include <span>

#include "core/agents/facts.hpp"
#include "core/agents/hull_parts.hpp"

namespace fleetproof::agents {

// The first AGV of the fleet that is like this one: what is worked out for it holds for both.
std::uint32_t model_of(const fp_facts& facts, std::uint32_t agv);

// Of one AGV, by lane; the AGVs of a run share them.
// The time from rest to rest.
std::span<const double> lane_times_s(const fp_facts& facts, std::uint32_t agv);
// The same, and a price against the conventions of aisles and of opposite lanes.
std::span<const double> lane_costs_s(const HullParts& parts, std::uint32_t agv);
// By station: a lower bound of the cost of the way to the goal, with these costs of lanes; infinite where there is no
// way. `model`: of the AGV.
std::span<const float> remaining_costs_s(const HullParts& parts, std::uint32_t model, std::uint32_t goal);

}  // namespace fleetproof::agents
