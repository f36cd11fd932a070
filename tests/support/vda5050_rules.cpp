#include "tests/support/vda5050_rules.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

namespace fleetproof::test {
namespace {

using Json = nlohmann::json;

enum class Need { Required, Optional };
constexpr Need kYes = Need::Required, kNo = Need::Optional;

// `type`: string, boolean, number, uint, time, any; words between bars; the name of an object; [] before: an array.
struct FieldRule {
  std::string_view object, field, type;
  Need need;
  std::optional<double> least = {}, most = {};
  std::string_view since = "2.0.0";
};

constexpr double kHalfTurn = 3.14159265359;
constexpr std::string_view kBlocking = "NONE|SOFT|HARD";

const FieldRule kFields[] = {
    {"header", "headerId", "uint", kYes},
    {"header", "timestamp", "time", kYes},
    {"header", "version", "string", kYes},
    {"header", "manufacturer", "string", kYes},
    {"header", "serialNumber", "string", kYes},

    {"order", "orderId", "string", kYes},
    {"order", "orderUpdateId", "uint", kYes},
    {"order", "zoneSetId", "string", kNo},
    {"order", "nodes", "[]node", kYes},
    {"order", "edges", "[]edge", kYes},
    {"node", "nodeId", "string", kYes},
    {"node", "sequenceId", "uint", kYes},
    {"node", "nodeDescription", "string", kNo},
    {"node", "released", "boolean", kYes},
    {"node", "nodePosition", "nodePosition", kNo},
    {"node", "actions", "[]action", kYes},
    {"nodePosition", "x", "number", kYes},
    {"nodePosition", "y", "number", kYes},
    {"nodePosition", "theta", "number", kNo, -kHalfTurn, kHalfTurn},
    {"nodePosition", "allowedDeviationXY", "number", kNo, 0.0},
    {"nodePosition", "allowedDeviationTheta", "number", kNo, 0.0, kHalfTurn},
    {"nodePosition", "mapId", "string", kYes},
    {"nodePosition", "mapDescription", "string", kNo},
    {"edge", "edgeId", "string", kYes},
    {"edge", "sequenceId", "uint", kYes},
    {"edge", "edgeDescription", "string", kNo},
    {"edge", "released", "boolean", kYes},
    {"edge", "startNodeId", "string", kYes},
    {"edge", "endNodeId", "string", kYes},
    {"edge", "maxSpeed", "number", kNo},
    {"edge", "maxHeight", "number", kNo},
    {"edge", "minHeight", "number", kNo},
    {"edge", "orientation", "number", kNo, -kHalfTurn, kHalfTurn},
    {"edge", "orientationType", "GLOBAL|TANGENTIAL", kNo},
    {"edge", "direction", "string", kNo},
    {"edge", "rotationAllowed", "boolean", kNo},
    {"edge", "maxRotationSpeed", "number", kNo},
    {"edge", "length", "number", kNo},
    {"edge", "trajectory", "trajectory", kNo},
    {"edge", "corridor", "corridor", kNo, {}, {}, "2.1.0"},
    {"edge", "actions", "[]action", kYes},
    {"trajectory", "degree", "number", kYes, 1.0},
    {"trajectory", "knotVector", "[]number", kYes, 0.0, 1.0},
    {"trajectory", "controlPoints", "[]controlPoint", kYes},
    {"controlPoint", "x", "number", kYes},
    {"controlPoint", "y", "number", kYes},
    {"controlPoint", "weight", "number", kNo, 0.0},
    {"corridor", "leftWidth", "number", kYes, 0.0},
    {"corridor", "rightWidth", "number", kYes, 0.0},
    {"corridor", "corridorRefPoint", "KINEMATICCENTER|CONTOUR", kNo},
    {"action", "actionType", "string", kYes},
    {"action", "actionId", "string", kYes},
    {"action", "actionDescription", "string", kNo},
    {"action", "blockingType", kBlocking, kYes},
    {"action", "actionParameters", "[]actionParameter", kNo},
    {"actionParameter", "key", "string", kYes},
    {"actionParameter", "value", "any", kYes},

    {"instantActions", "actions", "[]action", kYes},

    {"state", "maps", "[]map", kNo, {}, {}, "2.1.0"},
    {"state", "orderId", "string", kYes},
    {"state", "orderUpdateId", "uint", kYes},
    {"state", "zoneSetId", "string", kNo},
    {"state", "lastNodeId", "string", kYes},
    {"state", "lastNodeSequenceId", "uint", kYes},
    {"state", "nodeStates", "[]nodeState", kYes},
    {"state", "edgeStates", "[]edgeState", kYes},
    {"state", "agvPosition", "agvPosition", kNo},
    {"state", "velocity", "velocity", kNo},
    {"state", "loads", "[]load", kNo},
    {"state", "driving", "boolean", kYes},
    {"state", "paused", "boolean", kNo},
    {"state", "newBaseRequest", "boolean", kNo},
    {"state", "distanceSinceLastNode", "number", kNo},
    {"state", "actionStates", "[]actionState", kYes},
    {"state", "batteryState", "batteryState", kYes},
    {"state", "operatingMode", "AUTOMATIC|SEMIAUTOMATIC|MANUAL|SERVICE|TEACHIN", kYes},
    {"state", "errors", "[]error", kYes},
    {"state", "information", "[]info", kNo},
    {"state", "safetyState", "safetyState", kYes},
    {"map", "mapId", "string", kYes},
    {"map", "mapVersion", "string", kYes},
    {"map", "mapDescription", "string", kNo},
    {"map", "mapStatus", "ENABLED|DISABLED", kYes},
    {"nodeState", "nodeId", "string", kYes},
    {"nodeState", "sequenceId", "uint", kYes},
    {"nodeState", "nodeDescription", "string", kNo},
    {"nodeState", "released", "boolean", kYes},
    {"nodeState", "nodePosition", "nodePosition", kNo},
    {"edgeState", "edgeId", "string", kYes},
    {"edgeState", "sequenceId", "uint", kYes},
    {"edgeState", "edgeDescription", "string", kNo},
    {"edgeState", "released", "boolean", kYes},
    {"edgeState", "trajectory", "trajectory", kNo},
    {"agvPosition", "positionInitialized", "boolean", kYes},
    {"agvPosition", "localizationScore", "number", kNo, 0.0, 1.0},
    {"agvPosition", "deviationRange", "number", kNo},
    {"agvPosition", "x", "number", kYes},
    {"agvPosition", "y", "number", kYes},
    {"agvPosition", "theta", "number", kYes, -kHalfTurn, kHalfTurn},
    {"agvPosition", "mapId", "string", kYes},
    {"agvPosition", "mapDescription", "string", kNo},
    {"velocity", "vx", "number", kNo},
    {"velocity", "vy", "number", kNo},
    {"velocity", "omega", "number", kNo},
    {"load", "loadId", "string", kNo},
    {"load", "loadType", "string", kNo},
    {"load", "loadPosition", "string", kNo},
    {"load", "boundingBoxReference", "boundingBoxReference", kNo},
    {"load", "loadDimensions", "loadDimensions", kNo},
    {"load", "weight", "number", kNo, 0.0},
    {"boundingBoxReference", "x", "number", kYes},
    {"boundingBoxReference", "y", "number", kYes},
    {"boundingBoxReference", "z", "number", kYes},
    {"boundingBoxReference", "theta", "number", kNo},
    {"loadDimensions", "length", "number", kYes},
    {"loadDimensions", "width", "number", kYes},
    {"loadDimensions", "height", "number", kNo},
    {"actionState", "actionId", "string", kYes},
    {"actionState", "actionType", "string", kNo},
    {"actionState", "actionDescription", "string", kNo},
    // The schemas of 2.0.0 and 2.1.0 lack PAUSED. The text has it, and the text counts where they differ (section 6).
    {"actionState", "actionStatus", "WAITING|INITIALIZING|RUNNING|PAUSED|FINISHED|FAILED", kYes},
    {"actionState", "resultDescription", "string", kNo},
    {"batteryState", "batteryCharge", "number", kYes, 0.0, 100.0},
    {"batteryState", "batteryVoltage", "number", kNo},
    {"batteryState", "batteryHealth", "number", kNo, 0.0, 100.0},
    {"batteryState", "charging", "boolean", kYes},
    {"batteryState", "reach", "uint", kNo},
    {"error", "errorType", "string", kYes},
    {"error", "errorReferences", "[]reference", kNo},
    {"error", "errorDescription", "string", kNo},
    {"error", "errorHint", "string", kNo, {}, {}, "2.1.0"},
    {"error", "errorLevel", "WARNING|FATAL", kYes},
    {"reference", "referenceKey", "string", kYes},
    {"reference", "referenceValue", "string", kYes},
    {"info", "infoType", "string", kYes},
    {"info", "infoReferences", "[]reference", kNo},
    {"info", "infoDescription", "string", kNo},
    {"info", "infoLevel", "DEBUG|INFO", kYes},
    {"safetyState", "eStop", "AUTOACK|MANUAL|REMOTE|NONE", kYes},
    {"safetyState", "fieldViolation", "boolean", kYes},

    {"connection", "connectionState", "ONLINE|OFFLINE|CONNECTIONBROKEN", kYes},

    {"factsheet", "typeSpecification", "typeSpecification", kYes},
    {"factsheet", "physicalParameters", "physicalParameters", kYes},
    {"factsheet", "protocolLimits", "protocolLimits", kYes},
    {"factsheet", "protocolFeatures", "protocolFeatures", kYes},
    {"factsheet", "agvGeometry", "agvGeometry", kYes},
    {"factsheet", "loadSpecification", "loadSpecification", kYes},
    {"factsheet", "vehicleConfig", "vehicleConfig", kNo, {}, {}, "2.1.0"},
    {"typeSpecification", "seriesName", "string", kYes},
    {"typeSpecification", "seriesDescription", "string", kNo},
    {"typeSpecification", "agvKinematic", "DIFF|OMNI|THREEWHEEL", kYes},
    {"typeSpecification", "agvClass", "FORKLIFT|CONVEYOR|TUGGER|CARRIER", kYes},
    {"typeSpecification", "maxLoadMass", "number", kYes, 0.0},
    {"typeSpecification", "localizationTypes", "[]NATURAL|REFLECTOR|RFID|DMC|SPOT|GRID", kYes},
    {"typeSpecification", "navigationTypes", "[]PHYSICAL_LINE_GUIDED|VIRTUAL_LINE_GUIDED|AUTONOMOUS", kYes},
    {"physicalParameters", "speedMin", "number", kYes},
    {"physicalParameters", "speedMax", "number", kYes},
    {"physicalParameters", "angularSpeedMin", "number", kNo},
    {"physicalParameters", "angularSpeedMax", "number", kNo},
    {"physicalParameters", "accelerationMax", "number", kYes},
    {"physicalParameters", "decelerationMax", "number", kYes},
    {"physicalParameters", "heightMin", "number", kYes},
    {"physicalParameters", "heightMax", "number", kYes},
    {"physicalParameters", "width", "number", kYes},
    {"physicalParameters", "length", "number", kYes},
    {"protocolLimits", "maxStringLens", "maxStringLens", kYes},
    {"protocolLimits", "maxArrayLens", "maxArrayLens", kYes},
    {"protocolLimits", "timing", "timing", kYes},
    {"maxStringLens", "msgLen", "uint", kNo},
    {"maxStringLens", "topicSerialLen", "uint", kNo},
    {"maxStringLens", "topicElemLen", "uint", kNo},
    {"maxStringLens", "idLen", "uint", kNo},
    {"maxStringLens", "idNumericalOnly", "boolean", kNo},
    {"maxStringLens", "enumLen", "uint", kNo},
    {"maxStringLens", "loadIdLen", "uint", kNo},
    {"maxArrayLens", "order.nodes", "uint", kNo},
    {"maxArrayLens", "order.edges", "uint", kNo},
    {"maxArrayLens", "node.actions", "uint", kNo},
    {"maxArrayLens", "edge.actions", "uint", kNo},
    {"maxArrayLens", "actions.actionsParameters", "uint", kNo},
    {"maxArrayLens", "instantActions", "uint", kNo},
    {"maxArrayLens", "trajectory.knotVector", "uint", kNo},
    {"maxArrayLens", "trajectory.controlPoints", "uint", kNo},
    {"maxArrayLens", "state.nodeStates", "uint", kNo},
    {"maxArrayLens", "state.edgeStates", "uint", kNo},
    {"maxArrayLens", "state.loads", "uint", kNo},
    {"maxArrayLens", "state.actionStates", "uint", kNo},
    {"maxArrayLens", "state.errors", "uint", kNo},
    {"maxArrayLens", "state.information", "uint", kNo},
    {"maxArrayLens", "error.errorReferences", "uint", kNo},
    {"maxArrayLens", "information.infoReferences", "uint", kNo},
    {"timing", "minOrderInterval", "number", kYes},
    {"timing", "minStateInterval", "number", kYes},
    {"timing", "defaultStateInterval", "number", kNo},
    {"timing", "visualizationInterval", "number", kNo},
    {"protocolFeatures", "optionalParameters", "[]optionalParameter", kYes},
    {"protocolFeatures", "agvActions", "[]agvAction", kYes},
    {"optionalParameter", "parameter", "string", kYes},
    {"optionalParameter", "support", "SUPPORTED|REQUIRED", kYes},
    {"optionalParameter", "description", "string", kNo},
    {"agvAction", "actionType", "string", kYes},
    {"agvAction", "actionDescription", "string", kNo},
    {"agvAction", "actionScopes", "[]INSTANT|NODE|EDGE", kYes},
    {"agvAction", "actionParameters", "[]describedParameter", kNo},
    {"agvAction", "resultDescription", "string", kNo},
    {"agvAction", "blockingTypes", "[]NONE|SOFT|HARD", kNo, {}, {}, "2.1.0"},
    {"describedParameter", "key", "string", kYes},
    {"describedParameter", "valueDataType", "BOOL|NUMBER|INTEGER|FLOAT|STRING|OBJECT|ARRAY", kYes},
    {"describedParameter", "description", "string", kNo},
    {"describedParameter", "isOptional", "boolean", kNo},
    {"agvGeometry", "envelopes2d", "[]envelope2d", kNo},
    {"envelope2d", "set", "string", kYes},
    {"envelope2d", "polygonPoints", "[]polygonPoint", kYes},
    {"envelope2d", "description", "string", kNo},
    {"polygonPoint", "x", "number", kYes},
    {"polygonPoint", "y", "number", kYes},
    {"loadSpecification", "loadPositions", "[]string", kNo},
    {"vehicleConfig", "versions", "[]versionInfo", kNo},
    {"versionInfo", "key", "string", kYes},
    {"versionInfo", "value", "string", kYes},
};

// The fields of an object in a version.
using Rules = std::map<std::string_view, const FieldRule*>;

Rules rules_of(std::string_view object, std::string_view version) {
  Rules rules;
  for (const FieldRule& rule : kFields) {
    if (rule.object == object && rule.since <= version) rules[rule.field] = &rule;
  }
  return rules;
}

class RuleCheck {
 public:
  explicit RuleCheck(std::string_view version) : version_(version) {}

