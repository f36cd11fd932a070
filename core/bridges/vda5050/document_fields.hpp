#pragma once

#include <array>
#include <concepts>
#include <limits>

#include "core/bridges/vda5050/documents.hpp"

// The fields of all documents, in one list for each struct. Reading and writing both go through these lists. A field
// is required unless it is a std::optional. `varying` fields are not part of every version.
namespace fleetproof::bridges::vda5050 {

template <class T, class U>
concept Of = std::same_as<std::remove_const_t<T>, U>;

inline constexpr double kMostRadians = 3.14159265359;  // as the schemas round it
inline constexpr double kUnbounded = std::numeric_limits<double>::max();

template <class E>
inline constexpr auto kWordsOf = nullptr;
template <>
inline constexpr std::array kWordsOf<BlockingType> = {"NONE", "SOFT", "HARD"};
template <>
inline constexpr std::array kWordsOf<CorridorReference> = {"KINEMATICCENTER", "CONTOUR"};
template <>
inline constexpr std::array kWordsOf<OrientationType> = {"GLOBAL", "TANGENTIAL"};
template <>
inline constexpr std::array kWordsOf<MapStatus> = {"ENABLED", "DISABLED"};
template <>
inline constexpr std::array kWordsOf<ActionStatus> = {"WAITING", "INITIALIZING", "RUNNING",
                                                      "PAUSED",  "FINISHED",     "FAILED"};
template <>
inline constexpr std::array kWordsOf<OperatingMode> = {"AUTOMATIC", "SEMIAUTOMATIC", "MANUAL", "SERVICE", "TEACHIN"};
template <>
inline constexpr std::array kWordsOf<ErrorLevel> = {"WARNING", "FATAL"};
template <>
inline constexpr std::array kWordsOf<InfoLevel> = {"DEBUG", "INFO"};
template <>
inline constexpr std::array kWordsOf<EmergencyStop> = {"AUTOACK", "MANUAL", "REMOTE", "NONE"};
template <>
inline constexpr std::array kWordsOf<ConnectionState> = {"ONLINE", "OFFLINE", "CONNECTIONBROKEN"};
template <>
inline constexpr std::array kWordsOf<Support> = {"SUPPORTED", "REQUIRED"};
template <>
inline constexpr std::array kWordsOf<ActionScope> = {"INSTANT", "NODE", "EDGE"};
template <>
inline constexpr std::array kWordsOf<ValueType> = {"BOOL", "NUMBER", "INTEGER", "FLOAT", "STRING", "OBJECT", "ARRAY"};

// A header is no object of its own: its fields stand in the message.
void list_fields(auto& f, Of<Header> auto& header) {
  f("headerId", header.header_id);
  f.instant("timestamp", header.timestamp);
  f("version", header.version);
  f("manufacturer", header.manufacturer);
  f("serialNumber", header.serial_number);
}

void list_fields(auto& f, Of<Action> auto& action) {
  f("actionType", action.action_type);
  f("actionId", action.action_id);
  f("actionDescription", action.action_description);
  f("blockingType", action.blocking_type);
  f("actionParameters", action.action_parameters);
}

void list_fields(auto& f, Of<ActionParameter> auto& parameter) {
  f("key", parameter.key);
  f.any_value("value", parameter);
}

void list_fields(auto& f, Of<NodePosition> auto& position) {
  f("x", position.x);
  f("y", position.y);
  f.within("theta", position.theta, -kMostRadians, kMostRadians);
  f.within("allowedDeviationXY", position.allowed_deviation_xy, 0.0, kUnbounded);
  f.within("allowedDeviationTheta", position.allowed_deviation_theta, 0.0, kMostRadians);
  f("mapId", position.map_id);
  f("mapDescription", position.map_description);
}

void list_fields(auto& f, Of<Node> auto& node) {
  f("nodeId", node.node_id);
  f("sequenceId", node.sequence_id);
  f("nodeDescription", node.node_description);
  f("released", node.released);
  f("nodePosition", node.node_position);
  f("actions", node.actions);
}

void list_fields(auto& f, Of<ControlPoint> auto& point) {
  f("x", point.x);
  f("y", point.y);
  f.within("weight", point.weight, 0.0, kUnbounded);
}

void list_fields(auto& f, Of<Trajectory> auto& trajectory) {
  f.within("degree", trajectory.degree, 1.0, kUnbounded);
  f.within("knotVector", trajectory.knot_vector, 0.0, 1.0);
  f("controlPoints", trajectory.control_points);
}

void list_fields(auto& f, Of<Corridor> auto& corridor) {
  f.within("leftWidth", corridor.left_width, 0.0, kUnbounded);
  f.within("rightWidth", corridor.right_width, 0.0, kUnbounded);
  f("corridorRefPoint", corridor.corridor_ref_point);
}

void list_fields(auto& f, Of<Edge> auto& edge) {
  f("edgeId", edge.edge_id);
  f("sequenceId", edge.sequence_id);
  f("edgeDescription", edge.edge_description);
  f("released", edge.released);
  f("startNodeId", edge.start_node_id);
  f("endNodeId", edge.end_node_id);
  f("maxSpeed", edge.max_speed);
  f("maxHeight", edge.max_height);
  f("minHeight", edge.min_height);
  f.within("orientation", edge.orientation, -kMostRadians, kMostRadians);
  f("orientationType", edge.orientation_type);
  f("direction", edge.direction);
  f("rotationAllowed", edge.rotation_allowed);
  f("maxRotationSpeed", edge.max_rotation_speed);
  f("trajectory", edge.trajectory);
  f("length", edge.length);
  f.varying("edge.corridor", edge.corridor);
  f("actions", edge.actions);
}

void list_fields(auto& f, Of<Order> auto& order) {
  list_fields(f, order.header);
  f("orderId", order.order_id);
  f("orderUpdateId", order.order_update_id);
  f("zoneSetId", order.zone_set_id);
  f("nodes", order.nodes);
  f("edges", order.edges);
}

void list_fields(auto& f, Of<InstantActions> auto& message) {
  list_fields(f, message.header);
  f("actions", message.actions);
}

void list_fields(auto& f, Of<Map> auto& map) {
  f("mapId", map.map_id);
  f("mapVersion", map.map_version);
  f("mapDescription", map.map_description);
  f("mapStatus", map.map_status);
}

void list_fields(auto& f, Of<NodeState> auto& node) {
  f("nodeId", node.node_id);
  f("sequenceId", node.sequence_id);
  f("released", node.released);
}

void list_fields(auto& f, Of<EdgeState> auto& edge) {
  f("edgeId", edge.edge_id);
  f("sequenceId", edge.sequence_id);
  f("released", edge.released);
}

void list_fields(auto& f, Of<AgvPosition> auto& position) {
  f("positionInitialized", position.position_initialized);
  f("x", position.x);
  f("y", position.y);
  f.within("theta", position.theta, -kMostRadians, kMostRadians);
  f("mapId", position.map_id);
}

void list_fields(auto& f, Of<Load> auto& load) {
  f("loadId", load.load_id);
  f("loadType", load.load_type);
  f("loadPosition", load.load_position);
  f.within("weight", load.weight, 0.0, kUnbounded);
}

void list_fields(auto& f, Of<ActionState> auto& state) {
  f("actionId", state.action_id);
  f("actionType", state.action_type);
  f("actionStatus", state.action_status);
  f("resultDescription", state.result_description);
}

void list_fields(auto& f, Of<BatteryState> auto& battery) {
  f("batteryCharge", battery.battery_charge);
  f("charging", battery.charging);
}

void list_fields(auto& f, Of<Reference> auto& reference) {
  f("referenceKey", reference.reference_key);
  f("referenceValue", reference.reference_value);
}

void list_fields(auto& f, Of<Error> auto& error) {
  f("errorType", error.error_type);
  f.may_be_missing("errorReferences", error.error_references);
  f("errorDescription", error.error_description);
  f.varying("error.errorHint", error.error_hint);
  f("errorLevel", error.error_level);
}

void list_fields(auto& f, Of<Info> auto& info) {
  f("infoType", info.info_type);
  f.may_be_missing("infoReferences", info.info_references);
  f("infoDescription", info.info_description);
  f("infoLevel", info.info_level);
}

void list_fields(auto& f, Of<SafetyState> auto& safety) {
  f("eStop", safety.e_stop);
  f("fieldViolation", safety.field_violation);
}

void list_fields(auto& f, Of<State> auto& state) {
  list_fields(f, state.header);
  f.varying("state.maps", state.maps);
  f("orderId", state.order_id);
  f("orderUpdateId", state.order_update_id);
  f("lastNodeId", state.last_node_id);
  f("lastNodeSequenceId", state.last_node_sequence_id);
  f("nodeStates", state.node_states);
  f("edgeStates", state.edge_states);
  f("agvPosition", state.agv_position);
  f("loads", state.loads);
  f("driving", state.driving);
  f("paused", state.paused);
  f("newBaseRequest", state.new_base_request);
  f("actionStates", state.action_states);
  f("batteryState", state.battery_state);
  f("operatingMode", state.operating_mode);
  f("errors", state.errors);
  f("information", state.information);
  f("safetyState", state.safety_state);
}

void list_fields(auto& f, Of<Connection> auto& connection) {
  list_fields(f, connection.header);
  f("connectionState", connection.connection_state);
}

void list_fields(auto& f, Of<TypeSpecification> auto& type) {
  f("seriesName", type.series_name);
  f("agvKinematic", type.agv_kinematic);
  f("agvClass", type.agv_class);
  f("maxLoadMass", type.max_load_mass);
  f("localizationTypes", type.localization_types);
  f("navigationTypes", type.navigation_types);
}

void list_fields(auto& f, Of<PhysicalParameters> auto& physical) {
  f("speedMin", physical.speed_min);
  f("speedMax", physical.speed_max);
  f("accelerationMax", physical.acceleration_max);
  f("decelerationMax", physical.deceleration_max);
  f("heightMin", physical.height_min);
  f("heightMax", physical.height_max);
  f("width", physical.width);
  f("length", physical.length);
}

void list_fields(auto& f, Of<StringLimits> auto& limits) {
  f("msgLen", limits.msg_len);
  f("idLen", limits.id_len);
  f("enumLen", limits.enum_len);
  f("loadIdLen", limits.load_id_len);
}

void list_fields(auto& f, Of<ArrayLimits> auto& limits) {
  f("order.nodes", limits.order_nodes);
  f("order.edges", limits.order_edges);
  f("node.actions", limits.node_actions);
  f("edge.actions", limits.edge_actions);
  f("instantActions", limits.instant_actions);
  f("state.actionStates", limits.state_action_states);
  f("state.errors", limits.state_errors);
}

void list_fields(auto& f, Of<Timing> auto& timing) {
  f("minOrderInterval", timing.min_order_interval);
  f("minStateInterval", timing.min_state_interval);
  f("defaultStateInterval", timing.default_state_interval);
}

void list_fields(auto& f, Of<ProtocolLimits> auto& limits) {
  f("maxStringLens", limits.max_string_lens);
  f("maxArrayLens", limits.max_array_lens);
  f("timing", limits.timing);
}

void list_fields(auto& f, Of<OptionalParameter> auto& parameter) {
  f("parameter", parameter.parameter);
  f("support", parameter.support);
}

void list_fields(auto& f, Of<DescribedParameter> auto& parameter) {
  f("key", parameter.key);
  f("valueDataType", parameter.value_data_type);
  f("isOptional", parameter.is_optional);
}

void list_fields(auto& f, Of<AgvAction> auto& action) {
  f("actionType", action.action_type);
  f("actionScopes", action.action_scopes);
  f("actionParameters", action.action_parameters);
  f.varying("agvAction.blockingTypes", action.blocking_types);
}

void list_fields(auto& f, Of<ProtocolFeatures> auto& features) {
  f("optionalParameters", features.optional_parameters);
  f("agvActions", features.agv_actions);
}

void list_fields(auto& f, Of<PolygonPoint> auto& point) {
  f("x", point.x);
  f("y", point.y);
}

void list_fields(auto& f, Of<Envelope> auto& envelope) {
  f("set", envelope.set);
  f("polygonPoints", envelope.polygon_points);
}

void list_fields(auto& f, Of<AgvGeometry> auto& geometry) { f("envelopes2d", geometry.envelopes2d); }

void list_fields(auto& f, Of<LoadSpecification> auto& loads) { f("loadPositions", loads.load_positions); }

void list_fields(auto& f, Of<VersionInfo> auto& info) {
  f("key", info.key);
  f("value", info.value);
}

void list_fields(auto& f, Of<VehicleConfig> auto& config) { f("versions", config.versions); }

void list_fields(auto& f, Of<Factsheet> auto& factsheet) {
  list_fields(f, factsheet.header);
  f("typeSpecification", factsheet.type_specification);
  f("physicalParameters", factsheet.physical_parameters);
  f("protocolLimits", factsheet.protocol_limits);
  f("protocolFeatures", factsheet.protocol_features);
  f("agvGeometry", factsheet.agv_geometry);
  f("loadSpecification", factsheet.load_specification);
  f.varying("factsheet.vehicleConfig", factsheet.vehicle_config);
}

}  // namespace fleetproof::bridges::vda5050
