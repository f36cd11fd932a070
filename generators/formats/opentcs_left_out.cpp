#include "generators/formats/opentcs_left_out.hpp"

#include <algorithm>
#include <pugixml.hpp>
#include <set>

#include "generators/formats/left_out.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr Topic kCosts{"{0} paths have routing costs ({1}); they are left out"};
constexpr Topic kPointHeights{"{0} points and locations lie above or below the floor ({1}); here the floor is flat"};
constexpr Topic kSizes{"{0} points limit the size of an AGV ({1}); here every AGV may stop at every station"};
constexpr Topic kEnvelopes{
    "{0} points and paths have envelopes ({1}); they are left out, because the body of each AGV is followed"};
constexpr Topic kDevices{
    "{0} elements operate doors, lifts or other devices ({1}); these are not modelled: an AGV drives on without them"};
constexpr Topic kMembers{"{0} members of blocks are no paths ({1}); here a block holds paths alone"};
constexpr Topic kVehicles{
    "{0} vehicles are left out ({1}); a campaign has its own fleet, which import --vehicles writes from them"};
constexpr Topic kVehicleTypes{"{0} elements describe types of vehicles ({1}); they are left out"};
constexpr Topic kByType{"{0} paths have rules for types of vehicles ({1}); they are left out"};
constexpr Topic kRoutes{"{0} static routes are left out ({1})"};
constexpr Topic kGroups{"{0} groups are left out ({1})"};
constexpr Topic kLocationPlaces{
    "{0} locations stand beside the paths ({1}); here an AGV serves them at the linked points"};
constexpr Topic kOutgoing{"{0} points list outgoing paths that do not start there ({1}); the ends of the paths count"};
constexpr Topic kProperties{"{0} properties are left out (keys: {1})"};
constexpr Topic kElementIds{"the numbers (\"id\") of {0} elements are left out ({1})"};
constexpr Topic kEditor{"labels, colours, symbols, layers and other aids of the editor are left out"};
constexpr Topic kDrawsNothing{"{0} elements draw something that is not in the model ({1}); they are left out"};
constexpr Topic kSecond{"{0} elements stand there a second time ({1}); the first counts"};
constexpr Topic kUnknownElements{"{0} elements or attributes are unknown here and left out ({1})"};

