#include "core/engine/told_plant.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace fleetproof {
namespace {

fp_pose c_pose(const Pose& pose) {
  return {pose.position_m.x(), pose.position_m.y(), pose.heading.x(), pose.heading.y()};
}

fp_agv c_agv(const VehicleType& type, std::uint32_t number) {
  const Footprint loaded = type.footprint_with(true);
  return {type.footprint.length_m,
          type.footprint.width_m,
          type.drive.speed_mps,
          type.drive.acceleration_mps2,
          type.drive.deceleration_mps2,
          type.turn.speed_radps,
          type.turn.acceleration_radps2,
          type.turn.deceleration_radps2,
          loaded.length_m,
          loaded.width_m,
          type.speed_deviation,
          type.footprint.centre_ahead_m,
          type.reverse_speed_mps,
          number};
}

// The number of the type with this name. A type that is not in the fleet has the number after the last.
std::uint32_t type_named(const Scenario& scenario, const std::string& name) {
  if (name.empty()) return FP_ANY_TYPE;
  const auto& types = scenario.vehicle_types;
  return static_cast<std::uint32_t>(std::ranges::find(types, name, &VehicleType::name) - types.begin());
}

std::vector<std::string> names_of_types(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const VehicleType& type : scenario.vehicle_types) names.push_back(type.name);
  return names;
}

// Without the padding at its end.
bool is_same(const fp_agv& a, const fp_agv& b) {
  return std::memcmp(&a, &b, offsetof(fp_agv, vehicle_type) + sizeof(a.vehicle_type)) == 0;
}

std::vector<fp_agv> fleet_of(const Scenario& scenario) {
  std::vector<fp_agv> fleet;
  for (const AgvSetup& agv : scenario.agvs) fleet.push_back(c_agv(scenario.type_of(agv), agv.type));
  return fleet;
}

}  // namespace

ToldPlant::ToldPlant(const Scenario& scenario)
    : of_map_(scenario.map),
      type_names_(names_of_types(scenario)),
      conflicts_(scenario),
      safety_distance_m_(scenario.law.safety_distance_m),
      fleet_(fleet_of(scenario)) {
  for (const std::string& name : type_names_) c_type_names_.push_back(name.c_str());
  for (const Segment& segment : of_map_->layout().segments) segment_names_.push_back(segment.name.c_str());
  describe_permissions(scenario);
  describe_map();
  facts_ = empty_store();
}

bool ToldPlant::fits(const Scenario& scenario) const {
  return of_map_ == scenario.map && safety_distance_m_ == scenario.law.safety_distance_m &&
         type_names_ == names_of_types(scenario) && conflicts_.fits(scenario) &&
         std::ranges::equal(fleet_, fleet_of(scenario), is_same);
}

std::optional<bool> ToldPlant::conflict(const fp_occupancy& a, const fp_occupancy& b, double margin_m) {
  return conflicts_.answer(a, b, margin_m);
}

std::unique_ptr<FactStore> ToldPlant::empty_store() const {
  return std::make_unique<FactStore>(map_, fleet_.data(), static_cast<std::uint32_t>(fleet_.size()), sizeof(fp_agv),
                                     safety_distance_m_);
}

void ToldPlant::describe_permissions(const Scenario& scenario) {
  permissions_.reserve(scenario.map->segment_count());
  for (const Segment& segment : scenario.map->layout().segments) {
    auto& permissions = permissions_.emplace_back();
    for (const auto& [vehicle_type, load] : segment.permissions)
      permissions.push_back({type_named(scenario, vehicle_type), static_cast<std::uint32_t>(load)});
  }
}

void ToldPlant::describe_map() {
  const LogicalMap& map = *of_map_;
  std::size_t arc_count = 0;
  for (const Lane& lane : map.lanes()) arc_count += lane.arcs.size();
  arcs_.reserve(arc_count);  // the lanes point into it
  lanes_.reserve(map.lanes().size()), stations_.reserve(map.station_count());
  for (const Lane& lane : map.lanes()) describe_lane(lane);
  for (const SegmentBlock& block : map.layout().blocks)
    blocks_.push_back({block.name.c_str(), static_cast<std::uint32_t>(block.kind)});
  for (std::size_t i = 0; i < map.station_count(); ++i) {
    const Station& station = map.station(StationId{i});
    const auto& leaving = map.lanes_from(StationId{i});
    const Vec2 heading = station.heading.value_or(Vec2::Zero());
    stations_.push_back({station.name.c_str(), station.position_m.x(), station.position_m.y(), station.purposes.bits(),
                         static_cast<std::uint32_t>(leaving.size()), leaving.data(), station.turning ? 0U : 1U,
                         heading.x(), heading.y()});
  }
  map_ = {sizeof(fp_map),
          static_cast<std::uint32_t>(stations_.size()),
          static_cast<std::uint32_t>(lanes_.size()),
          static_cast<std::uint32_t>(map.segment_count()),
          sizeof(fp_station),
          sizeof(fp_lane),
          sizeof(fp_arc),
          stations_.data(),
          lanes_.data(),
          static_cast<std::uint32_t>(blocks_.size()),
          sizeof(fp_block),
          blocks_.data()};
}

void ToldPlant::describe_lane(const Lane& lane) {
  const fp_arc* first = arcs_.data() + arcs_.size();
  for (const Arc& arc : lane.arcs) arcs_.push_back({c_pose(arc.start), arc.length_m, arc.curvature_per_m});
  const Segment& segment = of_map_->segment(lane.segment);
  const auto& permissions = permissions_[lane.segment.index()];
  lanes_.push_back({lane.segment.value, lane.from.value, lane.to.value, lane.curve.length_m(),
                    static_cast<std::uint32_t>(lane.arcs.size()), first, lane.speed_limit_mps, segment.width_m,
                    static_cast<std::uint32_t>(segment.blocks.size()), segment.blocks.data(),
                    lane.is_backward() ? 1U : 0U, static_cast<std::uint32_t>(permissions.size()), permissions.data()});
}

}  // namespace fleetproof
