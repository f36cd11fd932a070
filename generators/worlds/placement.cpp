#include "generators/worlds/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/base/random.hpp"
#include "generators/map/waiting_room.hpp"
#include "generators/scenario_file/validator.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kNoAgv = ~0U;  // item of draws that belong to no AGV

// Where the next AGV may stand: stations not drawn yet.
class Candidates {
 public:
  Candidates(const LogicalMap& map, const Reachability& reachability) {
    for (const auto station : reachability.starts())
      (is_place_to_wait(map.station(station)) ? waiting_ : others_).push_back(station);
  }

  // A station that suits this AGV. Those that do not suit it remain candidates for other AGVs.
  template <class Suits>
  std::optional<StationId> draw(Draws& draws, const Suits& suits) {
    std::vector<StationId> unsuitable[2];
    std::optional<StationId> found;
    while (!found && !(waiting_.empty() && others_.empty())) {
      auto& from = waiting_.empty() ? others_ : waiting_;
      const auto n = draws.below(static_cast<std::uint32_t>(from.size()));
      const auto station = from[n];
      from[n] = from.back();
      from.pop_back();
      if (suits(station)) {
        found = station;
      } else {
        unsuitable[&from == &waiting_ ? 0 : 1].push_back(station);
      }
    }
    waiting_.insert(waiting_.end(), unsuitable[0].begin(), unsuitable[0].end());
    others_.insert(others_.end(), unsuitable[1].begin(), unsuitable[1].end());
    return found;
  }

 private:
  std::vector<StationId> waiting_, others_;
};

// The reason why an AGV cannot start like this; none if it can.
std::optional<ProblemKind> rejection(const Scenario& scenario, const AgvSetup& agv) {
  const double distance_m = scenario.law.safety_distance_m;
  const auto body = start_body(scenario, agv);
  for (const auto& other : scenario.agvs) {
    if (closer_than(start_body(scenario, other), body, distance_m)) return ProblemKind::StartsTooClose;
  }
  for (const auto& obstacle : scenario.obstacles) {
    if (obstacle.appears == Duration::zero() &&
        closer_than(placed(obstacle.footprint, obstacle.pose), body, distance_m))
      return ProblemKind::StartNearObstacle;
  }
  return std::nullopt;
}

// Heading along one of the lanes that leave the station.
bool add_agv_at(Scenario& scenario, const Reachability& reachability, std::uint32_t type, StationId station,
                Draws& draws, RejectionCounts& counts) {
  auto lanes = scenario.map->lanes_from(station);
  std::erase_if(lanes, [&](std::uint32_t lane) { return !reachability.may_start_along(lane, type); });
  if (lanes.empty()) {
    ++counts.starts_tried;
    ++counts.of(ProblemKind::StartWithoutLane);
    return false;
  }
  const auto& lane = scenario.map->lanes()[lanes[draws.below(static_cast<std::uint32_t>(lanes.size()))]];
  return add_agv(scenario, station, lane.start_heading(), counts);
}

}  // namespace

Placement placement_of_world(Placement placement, std::uint64_t key) {
  if (placement != Placement::Mixed) return placement;
  const auto n = Draws(key, kNoAgv, kNoAgv).below(10);
  return n < 4   ? Placement::Adversarial
         : n < 7 ? Placement::Random
         : n < 9 ? Placement::ChargerBank
                 : Placement::Symmetric;
}

bool place_fleet(Scenario& scenario, FleetTypes types, const Reachability& reachability, std::uint64_t key,
                 std::uint32_t attempt, RejectionCounts& counts) {
  Candidates candidates(*scenario.map, reachability);
  while (scenario.agvs.size() < types.size()) {
    const std::uint32_t type = types[scenario.agvs.size()];
    Draws draws(key, attempt, static_cast<std::uint32_t>(scenario.agvs.size()));
    while (true) {
      const auto station = candidates.draw(draws, [&](StationId s) { return reachability.use_of(s, type).started; });
      if (!station) {
        ++counts.fleets_without_room;
        return false;
      }
      if (add_agv_at(scenario, reachability, type, *station, draws, counts)) break;
    }
  }
  return true;
}

bool place_at_charger_bank(Scenario& scenario, FleetTypes types, const Reachability& reachability, std::uint64_t key,
                           std::uint32_t attempt, RejectionCounts& counts) {
  const LogicalMap& map = *scenario.map;
  std::vector<StationId> banks;
  for (const auto s : reachability.starts()) {
    if (map.station(s).purposes.has(Purpose::Charging)) banks.push_back(s);
  }
  if (banks.empty()) banks = places_to_start(map, reachability);
  if (banks.empty()) {
    ++counts.fleets_without_room;
    return false;
  }
  const auto bank = banks[Draws(key, attempt, kNoAgv).below(static_cast<std::uint32_t>(banks.size()))];
  auto stations = reachability.starts();
  const auto distance = [&](StationId s) {
    return (map.station(s).position_m - map.station(bank).position_m).squaredNorm();
  };
  std::ranges::stable_sort(stations, {}, distance);
  while (scenario.agvs.size() < types.size()) {
    const std::uint32_t type = types[scenario.agvs.size()];
    // Stations where this type cannot start stay for AGVs of other types.
    const auto nearest =
        std::ranges::find_if(stations, [&](StationId s) { return reachability.use_of(s, type).started; });
    if (nearest == stations.end()) {
      ++counts.fleets_without_room;
      return false;
    }
    const StationId station = *nearest;
    stations.erase(nearest);
    Draws draws(key, attempt, static_cast<std::uint32_t>(scenario.agvs.size()));
    add_agv_at(scenario, reachability, type, station, draws, counts);
  }
  return true;
}

std::vector<StationId> places_to_start(const LogicalMap& map, const Reachability& reachability) {
  std::vector<StationId> places;
  for (const auto s : reachability.starts()) {
    if (is_place_to_wait(map.station(s))) places.push_back(s);
  }
  return places.empty() ? reachability.starts() : places;
}

bool add_agv(Scenario& scenario, StationId start, const Vec2& heading, RejectionCounts& counts) {
  AgvSetup agv;
  agv.name = fmt::format("AGV {}", scenario.agvs.size());  // the id that archive, report and agents use
  agv.start = start;
  agv.heading = heading + Vec2::Zero();  // without negative zeros, which files do not keep
  ++counts.starts_tried;
  if (const auto reason = rejection(scenario, agv)) {
    ++counts.of(*reason);
    return false;
  }
  scenario.agvs.push_back(std::move(agv));
  return true;
}

}  // namespace fleetproof
