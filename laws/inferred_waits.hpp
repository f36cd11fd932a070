// What stands in the way of an AGV that does not say for whom it waits.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/scenario/lane_rules.hpp"
#include "laws/whereabouts.hpp"

namespace fleetproof {

// The first lane of a shortest way from one station to another for which the AGV has permission; null if there is no
// way, or if both are one station.
const Lane* first_lane_of_way(const LaneRules& rules, StationId from, StationId to);

// For whom AGVs wait that stand at a station and have a goal. What does not change is not worked out again: a fleet
// that stands for an hour is asked about hundreds of times.
class InferredWaits {
 public:
  // Requires: both outlive the object.
  InferredWaits(const Scenario& scenario, const Whereabouts& bodies);

  // The first resting body in the way of `agv` along the first lane of a shortest way to `goal`: it is closer than the
  // safety distance to what the AGV would sweep. Invalid if there is none, if no way leads there, or if the AGV stands
  // at no station.
  EntityId of(EntityId agv, StationId goal, bool loaded, SimTime now);

 private:
  // A body that rests near the lane, and the number of its piece.
  using Neighbour = std::pair<EntityId, std::uint64_t>;
  // About one AGV. The lane holds for one piece of the AGV, one goal and one load; who is in the way holds as long as
  // the neighbours stay.
  struct Answer {
    std::uint64_t piece_number = 0;  // of the AGV; 0: nothing is known
    StationId goal;
    bool loaded = false;
    const Lane* lane = nullptr;  // null: none
    Box swept;                   // what the AGV would sweep, grown by the safety distance
    std::uint64_t changes = 0;   // of the whereabouts of all bodies
    std::vector<Neighbour> neighbours;
    EntityId first;
  };

  StationId station_of(EntityId agv, SimTime now) const;
  void find_lane(Answer& answer, EntityId agv, SimTime now) const;
  void find_neighbours(const Box& swept, EntityId agv);
  EntityId first_in_the_way(EntityId agv, const Lane& lane, SimTime now) const;

  const Scenario& scenario_;
  const Whereabouts& bodies_;
  std::vector<Answer> answers_;        // by AGV
  std::vector<Neighbour> neighbours_;  // as of now
};

}  // namespace fleetproof
