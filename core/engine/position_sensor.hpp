#pragma once

#include <list>
#include <vector>

#include "core/engine/run_context.hpp"

namespace fleetproof {

// Where an AGV's controller believes the AGV to be: late, and wrong by another error every tenth of a second.
class PositionSensor {
 public:
  explicit PositionSensor(RunContext& run);

  // Call this just before the AGV's piece in the world ends: a late sensor still looks back at it.
  void piece_ends(AgvId agv);
  Pose perceived(AgvId agv) const;
  // The AGV has been carried: its position is the new one from now on.
  void forget(AgvId agv) { past_[agv.index()].clear(); }

 private:
  RunContext& run_;
  std::vector<Duration> late_;          // by AGV
  std::vector<std::list<Piece>> past_;  // by AGV, oldest first; a list: none need no memory
};

}  // namespace fleetproof
