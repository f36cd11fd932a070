#include "generators/formats/lif_left_out.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include "generators/formats/left_out.hpp"
#include "generators/formats/lif.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {
namespace {

constexpr Topic kNotes{"{0} kinds of names and notes for people are left out ({1})"};
constexpr Topic kActions{"{0} types of actions are left out ({1})"};
constexpr Topic kDetails{
    "{0} kinds of details of actions are left out ({1}); here an action takes the time of its task"};
constexpr Topic kTurns{"{0} edges have rules for turning ({1}); here an AGV turns at stations only, at its own speed"};
constexpr Topic kLifts{"{0} edges and stations give the height of a lift or load ({1}); here the floor is flat"};
constexpr Topic kLoadRules{"{0} nodes and edges are for sets of loads ({1}); here all loads are alike"};
constexpr Topic kReentry{"{0} edges have rules for reentry ({1}); they are left out"};
constexpr Topic kCorridors{
    "{0} nodes and edges let an AGV leave the lane ({1}); leaving the lane is not modelled: it stays on the lane"};
constexpr Topic kDrawn{
    "{0} edges have corridors ({1}); leaving the lane is not modelled: an AGV stays on it, and the floor is drawn as "
    "wide, at most 100 m"};
constexpr Topic kGuides{
    "{0} edges are lines on the floor that guide AGVs ({1}); here AGVs drive them as drawn, and need no direction at "
    "junctions"};
constexpr Topic kMaps{"nodes lie on {0} maps ({1}); here all of them lie on one floor"};
constexpr Topic kPlaces{"{0} stations stand beside the nodes ({1}); here an AGV serves them at their nodes"};
constexpr Topic kForbidden{"{0} nodes and edges forbid types of actions ({1}); here AGVs pick, drop and charge alone"};
constexpr Topic kOtherVersion{"the file says that it is LIF {1}; it is read as LIF 2.0"};
constexpr Topic kUnknownKeys{"{0} keys are unknown here and left out ({1})"};

enum class Named : std::uint8_t { ByOwner, ByKey, ByValue };

// What is done with a key (all that is in it, if there is a topic). Keys of types of mobile robots are read as those of
// types of vehicles.
struct LifRule {
  std::string_view path;
  const Topic* topic = nullptr;  // null: it is read
  Named named = Named::ByOwner;
  std::string_view says_nothing{};  // a value that means the same as no key
};
constexpr LifRule kLifRules[] = {
    {"layoutId"},
    {"layoutName"},
    {"layoutVersion", &kNotes, Named::ByKey},
    {"layoutLevelId", &kNotes, Named::ByKey},
    {"layoutDescription", &kNotes, Named::ByKey},
    {"layoutDescriptor", &kNotes, Named::ByKey},
    {"nodes"},
    {"nodes/nodeId"},
    {"nodes/nodeName", &kNotes, Named::ByKey},
    {"nodes/nodeDescription", &kNotes, Named::ByKey},
    {"nodes/nodeDescriptor", &kNotes, Named::ByKey},
    {"nodes/mapId"},
    {"nodes/nodePosition"},
    {"nodes/nodePosition/x"},
    {"nodes/nodePosition/y"},
    {"nodes/types"},
    {"nodes/types/typeId"},
    {"nodes/types/typeId/manufacturer"},
    {"nodes/types/typeId/seriesName"},
    {"nodes/types/theta"},
    {"nodes/types/allowedDeviationXY", &kCorridors},
    {"nodes/types/allowedDeviationTheta", &kCorridors},
    {"nodes/types/maximumAllowedDeviation", &kCorridors},
    {"nodes/types/actions"},
    {"nodes/types/requiredActions"},
    {"nodes/types/feasibleActions"},
    {"nodes/types/forbiddenActionTypes", &kForbidden},
    {"nodes/types/loadRestriction"},
    {"nodes/types/loadRestriction/loaded"},
    {"nodes/types/loadRestriction/unloaded"},
    {"nodes/types/loadRestriction/loadSetNames", &kLoadRules},
    {"edges"},
    {"edges/edgeId"},
    {"edges/startNodeId"},
    {"edges/endNodeId"},
    {"edges/edgeName", &kNotes, Named::ByKey},
    {"edges/edgeDescription", &kNotes, Named::ByKey},
    {"edges/edgeDescriptor", &kNotes, Named::ByKey},
    {"edges/types"},
    {"edges/types/typeId"},
    {"edges/types/typeId/manufacturer"},
    {"edges/types/typeId/seriesName"},
    {"edges/types/vehicleOrientation"},
    {"edges/types/vehicleOrientations"},
    {"edges/types/mobileRobotOrientations"},
    {"edges/types/orientationType"},
    {"edges/types/rotationAllowed", &kTurns, Named::ByOwner, "false"},
    {"edges/types/rotationAtStartNodeAllowed"},
    {"edges/types/rotationAtEndNodeAllowed"},
    {"edges/types/reachOrientationBeforeEntering", &kTurns, Named::ByOwner, "true"},
    {"edges/types/maxSpeed"},
    {"edges/types/maximumSpeed"},
    {"edges/types/maxRotationSpeed", &kTurns},
    {"edges/types/maximumRotationSpeed", &kTurns},
    {"edges/types/minHeight", &kLifts},
    {"edges/types/maxHeight", &kLifts},
    {"edges/types/minimumHeight", &kLifts},
    {"edges/types/maximumHeight", &kLifts},
    {"edges/types/minimumLoadHandlingDeviceHeight", &kLifts},
    {"edges/types/maximumMobileRobotHeight", &kLifts},
    {"edges/types/loadRestriction"},
    {"edges/types/loadRestriction/loaded"},
    {"edges/types/loadRestriction/unloaded"},
    {"edges/types/loadRestriction/loadSetNames", &kLoadRules},
    {"edges/types/actions"},
    {"edges/types/requiredActions"},
    {"edges/types/feasibleActions"},
    {"edges/types/forbiddenActionTypes", &kForbidden},
    {"edges/types/trajectory"},
    {"edges/types/trajectory/degree"},
    {"edges/types/trajectory/knotVector"},
    {"edges/types/trajectory/controlPoints"},
    {"edges/types/trajectory/controlPoints/x"},
    {"edges/types/trajectory/controlPoints/y"},
    {"edges/types/trajectory/controlPoints/weight"},
    {"edges/types/reentryAllowed", &kReentry, Named::ByOwner, "true"},
    {"edges/types/allowedDeviationXY", &kCorridors},
    {"edges/types/allowedDeviationTheta", &kCorridors},
    {"edges/types/maximumAllowedDeviation", &kCorridors},
    {"edges/types/corridor", &kDrawn},
    {"edges/types/physicalLineGuidedProperty", &kGuides},
    {"stations"},
    {"stations/stationId", &kPlaces},
    {"stations/interactionNodeIds"},
    {"stations/stationName", &kNotes, Named::ByKey},
    {"stations/stationDescription", &kNotes, Named::ByKey},
    {"stations/stationDescriptor", &kNotes, Named::ByKey},
    {"stations/stationType"},
    {"stations/stationHeight", &kLifts},
    {"stations/stationPosition", &kPlaces},
};

std::string spelled(std::string_view key) {
  if (key == "vehicleTypeNodeProperties" || key == "mobileRobotTypeNodeProperties" ||
      key == "vehicleTypeEdgeProperties" || key == "mobileRobotTypeEdgeProperties")
    return "types";
  if (key == "vehicleTypeId" || key == "mobileRobotTypeId" || key == "vehicleTypeIds" || key == "mobileRobotTypeIds" ||
      key == "mobileRobotTypes")
    return "typeId";
  return std::string(key);
}

std::string scalar_text(const JsonValue& value) {
  if (const auto* text = std::get_if<std::string>(&value.scalar)) return *text;
  if (const auto* truth = std::get_if<bool>(&value.scalar)) return *truth ? "true" : "false";
  if (const auto* number = std::get_if<double>(&value.scalar)) return *number == 0.0 ? "0" : "number";
  if (const auto* whole = std::get_if<std::int64_t>(&value.scalar)) return std::to_string(*whole);
  if (const auto* natural = std::get_if<std::uint64_t>(&value.scalar)) return std::to_string(*natural);
  return "";
}

class LifWalk {
 public:
  LifWalk(LeftOutThings& things, const PurposeWords& own) : things_(things), own_(own) {}