  void object(const Json& json, const std::string& place, const Rules& rules) {
    if (!json.is_object()) return breaks(place, "must be an object");
    const std::string before = place.empty() ? "" : place + ".";
    for (const auto& [key, value] : json.items()) {
      const auto rule = rules.find(key);
      if (rule == rules.end()) {
        breaks(before + key, "is no field");
      } else {
        value_of(value, before + key, rule->second->type, *rule->second);
      }
    }
    for (const auto& [field, rule] : rules) {
      if (rule->need == kYes && !json.contains(field)) breaks(before + std::string(field), "is missing");
    }
  }

  std::vector<std::string> broken;

 private:
  void value_of(const Json& json, const std::string& place, std::string_view type, const FieldRule& rule) {
    if (type.starts_with("[]")) {
      if (!json.is_array()) return breaks(place, "must be an array");
      for (std::size_t i = 0; i < json.size(); ++i)
        value_of(json[i], place + "[" + std::to_string(i) + "]", type.substr(2), rule);
    } else if (type.find('|') != std::string_view::npos) {
      const bool is_word =
          json.is_string() &&
          ("|" + std::string(type) + "|").find("|" + json.get<std::string>() + "|") != std::string::npos;
      if (!is_word) breaks(place, "must be one of " + std::string(type));
    } else if (const Rules rules = rules_of(type, version_); !rules.empty()) {
      object(json, place, rules);
    } else {
      simple(json, place, type, rule);
    }
  }