// What is done with an element (attribute "*": with all that is in it) or with one of its attributes.
struct OpentcsRule {
  std::string_view element, attribute;
  const Topic* topic = nullptr;     // null: it is read
  std::string_view says_nothing{};  // a value that means the same as no attribute
};
constexpr OpentcsRule kOpentcsRules[] = {
    {"", "version"},
    {"", "name"},
    {"property", "*", &kProperties},
    {"point", "name"},
    {"point", "type"},
    {"point", "positionX"},
    {"point", "positionY"},
    {"point", "xPosition"},
    {"point", "yPosition"},
    {"point", "positionZ", &kPointHeights, "0"},
    {"point", "zPosition", &kPointHeights, "0"},
    {"point", "vehicleOrientationAngle"},
    {"point", "id", &kElementIds},
    {"point/maxVehicleBoundingBox", "*", &kSizes},
    {"point/vehicleEnvelope", "*", &kEnvelopes},
    {"point/property", "*", &kProperties},
    {"point/pointLayout", "positionX"},
    {"point/pointLayout", "positionY"},
    {"point/pointLayout", "xPosition"},
    {"point/pointLayout", "yPosition"},
    {"point/pointLayout", "labelOffsetX", &kEditor},
    {"point/pointLayout", "labelOffsetY", &kEditor},
    {"point/pointLayout", "xLabelOffset", &kEditor},
    {"point/pointLayout", "yLabelOffset", &kEditor},
    {"point/pointLayout", "layerId", &kEditor},
    {"path", "name"},
    {"path", "sourcePoint"},
    {"path", "destinationPoint"},
    {"path", "length"},
    {"path", "locked"},
    {"path", "maxVelocity"},
    {"path", "maxReverseVelocity"},
    {"path", "routingCost", &kCosts, "1"},
    {"path", "id", &kElementIds},
    {"path/typeMaxVelocity", "*", &kByType},
    {"path/typeMaxReverseVelocity", "*", &kByType},
    {"path/typeLock", "*", &kByType},
    {"path/typeActions", "*", &kByType},
    {"path/peripheralOperation", "*", &kDevices},
    {"path/vehicleEnvelope", "*", &kEnvelopes},
    {"path/property", "*", &kProperties},
    {"path/pathLayout", "connectionType"},
    {"path/pathLayout", "layerId", &kEditor},
    {"path/pathLayout/controlPoint", "x"},
    {"path/pathLayout/controlPoint", "y"},
    {"vehicle", "*", &kVehicles},
    {"vehicleType", "*", &kVehicleTypes},
    {"locationType", "name"},
    {"locationType", "id", &kElementIds},
    {"locationType", "locationNamePrefix", &kEditor},
    {"locationType/allowedOperation", "name"},
    {"locationType/allowedOperation/property", "*", &kProperties},
    {"locationType/allowedPeripheralOperation", "*", &kDevices},
    {"locationType/property", "*", &kProperties},
    {"locationType/locationTypeLayout", "locationRepresentation"},
    {"location", "name", &kLocationPlaces},
    {"location", "type"},
    {"location", "locked"},
    {"location", "positionX", &kLocationPlaces},
    {"location", "positionY", &kLocationPlaces},
    {"location", "xPosition", &kLocationPlaces},
    {"location", "yPosition", &kLocationPlaces},
    {"location", "positionZ", &kPointHeights, "0"},
    {"location", "zPosition", &kPointHeights, "0"},
    {"location", "id", &kElementIds},
    {"location/link", "point"},
    {"location/link/allowedOperation", "name"},
    {"location/link/allowedOperation/property", "*", &kProperties},
    {"location/property", "*", &kProperties},
    {"location/locationLayout", "*", &kEditor},
    {"block", "name"},
    {"block", "type"},
    {"block", "id", &kElementIds},
    {"block/member", "name"},
    {"block/property", "*", &kProperties},
    {"block/blockLayout", "*", &kEditor},
    {"staticRoute", "*", &kRoutes},
    {"group", "*", &kGroups},
    {"visualLayout", "scaleX"},
    {"visualLayout", "scaleY"},
    {"visualLayout", "name", &kEditor},
    {"visualLayout", "id", &kElementIds},
    {"visualLayout/color", "*", &kEditor},
    {"visualLayout/layer", "*", &kEditor},
    {"visualLayout/layerGroup", "*", &kEditor},
    {"visualLayout/shapeLayoutElement", "*", &kEditor},
    {"visualLayout/viewBookmark", "*", &kEditor},
    {"visualLayout/property", "*", &kProperties},
    {"visualLayout/modelLayoutElement", "visualizedObjectName"},
    {"visualLayout/modelLayoutElement", "layer", &kEditor},
};
// Of these the first counts.
constexpr std::string_view kSingle[] = {"point/pointLayout", "path/pathLayout", "locationType/locationTypeLayout",
                                        "visualLayout"};
constexpr std::string_view kReadProperties[] = {"tcs:defaultLocationTypeSymbol"};
constexpr std::string_view kReadDrawing[] = {"POSITION_X", "POSITION_Y", "CONN_TYPE", "CONTROL_POINTS"};

const OpentcsRule* rule_of(std::string_view element, std::string_view attribute) {
  const auto found = std::ranges::find_if(
      kOpentcsRules, [&](const OpentcsRule& rule) { return rule.element == element && rule.attribute == attribute; });
  return found == std::end(kOpentcsRules) ? nullptr : &*found;
}

bool is_read(std::string_view element) {
  return std::ranges::any_of(kOpentcsRules, [&](const OpentcsRule& rule) { return rule.element == element; }) ||
         element == "point/outgoingPath" || element == "visualLayout/modelLayoutElement/property";
}

