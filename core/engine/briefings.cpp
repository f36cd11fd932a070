#include "core/engine/briefings.hpp"

#include <algorithm>

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

// As the agent's calls name it.
std::uint32_t segment_of(const Lane* lane) {
  if (lane == nullptr) return FP_NONE;
  return lane->is_backward() ? lane->segment.value | FP_BACKWARD : lane->segment.value;
}

}  // namespace

Briefings::Briefings(const Scenario& scenario, const char* agent_config, bool share_facts) {
  describe_permissions(scenario);
  describe_map(*scenario.map);
  describe_fleet(scenario);
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    fp_briefing briefing{};
    briefing.struct_size = sizeof(fp_briefing);
    briefing.self = static_cast<std::uint32_t>(i);
    briefing.fleet_count = static_cast<std::uint32_t>(fleet_.size());
    briefing.agv_stride = sizeof(fp_agv);
    briefing.fleet = fleet_.data();
    briefing.map = &map_;
    briefing.start_station = scenario.agvs[i].start.value;
    briefing.script_count = static_cast<std::uint32_t>(scripts_[i].size());
    briefing.script = scripts_[i].data();
    briefing.safety_distance_m = scenario.law.safety_distance_m;
    briefing.radio_range_m = scenario.radio.range_m;
    briefing.config = agent_config;
    briefing.boot = 0;
    briefing.start_segment = FP_NONE;
    briefing.next_segment = FP_NONE;
    if (facts_.empty() || !share_facts) facts_.emplace_back(briefing);
    briefing.facts = &facts_.back().facts();
    briefings_.push_back(briefing);
  }
}

void Briefings::renew(AgvId agv, std::uint32_t boot, StationId station, const Lane* lane, const Lane* next) {
  fp_briefing& briefing = briefings_[agv.index()];
  briefing.boot = boot;
  briefing.start_station = station.value;
  briefing.start_segment = segment_of(lane);
  briefing.next_segment = segment_of(next);
}

void Briefings::describe_permissions(const Scenario& scenario) {
  for (const Segment& segment : scenario.map->layout().segments) {
    auto& permissions = permissions_.emplace_back();
    for (const auto& [vehicle_type, load] : segment.permissions)
      permissions.push_back({type_named(scenario, vehicle_type), static_cast<std::uint32_t>(load)});
  }
}

void Briefings::describe_map(const LogicalMap& map) {
  std::size_t arc_count = 0;
  for (const Lane& lane : map.lanes()) arc_count += lane.arcs.size();
  arcs_.reserve(arc_count);  // the lanes point into it
  for (const Lane& lane : map.lanes()) describe_lane(map, lane);
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

void Briefings::describe_lane(const LogicalMap& map, const Lane& lane) {
  const fp_arc* first = arcs_.data() + arcs_.size();
  for (const Arc& arc : lane.arcs) arcs_.push_back({c_pose(arc.start), arc.length_m, arc.curvature_per_m});
  const Segment& segment = map.segment(lane.segment);
  const auto& permissions = permissions_[lane.segment.index()];
  lanes_.push_back({lane.segment.value, lane.from.value, lane.to.value, lane.curve.length_m(),
                    static_cast<std::uint32_t>(lane.arcs.size()), first, lane.speed_limit_mps, segment.width_m,
                    static_cast<std::uint32_t>(segment.blocks.size()), segment.blocks.data(),
                    lane.is_backward() ? 1U : 0U, static_cast<std::uint32_t>(permissions.size()), permissions.data()});
}

void Briefings::describe_fleet(const Scenario& scenario) {
  for (const AgvSetup& agv : scenario.agvs) {
    fleet_.push_back(c_agv(scenario.type_of(agv), agv.type));
    auto& script = scripts_.emplace_back();
    static_assert(SegmentId{}.value == FP_HERE, "a call without a segment is for where the AGV stands");
    for (const ScriptedCall& call : agv.script)
      script.push_back({call.at.count(), static_cast<std::uint32_t>(call.action),
                        call.segment.value | (call.backward ? FP_BACKWARD : 0U)});
  }
}

}  // namespace fleetproof
