#include "laws/inferred_waits.hpp"

#include "core/base/tolerances.hpp"
#include "core/scenario/ways.hpp"

namespace fleetproof {
namespace {

constexpr double kPoseStep_m = 0.1;  // between poses of the way

// Calls `visit` with what the AGV covers at each of these poses; ends when it returns false.
template <class Visit>
void for_poses_along(const Lane& lane, const Footprint& footprint, const Visit& visit) {
  const double length_m = lane.curve.length_m();
  const int steps = static_cast<int>(length_m / kPoseStep_m) + 1;
  for (int step = 0; step <= steps; ++step) {
    if (!visit(placed(footprint, lane.curve.pose_at(length_m * step / steps)))) return;
  }
}

}  // namespace

const Lane* first_lane_of_way(const LaneRules& rules, StationId from, StationId to) {
  const ShortestWay way = shortest_ways(rules.map, from, to, &rules).back();
  return way.to == to ? way.first : nullptr;
}

InferredWaits::InferredWaits(const Scenario& scenario, const Whereabouts& bodies)
    : scenario_(scenario), bodies_(bodies), answers_(scenario.agvs.size()) {}

EntityId InferredWaits::of(EntityId agv, StationId goal, bool loaded, SimTime now) {
  Answer& answer = answers_[agv.index()];
  const std::uint64_t piece_number = bodies_.piece_number(agv);
  const bool is_known = answer.piece_number == piece_number && answer.goal == goal && answer.loaded == loaded;
  if (!is_known || bodies_.moves(agv)) {
    answer.piece_number = piece_number;
    answer.goal = goal;
    answer.loaded = loaded;
    find_lane(answer, agv, now);
  }
  if (answer.lane == nullptr) return {};
  if (answer.changes == bodies_.changes()) return answer.first;
  answer.changes = bodies_.changes();
  find_neighbours(answer.swept, agv);
  if (answer.neighbours != neighbours_) {
    answer.neighbours.swap(neighbours_);
    answer.first = first_in_the_way(agv, *answer.lane, now);
  }
  return answer.first;
}

StationId InferredWaits::station_of(EntityId agv, SimTime now) const {
  const Vec2 position_m = bodies_.position_m(agv, now);
  const auto& stations = scenario_.map->layout().stations;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if ((stations[i].position_m - position_m).norm() <= kAtStation_m) return StationId{i};
  }
  return {};
}

void InferredWaits::find_lane(Answer& answer, EntityId agv, SimTime now) const {
  answer.lane = nullptr;
  answer.neighbours.clear(), answer.first = {}, answer.changes = 0;
  const StationId here = station_of(agv, now);
  if (!here.valid()) return;
  const LaneRules rules{*scenario_.map, scenario_.type_of(scenario_.agvs[agv.index()]).name, answer.loaded};
  answer.lane = first_lane_of_way(rules, here, answer.goal);
  if (answer.lane == nullptr) return;
  Box box;
  for_poses_along(*answer.lane, bodies_.of(agv).footprint, [&](const OrientedRectangle& mine) {
    box.add(mine);
    return true;
  });
  answer.swept = box.grown(scenario_.law.safety_distance_m + kTouch_m);
}

void InferredWaits::find_neighbours(const Box& swept, EntityId agv) {
  neighbours_.clear();
  for (std::size_t i = 0; i < bodies_.entity_count(); ++i) {
    const EntityId other{i};
    if (other == agv || !bodies_.on_floor(other) || bodies_.moves(other)) continue;
    if (swept.overlaps(bodies_.of(other).planned_box)) neighbours_.push_back({other, bodies_.piece_number(other)});
  }
}

// Of those in answer.neighbours, the first along the lane; of equals by number.
EntityId InferredWaits::first_in_the_way(EntityId agv, const Lane& lane, SimTime now) const {
  EntityId first;
  for_poses_along(lane, bodies_.of(agv).footprint, [&](const OrientedRectangle& mine) {
    for (const auto& [other, piece_number] : answers_[agv.index()].neighbours) {
      if (clearance_m(mine, bodies_.of(other).body_at(now)) >= scenario_.law.safety_distance_m) continue;
      first = other;
      break;
    }
    return !first.valid();
  });
  return first;
}

}  // namespace fleetproof
