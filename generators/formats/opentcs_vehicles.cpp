#include "generators/formats/opentcs_vehicles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <set>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr Topic kWidths{"{0} vehicles have no width ({1}); they have the width of the default vehicle"};
constexpr Topic kLengths{"{0} vehicles have no length ({1}); they have the length of the default vehicle"};
constexpr Topic kSecondLengths{
    "{0} vehicles have another length beside that of their bounding box ({1}); the box counts"};
constexpr Topic kSpeeds{"{0} vehicles have no velocity above 0 ({1}); they have the speed of the default vehicle"};
constexpr Topic kBeside{
    "{0} vehicles have their reference point beside their middle line ({1}); here it is on the line"};
constexpr Topic kNoReverse{"{0} vehicles cannot drive backward ({1}); here an AGV may where a segment allows it"};
constexpr Topic kEnvelopeKeys{"{0} vehicles have an envelope key ({1}); it is left out, because the body is followed"};
constexpr Topic kOtherVehicleDetails{"{0} kinds of vehicle details are left out ({1})"};

constexpr std::string_view kVehicleKeysRead[] = {"name", "length", "maxVelocity", "maxReverseVelocity", "envelopeKey"};

class VehicleReader {
 public:
  VehicleReader(const XmlText& xml, LeftOutThings& things) : xml_(xml), things_(things) {}

  ForeignVehicle read(const pugi::xml_node& node) {
    ForeignVehicle vehicle;
    vehicle.type.name = xml_.text(node, "name");
    if (const char* fault = fault_of_name(vehicle.type.name))
      xml_.refuse(node, fmt::format("name {}: {}", in_quotes(vehicle.type.name), fault));
    vehicle.vehicles.push_back(vehicle.type.name);
    body(node, vehicle);
    speeds(node, vehicle);
    if (node.attribute("envelopeKey")) note(kEnvelopeKeys, node);
    for (const auto attribute : node.attributes()) {
      if (std::ranges::find(kVehicleKeysRead, attribute.name()) == std::end(kVehicleKeysRead))
        things_.add(kOtherVehicleDetails, xml_.place(node), attribute.name());
    }
    for (const auto child : node.children()) {
      if (child.type() == pugi::node_element && std::string_view(child.name()) != "boundingBox")
        things_.add(kOtherVehicleDetails, xml_.place(child), child.name());
    }
    return vehicle;
  }

 private:
  void note(const Topic& topic, const pugi::xml_node& node) {
    things_.add(topic, xml_.place(node), node.attribute("name").value());
  }

  double metres(const pugi::xml_node& node, const char* name) const {
    const double value_m = xml_.number(node, name) / 1000.0;
    if (!(value_m >= kSmallestBody_m && value_m <= kLargestBody_m))
      xml_.refuse(node, fmt::format("{} is {} m; expected 1 to 100000 mm", name, value_m));
    return value_m;
  }

  double offset_m(const pugi::xml_node& box, const char* name) const {
    const double value_m = xml_.has(box, name) ? xml_.number(box, name) / 1000.0 : 0.0;
    if (!(std::abs(value_m) <= kLargestBody_m))
      xml_.refuse(box, fmt::format("{} is {} m; expected -100000 to 100000 mm", name, value_m));
    return value_m;
  }

  // The reference offset leads from the middle of the box to the point that follows the track.
  void body(const pugi::xml_node& node, ForeignVehicle& vehicle) {
    const auto box = node.child("boundingBox");
    if (const auto second = box.next_sibling("boundingBox"))
      xml_.refuse(second, "is the second boundingBox of this vehicle; remove one of them");
    const auto lengths_in = box ? box : node;
    auto& [length_m, width_m, centre_ahead_m] = vehicle.type.footprint;
    if (xml_.has(lengths_in, "length")) {
      vehicle.give("length_m", length_m, metres(lengths_in, "length"));
    } else {
      note(kLengths, node);
    }
    if (xml_.has(box, "width")) {
      vehicle.give("width_m", width_m, metres(box, "width"));
    } else {
      note(kWidths, node);
    }
    if (xml_.has(box, "height")) things_.add(kOtherVehicleDetails, xml_.place(box), "height");
    if (box && xml_.has(node, "length") && xml_.number(node, "length") != xml_.number(box, "length"))
      note(kSecondLengths, node);
    const double ahead_m = offset_m(box, "referenceOffsetX");
    if (ahead_m != 0.0) vehicle.give("centre_ahead_m", centre_ahead_m, -ahead_m);
    if (offset_m(box, "referenceOffsetY") != 0.0) note(kBeside, node);
  }

  void speeds(const pugi::xml_node& node, ForeignVehicle& vehicle) {
    const auto speed_mps = [&](const char* name) {
      const double value_mps = xml_.has(node, name) ? xml_.number(node, name) / 1000.0 : 0.0;
      if (!(value_mps == 0.0 || (value_mps >= kSlowest && value_mps <= kFastest)))
        xml_.refuse(node, fmt::format("{} is {} m/s; expected 1 to 100000 mm/s, or 0", name, value_mps));
      return value_mps;
    };
    const double forward_mps = speed_mps("maxVelocity"), backward_mps = speed_mps("maxReverseVelocity");
    if (forward_mps > 0.0) {
      vehicle.give("speed_mps", vehicle.type.drive.speed_mps, forward_mps);
    } else {
      note(kSpeeds, node);
    }
    if (backward_mps > 0.0) {
      vehicle.give("reverse_speed_mps", vehicle.type.reverse_speed_mps, backward_mps);
    } else {
      note(kNoReverse, node);
    }
  }

  const XmlText& xml_;
  LeftOutThings& things_;
};

}  // namespace

std::vector<ForeignVehicle> read_opentcs_vehicles(const std::string& path, std::vector<std::string>& warnings) {
  return parse_opentcs_vehicles(read_text_file(path), path, warnings);
}

std::vector<ForeignVehicle> parse_opentcs_vehicles(std::string_view text, std::string_view source,
                                                   std::vector<std::string>& warnings) {
  const XmlText xml(text, source);
  pugi::xml_document document;
  xml.load(document);
  const auto model = document.child("model");
  if (!model.child("vehicle"))
    throw InputError(source, "has no <vehicle>; write the [[vehicle]] tables of the campaign by hand");
  LeftOutThings things;
  std::vector<ForeignVehicle> vehicles;
  std::set<std::string> names;
  for (const auto node : model.children("vehicle")) {
    vehicles.push_back(VehicleReader(xml, things).read(node));
    const std::string& name = vehicles.back().type.name;
    if (!names.insert(name).second)
      xml.refuse(node, fmt::format("name {} is there twice; rename one vehicle", in_quotes(name)));
  }
  things.tell(warnings);
  return joined(vehicles);
}

}  // namespace fleetproof