  void members(const JsonReader& object, const std::string& path, std::string owner) {
    for (const auto* id : {"nodeId", "edgeId", "stationId"}) {
      if (const auto found = object.find(id); found && found->is_text()) owner = found->text();
    }
    for (const auto& key : object.value().keys) member(object.at(key), path, key, owner);
  }

 private:
  void member(const JsonReader& value, const std::string& path, const std::string& key, const std::string& owner) {
    const auto inner = (path.empty() ? "" : path + "/") + spelled(key);
    const auto rule = std::ranges::find(kLifRules, inner, &LifRule::path);
    if (rule == std::end(kLifRules)) return things_.add(kUnknownKeys, value.place(), inner);
    if (rule->topic != nullptr) return left_out(*rule, value, key, owner);
    if (inner.ends_with("/actions") || inner.ends_with("Actions")) return actions(value);
    if (value.value().shape == JsonValue::Shape::Object) members(value, inner, owner);
    if (value.value().shape != JsonValue::Shape::Array) return;
    for (const auto& item : value.items()) {
      if (item.value().shape == JsonValue::Shape::Object) members(item, inner, owner);
    }
  }

  void left_out(const LifRule& rule, const JsonReader& value, const std::string& key, const std::string& owner) {
    const auto text = scalar_text(value.value());
    if (!rule.says_nothing.empty() && text == rule.says_nothing) return;
    // The importer reads what it wrote itself.
    if (rule.path == "nodes/nodeDescription" && text.starts_with(kPurposesMark)) return;
    if (rule.path == "edges/edgeDescription" && text.starts_with(kBackMark)) return;
    const bool by_value = rule.named == Named::ByValue && !text.empty();
    things_.add(*rule.topic, value.place(), by_value ? text : rule.named == Named::ByOwner ? owner : key);
  }

