#pragma once

#include <cstddef>
#include <cstdint>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

inline const fp_agv& agv_of(const fp_briefing& briefing, std::uint32_t id) {
  return *reinterpret_cast<const fp_agv*>(reinterpret_cast<const char*>(briefing.fleet) +
                                          std::size_t{briefing.agv_stride} * id);
}

// Whether the host tells what came with minor 2: reference points, driving backward, permissions.
inline bool tells_minor_2(const fp_briefing& briefing) {
  return briefing.agv_stride >= offsetof(fp_agv, vehicle_type) + sizeof(fp_agv::vehicle_type);
}

}  // namespace fleetproof::agents
