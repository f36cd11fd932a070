#include "core/bridges/vda5050/vehicle_profile.hpp"

namespace fleetproof::bridges::vda5050 {
namespace {

constexpr const char* kLoadId = "loadId";

// The body around the reference point, which follows the lane; closed by its first point.
Envelope body_of(const fp_agv& vehicle, double length_m, double width_m, const char* set) {
  const double front = vehicle.centre_ahead_m + length_m / 2.0, rear = vehicle.centre_ahead_m - length_m / 2.0,
               side = width_m / 2.0;
  return {set, {{front, side}, {rear, side}, {rear, -side}, {front, -side}, {front, side}}};
}

ProtocolFeatures features() {
  ProtocolFeatures features;
  features.optional_parameters = {{"order.nodes.nodePosition", Support::Supported}};
  for (const Ability& ability : vehicle_abilities().actions) {
    AgvAction action{ability.action_type, {ActionScope::Node}, {}, ability.blocking_types};
    if (!ability.needed_parameters.empty()) action.action_parameters = {{{kLoadId, ValueType::String, false}}};
    features.agv_actions.push_back(std::move(action));
  }
  for (const char* own : {"cancelOrder", "startPause", "stopPause", "stateRequest", "factsheetRequest", "initPosition"})
    features.agv_actions.push_back({own, {ActionScope::Instant}, {}, {}});
  return features;
}

}  // namespace

Abilities vehicle_abilities() {
  Abilities abilities;
  abilities.actions = {{"pick", true, false, false, {kLoadId}, false, false, {BlockingType::Hard}},
                       {"drop", true, false, false, {kLoadId}, false, false, {BlockingType::Hard}},
                       {"startCharging", true, false, false, {}, false, false, {BlockingType::Hard}}};
  return abilities;
}

Factsheet factsheet_of(const fp_agv& vehicle, const char* type_name) {
  Factsheet sheet;
  sheet.type_specification.series_name = type_name;
  sheet.type_specification.localization_types = {"NATURAL"};
  sheet.type_specification.navigation_types = {"VIRTUAL_LINE_GUIDED"};
  sheet.physical_parameters.speed_max = vehicle.speed_mps;
  sheet.physical_parameters.acceleration_max = vehicle.acceleration_mps2;
  sheet.physical_parameters.deceleration_max = vehicle.deceleration_mps2;
  sheet.physical_parameters.length = vehicle.length_m;
  sheet.physical_parameters.width = vehicle.width_m;
  sheet.protocol_limits.timing.default_state_interval = 30.0;
  sheet.protocol_features = features();
  sheet.agv_geometry.envelopes2d = {body_of(vehicle, vehicle.length_m, vehicle.width_m, "empty"),
                                    body_of(vehicle, vehicle.loaded_length_m, vehicle.loaded_width_m, "loaded")};
  return sheet;
}

}  // namespace fleetproof::bridges::vda5050