  void actions(const JsonReader& list) {
    for (const auto& action : list.items()) {
      for (const auto& key : action.value().keys) {
        if (key != "actionType") things_.add(kDetails, action.place(), key);
      }
      const auto type = action.at("actionType").text();
      if (own_.said_of(type)) continue;
      if (type != "pick" && type != "drop" && type != "startCharging") things_.add(kActions, action.place(), type);
    }
  }

  LeftOutThings& things_;
  const PurposeWords& own_;
};

// The name of one map says nothing more than the layout.
void note_maps(const JsonReader& layout, LeftOutThings& things) {
  std::map<std::string, std::string> places;  // of maps
  for (const auto& node : layout.at("nodes").items()) {
    if (const auto map = node.find("mapId"); map && map->is_text()) places.emplace(map->text(), map->place());
  }
  for (const auto& [map, place] : places)
    things.add(places.size() > 1 ? kMaps : kNotes, place, places.size() > 1 ? map : "mapId");
}

void note_version(const JsonReader& root, LeftOutThings& things) {
  const auto meta = root.find("metaInformation");
  const auto version = meta ? meta->find("lifVersion") : std::nullopt;
  if (!version || !version->is_text()) return;
  const std::string text = version->text(), major = text.substr(0, text.find('.'));
  if (major != "0" && major != "1" && major != "2") things.add(kOtherVersion, version->place(), text);
}

void note_origin(const JsonReader& origin, LeftOutThings& things) {
  for (const auto& key : origin.value().keys) {
    if (key == "layouts") continue;
    const bool is_note = key == "originId" || key == "originDescriptor" || key == "originDescription";
    things.add(is_note ? kNotes : kUnknownKeys, origin.at(key).place(), is_note ? key : "origins/" + key);
  }
}

}  // namespace

void note_left_out(const JsonReader& root, const JsonReader& layout, const PurposeWords& own,
                   std::vector<std::string>& warnings) {
  LeftOutThings things;
  for (const auto& key : root.value().keys) {
    if (key == "layouts" || key == "origins") continue;
    things.add(key == "metaInformation" ? kNotes : kUnknownKeys, root.at(key).place(), key);
  }
  note_version(root, things);
  if (const auto origins = root.find("origins")) {
    for (const auto& origin : origins->items()) note_origin(origin, things);
  }
  note_maps(layout, things);
  LifWalk(things, own).members(layout, "", "");
  things.tell(warnings);
}

}  // namespace fleetproof
