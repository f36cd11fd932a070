#pragma once

#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// Why AGVs stand: each halt has a reason and a number. The first one brakes the AGV, wherever it is; when the last one
// is over, the AGV goes on with what it was doing. A halt by the agent holds motion only. So the first halt for another
// reason brakes once more, and when the last of those is over, what needs no motion goes on.
class Halts {
 public:
  Halts(RunContext& run, ActionsPort actions);

  // Returns the number of the halt, which is never 0.
  std::uint64_t begin(AgvId agv, Halt::Reason reason);
  // Nothing happens if that halt is over already.
  void end(AgvId agv, std::uint64_t number);
  void end_all(AgvId agv, Halt::Reason reason);
  // The AGV is taken off the floor: nothing holds it any more, and it does not go on.
  void forget(AgvId agv) { run_.status(agv).halts.clear(); }

 private:
  RunContext& run_;
  ActionsPort actions_;
  std::vector<std::uint64_t> begun_;  // by AGV
};

}  // namespace fleetproof
