#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Within the contract of the radio (loss <= 40 %, delay <= 2 s), a fleet must work and not only be safe. The law looks
// at every whole second.
//
// - Safe mode: accuses an AGV that declares safe mode while every link to it has kept the contract, without a break,
//   for longer than scenario.law.reaction_s. A link is judged by its last 10 s (link_quality.hpp).
// - Standstill: accuses a fleet with open transports in which no AGV has driven, turned, picked, dropped or charged for
//   stuck_after, while all links of all AGVs kept the contract.
// - Throughput: accuses a fleet that finished fewer transports per AGV-hour than
//   scenario.law.min_transports_per_agv_hour, if this floor is above 0 and transports were open at the end. All links
//   must have kept the contract during the whole run.
//
// The law does not see safe mode that no agent declares. A link without messages, or out of range, counts as keeping
// the contract.
std::unique_ptr<Law> make_normal_operation_law(const Scenario& scenario);

}  // namespace fleetproof