  void simple(const Json& json, const std::string& place, std::string_view type, const FieldRule& rule) {
    static const std::regex instant(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z)");
    const bool is_right = type == "string"    ? json.is_string()
                          : type == "boolean" ? json.is_boolean()
                          : type == "number"  ? json.is_number()
                          : type == "uint"    ? json.is_number_unsigned() && json.get<std::uint64_t>() <= 0xffffffffu
                          : type == "time"    ? json.is_string() && std::regex_match(json.get<std::string>(), instant)
                                              : !json.is_null();
    if (!is_right) return breaks(place, "must be of type " + std::string(type));
    if (!json.is_number()) return;
    if (rule.least && json.get<double>() < *rule.least) breaks(place, "is too small");
    if (rule.most && json.get<double>() > *rule.most) breaks(place, "is too large");
  }

  void breaks(const std::string& place, const std::string& what) { broken.push_back(place + ": " + what); }

  std::string_view version_;
};

}  // namespace

std::vector<std::string> broken_rules(std::string_view json, std::string_view topic, std::string_view version) {
  const Json message = Json::parse(json, nullptr, false);
  if (message.is_discarded()) return {"this is no JSON"};
  RuleCheck check(version);
  Rules rules = rules_of(topic, version);
  rules.merge(rules_of("header", version));
  check.object(message, "", rules);
  return check.broken;
}

}  // namespace fleetproof::test