class LeftOut {
 public:
  LeftOut(const XmlText& xml, const pugi::xml_node& model, bool takes_vehicles)
      : xml_(xml), model_(model), takes_vehicles_(takes_vehicles) {
    for (const auto child : model.children()) names_.insert(child.attribute("name").value());
    for (const auto path : model.children("path")) {
      starts_.emplace(path.attribute("sourcePoint").value(), path.attribute("name").value());
      paths_.insert(path.attribute("name").value());
    }
  }

  void tell(std::vector<std::string>& warnings) {
    attributes(model_, "");
    for (const auto child : model_.children()) visit(child, child.name(), child.attribute("name").value());
    things_.tell(warnings);
  }

 private:
  void add(const Topic& topic, const pugi::xml_node& node, const std::string& name) {
    things_.add(topic, xml_.place(node), name);
  }

  // `owner`: the name of the point, path, ... that the node belongs to.
  void visit(const pugi::xml_node& node, const std::string& path, const std::string& owner) {
    if (node.type() != pugi::node_element) return;
    if (path == "point/outgoingPath") return outgoing(node, owner);
    if (path == "visualLayout/modelLayoutElement/property") return drawn_property(node);
    if (const auto* whole = rule_of(path, "*")) return left_out(*whole, node, owner);
    if (!is_read(path)) return add(kUnknownElements, node, path);
    if (std::ranges::find(kSingle, path) != std::end(kSingle) && node.previous_sibling(node.name()))
      return add(kSecond, node, owner.empty() ? path : owner);
    attributes(node, path);
    if (path == "block/member" && !paths_.contains(node.attribute("name").value()))
      add(kMembers, node, node.attribute("name").value());
    for (const auto child : node.children()) visit(child, path + "/" + child.name(), owner);
  }

  void left_out(const OpentcsRule& rule, const pugi::xml_node& node, const std::string& owner) {
    const std::string key = node.attribute("name").value();
    if (takes_vehicles_ && rule.element == "vehicle") return;
    if (rule.topic != &kProperties) return add(*rule.topic, node, owner.empty() ? node.name() : owner);
    if (std::ranges::find(kReadProperties, key) == std::end(kReadProperties)) add(kProperties, node, key);
  }

  void attributes(const pugi::xml_node& node, const std::string& path) {
    if (const auto drawn = node.attribute("visualizedObjectName"); drawn && !names_.contains(drawn.value()))
      add(kDrawsNothing, node, drawn.value());
    for (const auto attribute : node.attributes()) {
      const std::string_view name = attribute.name();
      if (name.starts_with("xmlns") || name.starts_with("xsi:")) continue;
      const auto* rule = rule_of(path, name);
      if (rule == nullptr) {
        add(kUnknownElements, node, path + "@" + std::string(name));
      } else if (rule->topic != nullptr && attribute.value() != rule->says_nothing) {
        add(*rule->topic, node, node.attribute("name").value());
      }
    }
  }

  void outgoing(const pugi::xml_node& node, const std::string& owner) {
    attributes_but_name(node, "point/outgoingPath");
    if (!starts_.contains({owner, node.attribute("name").value()})) add(kOutgoing, node, owner);
  }
  void drawn_property(const pugi::xml_node& node) {
    const std::string_view key = node.attribute("name").value();
    if (std::ranges::find(kReadDrawing, key) == std::end(kReadDrawing)) add(kEditor, node, "");
  }
  void attributes_but_name(const pugi::xml_node& node, const std::string& path) {
    for (const auto attribute : node.attributes()) {
      if (std::string_view(attribute.name()) != "name") add(kUnknownElements, node, path + "@" + attribute.name());
    }
  }

  const XmlText& xml_;
  const pugi::xml_node model_;
  const bool takes_vehicles_;
  std::set<std::string> names_, paths_;
  std::set<std::pair<std::string, std::string>> starts_;  // point and path that starts there
  LeftOutThings things_;
};

}  // namespace

void note_left_out(const XmlText& xml, const pugi::xml_node& model, bool takes_vehicles,
                   std::vector<std::string>& warnings) {
  LeftOut(xml, model, takes_vehicles).tell(warnings);
}

}  // namespace fleetproof
