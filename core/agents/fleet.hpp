#pragma once

#include <cstddef>
#include <cstdint>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

inline const fp_agv& agv_of(const fp_briefing& briefing, std::uint32_t id) {
  return *reinterpret_cast<const fp_agv*>(reinterpret_cast<const char*>(briefing.fleet) +
                                          std::size_t{briefing.agv_stride} * id);
}

}  // namespace fleetproof::agents
