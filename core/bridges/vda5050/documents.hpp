#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bridges/vda5050/version.hpp"

// The messages of VDA 5050 as structs, one field for each field of the standard. An optional field is a std::optional.
// The topic `visualization` is left out: it serves screens, and the replay page shows exact positions.
namespace fleetproof::bridges::vda5050 {

struct Header {
  std::uint32_t header_id = 0;
  std::string timestamp, version, manufacturer, serial_number;
};

// ---- order and instantActions

enum class BlockingType : std::uint8_t { None, Soft, Hard };

struct ActionParameter {
  std::string key;
  std::string value;       // the text of a string; anything else as JSON
  bool is_string = false;  // of the value
};

struct Action {
  std::string action_type, action_id;
  std::optional<std::string> action_description;
  BlockingType blocking_type = BlockingType::None;
  std::optional<std::vector<ActionParameter>> action_parameters;

  // Null if there is no such parameter.
  const ActionParameter* parameter(std::string_view key) const;
};

struct NodePosition {
  double x = 0.0, y = 0.0;
  std::optional<double> theta, allowed_deviation_xy, allowed_deviation_theta;
  std::string map_id;
  std::optional<std::string> map_description;
};

struct Node {
  std::string node_id;
  std::uint32_t sequence_id = 0;
  std::optional<std::string> node_description;
  bool released = false;
  std::optional<NodePosition> node_position;
  std::vector<Action> actions;
};

struct ControlPoint {
  double x = 0.0, y = 0.0;
  std::optional<double> weight;
};

struct Trajectory {
  double degree = 1.0;
  std::vector<double> knot_vector;
  std::vector<ControlPoint> control_points;
};

enum class CorridorReference : std::uint8_t { KinematicCenter, Contour };
enum class OrientationType : std::uint8_t { Global, Tangential };

struct Corridor {
  double left_width = 0.0, right_width = 0.0;
  std::optional<CorridorReference> corridor_ref_point;
};

struct Edge {
  std::string edge_id;
  std::uint32_t sequence_id = 0;
  std::optional<std::string> edge_description;
  bool released = false;
  std::string start_node_id, end_node_id;
  std::optional<double> max_speed, max_height, min_height, orientation;
  std::optional<OrientationType> orientation_type;
  std::optional<std::string> direction;
  std::optional<bool> rotation_allowed;
  std::optional<double> max_rotation_speed;
  std::optional<Trajectory> trajectory;
  std::optional<double> length;
  std::optional<Corridor> corridor;
  std::vector<Action> actions;
};

struct Order {
  Header header;
  std::string order_id;
  std::uint32_t order_update_id = 0;
  std::optional<std::string> zone_set_id;
  std::vector<Node> nodes;
  std::vector<Edge> edges;
};

struct InstantActions {
  Header header;
  std::vector<Action> actions;
};

// ---- state

enum class MapStatus : std::uint8_t { Enabled, Disabled };
enum class ActionStatus : std::uint8_t { Waiting, Initializing, Running, Paused, Finished, Failed };
enum class OperatingMode : std::uint8_t { Automatic, Semiautomatic, Manual, Service, Teachin };
enum class ErrorLevel : std::uint8_t { Warning, Fatal };
enum class InfoLevel : std::uint8_t { Debug, Info };
enum class EmergencyStop : std::uint8_t { Autoack, Manual, Remote, None };

struct Map {
  std::string map_id, map_version;
  std::optional<std::string> map_description;
  MapStatus map_status = MapStatus::Enabled;
};

struct NodeState {
  std::string node_id;
  std::uint32_t sequence_id = 0;
  bool released = false;
};

struct EdgeState {
  std::string edge_id;
  std::uint32_t sequence_id = 0;
  bool released = false;
};

struct AgvPosition {
  bool position_initialized = true;
  double x = 0.0, y = 0.0, theta = 0.0;
  std::string map_id;
};

struct Load {
  std::optional<std::string> load_id, load_type, load_position;
  std::optional<double> weight;
};

struct ActionState {
  std::string action_id;
  std::optional<std::string> action_type;
  ActionStatus action_status = ActionStatus::Waiting;
  std::optional<std::string> result_description;
};

struct BatteryState {
  double battery_charge = 100.0;  // per cent
  bool charging = false;
};

struct Reference {
  std::string reference_key, reference_value;
  bool operator==(const Reference&) const = default;
};

struct Error {
  std::string error_type;
  std::vector<Reference> error_references;
  std::optional<std::string> error_description, error_hint;
  ErrorLevel error_level = ErrorLevel::Warning;
};

struct Info {
  std::string info_type;
  std::vector<Reference> info_references;
  std::optional<std::string> info_description;
  InfoLevel info_level = InfoLevel::Info;
};

struct SafetyState {
  EmergencyStop e_stop = EmergencyStop::None;
  bool field_violation = false;
};

struct State {
  Header header;
  std::optional<std::vector<Map>> maps;
  std::string order_id;
  std::uint32_t order_update_id = 0;
  std::string last_node_id;
  std::uint32_t last_node_sequence_id = 0;
  std::vector<NodeState> node_states;
  std::vector<EdgeState> edge_states;
  std::optional<AgvPosition> agv_position;
  std::optional<std::vector<Load>> loads;
  bool driving = false;
  std::optional<bool> paused, new_base_request;
  std::vector<ActionState> action_states;
  BatteryState battery_state;
  OperatingMode operating_mode = OperatingMode::Automatic;
  std::vector<Error> errors;
  std::optional<std::vector<Info>> information;
  SafetyState safety_state;
};

// ---- connection

enum class ConnectionState : std::uint8_t { Online, Offline, ConnectionBroken };

std::string_view word_of(ConnectionState state);  // "ONLINE"

struct Connection {
  Header header;
  ConnectionState connection_state = ConnectionState::Online;
};

// ---- factsheet

struct TypeSpecification {
  std::string series_name;
  std::string agv_kinematic = "DIFF", agv_class = "CARRIER";
  double max_load_mass = 0.0;
  std::vector<std::string> localization_types, navigation_types;
};

struct PhysicalParameters {
  double speed_min = 0.0, speed_max = 0.0, acceleration_max = 0.0, deceleration_max = 0.0;
  double height_min = 0.0, height_max = 0.0, width = 0.0, length = 0.0;
};

struct StringLimits {
  std::optional<std::uint32_t> msg_len, id_len, enum_len, load_id_len;
};

struct ArrayLimits {
  std::optional<std::uint32_t> order_nodes, order_edges, node_actions, edge_actions, instant_actions,
      state_action_states, state_errors;
};

struct Timing {
  double min_order_interval = 0.0, min_state_interval = 0.0;
  std::optional<double> default_state_interval;
};

struct ProtocolLimits {
  StringLimits max_string_lens;
  ArrayLimits max_array_lens;
  Timing timing;
};

enum class Support : std::uint8_t { Supported, Required };
enum class ActionScope : std::uint8_t { Instant, Node, Edge };
enum class ValueType : std::uint8_t { Bool, Number, Integer, Float, String, Object, Array };

struct OptionalParameter {
  std::string parameter;
  Support support = Support::Supported;
};

struct DescribedParameter {
  std::string key;
  ValueType value_data_type = ValueType::String;
  std::optional<bool> is_optional;
};

struct AgvAction {
  std::string action_type;
  std::vector<ActionScope> action_scopes;
  std::optional<std::vector<DescribedParameter>> action_parameters;
  std::optional<std::vector<BlockingType>> blocking_types;
};

struct ProtocolFeatures {
  std::vector<OptionalParameter> optional_parameters;
  std::vector<AgvAction> agv_actions;
};

struct PolygonPoint {
  double x = 0.0, y = 0.0;
};

struct Envelope {
  std::string set;
  std::vector<PolygonPoint> polygon_points;
};

struct AgvGeometry {
  std::optional<std::vector<Envelope>> envelopes2d;
};

struct LoadSpecification {
  std::optional<std::vector<std::string>> load_positions;
};

struct VersionInfo {
  std::string key, value;
};

struct VehicleConfig {
  std::optional<std::vector<VersionInfo>> versions;
};

struct Factsheet {
  Header header;
  TypeSpecification type_specification;
  PhysicalParameters physical_parameters;
  ProtocolLimits protocol_limits;
  ProtocolFeatures protocol_features;
  AgvGeometry agv_geometry;
  LoadSpecification load_specification;
  std::optional<VehicleConfig> vehicle_config;
};

// ---- reading and writing

// Longer messages are refused unread.
inline constexpr std::size_t kMostDocumentBytes = 1u << 20;
// Objects and arrays within each other.
inline constexpr std::size_t kMostNesting = 32;

// Whether `bytes` are such a document of this version: JSON in UTF-8 without repeated keys, with all required fields,
// each of the right type and in its range. Fields that the version does not have are ignored. If not, `why` says where
// and what, in at most 200 printable characters, and the document has the fields before that one.
bool read_document(std::string_view bytes, const Version& version, Order& to, std::string& why);
bool read_document(std::string_view bytes, const Version& version, InstantActions& to, std::string& why);
bool read_document(std::string_view bytes, const Version& version, State& to, std::string& why);
bool read_document(std::string_view bytes, const Version& version, Connection& to, std::string& why);
bool read_document(std::string_view bytes, const Version& version, Factsheet& to, std::string& why);

// JSON on one line, the fields in the order of the standard. A number reads back with the same bits. All numbers must
// be finite, and all texts UTF-8.
std::string write_document(const Order& document, const Version& version);
std::string write_document(const InstantActions& document, const Version& version);
std::string write_document(const State& document, const Version& version);
std::string write_document(const Connection& document, const Version& version);
std::string write_document(const Factsheet& document, const Version& version);

}  // namespace fleetproof::bridges::vda5050
