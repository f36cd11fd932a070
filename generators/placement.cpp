#include "generators/placement.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/random.hpp"
#include "generators/validator.hpp"

namespace fleetproof {
namespace {

bool is_place_to_wait(const Station& station) {
  return station.purposes.has(Purpose::Parking) || station.purposes.has(Purpose::Charging) || station.purposes.has(Purpose::Storage);
}

// Where the next AGV may stand: stations not drawn yet.
class Candidates {
 public:
  Candidates(const LogicalMap& map, const Reachability& reachability) {
    for (const auto station : reachability.core()) (is_place_to_wait(map.station(station)) ? waiting_ : others_).push_back(station);
  }

  std::optional<StationId> draw(Draws& draws) {
    auto& from = waiting_.empty() ? others_ : waiting_;
    if (from.empty()) return std::nullopt;
    const auto n = draws.below(static_cast<std::uint32_t>(from.size()));
    const auto station = from[n];
    from[n] = from.back();
    from.pop_back();
    return station;
  }

 private:
  std::vector<StationId> waiting_, others_;
};

// Why an AGV cannot start like this; nothing if it can.
std::optional<ProblemKind> rejection(const Scenario& scenario, const AgvSetup& agv, const std::vector<OrientedRectangle>& bodies) {
  const double distance_m = scenario.law.safety_distance_m;
  const auto body = start_body(scenario, agv);
  for (const auto& other : bodies) {
    if (closer_than(other, body, distance_m)) return ProblemKind::StartsTooClose;
  }
  for (const auto& obstacle : scenario.obstacles) {
    if (obstacle.appears == Duration::zero() && closer_than(placed(obstacle.footprint, obstacle.pose), body, distance_m)) return ProblemKind::StartNearObstacle;
  }
  return std::nullopt;
}

}  // namespace

bool place_fleet(Scenario& scenario, std::uint32_t fleet_size, const Reachability& reachability, std::uint64_t key, std::uint32_t attempt,
                 RejectionCounts& counts) {
  const LogicalMap& map = *scenario.map;
  Candidates candidates(map, reachability);
  std::vector<OrientedRectangle> bodies;
  scenario.agvs.clear();
  while (scenario.agvs.size() < fleet_size) {
    const auto number = static_cast<std::uint32_t>(scenario.agvs.size());
    Draws draws(key, attempt, number);
    AgvSetup agv;
    agv.name = fmt::format("AGV {}", number);  // the id that archive, report and agents use
    while (true) {
      const auto station = candidates.draw(draws);
      if (!station) {
        ++counts.fleets_without_room;
        return false;
      }
      ++counts.starts_tried;
      const auto& lanes = map.lanes_from(*station);
      if (lanes.empty()) {
        ++counts.of(ProblemKind::StartWithoutLane);
        continue;
      }
      const auto& lane = map.lanes()[lanes[draws.below(static_cast<std::uint32_t>(lanes.size()))]];
      agv.start = *station;
      agv.heading = lane.curve.pose_at(0.0).heading + Vec2::Zero();  // without negative zeros, which files do not keep
      const auto reason = rejection(scenario, agv, bodies);
      if (!reason) break;
      ++counts.of(*reason);
    }
    bodies.push_back(start_body(scenario, agv));
    scenario.agvs.push_back(std::move(agv));
  }
  return true;
}

}  // namespace fleetproof
