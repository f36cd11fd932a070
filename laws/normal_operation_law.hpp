#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Within the contract of the radio (loss <= 40 %, delay <= 2 s) a fleet has to work, not only to be safe. Looks at
// every whole second.
//
// Safe mode: accuses an AGV that is in safe mode, as it declares, while every link to it has kept the contract without
// a break for longer than scenario.law.reaction_s. Whether a link keeps the contract at an instant is judged by its
// last 10 s (link_quality.hpp). Standstill: accuses a fleet with open transports in which nobody has driven, turned,
// picked or dropped for stuck_after, while all links of all AGVs kept the contract for all that time. Throughput:
// accuses a fleet that finished fewer transports per AGV-hour than scenario.law.min_transports_per_agv_hour, if that is
// above 0 and there were open transports at the end, and only if all links kept the contract throughout.
//
// It does not see safe mode that nobody declares, and takes a link on which nothing was sent, or out of range, for one
// that keeps the contract.
std::unique_ptr<Law> make_normal_operation_law(const Scenario& scenario);

}  // namespace fleetproof
