#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// `FleetTold`: fp_briefing or fp_facts.
template <class FleetTold>
const fp_agv& agv_of(const FleetTold& told, std::uint32_t id) {
  return *fp_agv_at(told.fleet, told.agv_stride, id);
}

// Whether the host tells what came with minor 2: reference points, driving backward, permissions.
template <class FleetTold>
bool tells_minor_2(const FleetTold& told) {
  return told.agv_stride >= offsetof(fp_agv, vehicle_type) + sizeof(fp_agv::vehicle_type);
}

// The top speed of an AGV, forward or backward.
template <class FleetTold>
double highest_speed_mps(const FleetTold& told, std::uint32_t id) {
  const fp_agv& agv = agv_of(told, id);
  return tells_minor_2(told) ? std::max(agv.speed_mps, agv.reverse_speed_mps) : agv.speed_mps;
}

}  // namespace fleetproof::agents
