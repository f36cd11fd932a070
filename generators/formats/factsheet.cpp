#include "generators/formats/factsheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr Topic kOther{"{0} parts of the factsheet are left out ({1})"};
constexpr double kSameSize = 0.01;  // share by which a body and its envelope may differ

constexpr std::string_view kSize = "physicalParameters", kType = "typeSpecification";
constexpr std::string_view kGeometry[] = {"agvGeometry", "mobileRobotGeometry"};

// A number under physicalParameters, as versions 2 and 3 call it.
struct Parameter {
  std::string_view old_key, new_key, field;
  double low, high;
  double& (*of)(VehicleType& type);
};
constexpr Parameter kParameters[] = {{"length", "length", "length_m", kSmallestBody_m, kLargestBody_m,
                                      [](VehicleType& t) -> double& { return t.footprint.length_m; }},
                                     {"width", "width", "width_m", kSmallestBody_m, kLargestBody_m,
                                      [](VehicleType& t) -> double& { return t.footprint.width_m; }},
                                     {"speedMax", "maximumSpeed", "speed_mps", kSlowest, kFastest,
                                      [](VehicleType& t) -> double& { return t.drive.speed_mps; }},
                                     {"accelerationMax", "maximumAcceleration", "acceleration_mps2", kSlowest, kFastest,
                                      [](VehicleType& t) -> double& { return t.drive.acceleration_mps2; }},
                                     {"decelerationMax", "maximumDeceleration", "deceleration_mps2", kSlowest, kFastest,
                                      [](VehicleType& t) -> double& { return t.drive.deceleration_mps2; }},
                                     {"angularSpeedMax", "maximumAngularSpeed", "turn_speed_radps", kSlowest, kFastest,
                                      [](VehicleType& t) -> double& { return t.turn.speed_radps; }}};

bool is_parameter(std::string_view key) {
  return std::ranges::any_of(kParameters, [&](const Parameter& p) { return key == p.old_key || key == p.new_key; });
}

class FactsheetReader {
 public:
  FactsheetReader(const JsonReader& root, std::vector<std::string>& warnings) : root_(root), warnings_(warnings) {}

  ForeignVehicle read() {
    const auto size = root_.find(kSize);
    if (!size) root_.refuse("has no physicalParameters; expected a VDA 5050 factsheet");
    if (const auto type = root_.find(kType)) {
      if (const auto name = type->find("seriesName"); name && name->is_text()) {
        vehicle_.type.name = name->text();
        if (const char* fault = fault_of_name(vehicle_.type.name)) name->refuse(fault);
      }
    }
    vehicle_.vehicles.push_back(vehicle_.type.name);
    for (const auto& parameter : kParameters) take(*size, parameter);
    for (const auto key : kGeometry) {
      if (const auto geometry = root_.find(key)) envelopes(*geometry);
    }
    if (!gives("length_m") || !gives("width_m"))
      size->refuse("gives no length and width, and there is no envelope; add them");
    note_left_out(*size);
    return std::move(vehicle_);
  }

 private:
  bool gives(std::string_view key) const { return std::ranges::find(vehicle_.keys, key) != vehicle_.keys.end(); }
  void warn(const JsonReader& at, std::string_view sentence) {
    warnings_.push_back(fmt::format("{}: {}", at.place(), sentence));
  }

  void take(const JsonReader& size, const Parameter& parameter) {
    auto found = size.find(parameter.old_key);
    if (!found) found = size.find(parameter.new_key);
    double& target = parameter.of(vehicle_.type);
    if (!found)
      return warn(size, fmt::format("gives no {}; {} stays {:g}", parameter.new_key, parameter.field, target));
    const double value = found->number();
    if (!(value >= parameter.low && value <= parameter.high))
      found->refuse(fmt::format("expected {:g} to {:g}", parameter.low, parameter.high));
    vehicle_.give(parameter.field, target, value);
  }

  // The first of them. The body is the rectangle around it and around length and width.
  void envelopes(const JsonReader& geometry) {
    const auto list = geometry.find("envelopes2d");
    if (!list || list->items().empty()) return;
    const auto all = list->items();
    if (all.size() > 1) warn(*list, fmt::format("the first of {} envelopes is read", all.size()));
    auto points = all[0].find("polygonPoints");
    if (!points) points = all[0].find("vertices");
    if (!points) return;
    Box box;
    for (const auto& point : points->items()) box.add(Vec2(point.at("x").number(), point.at("y").number()));
    if (points->items().size() < 3) points->refuse("an envelope has 3 points or more");
    auto& [length_m, width_m, centre_ahead_m] = vehicle_.type.footprint;
    const double ahead_m = (box.low_m.x() + box.high_m.x()) / 2.0;
    const double long_m = box.high_m.x() - box.low_m.x(),
                 wide_m = 2.0 * std::max(std::abs(box.low_m.y()), std::abs(box.high_m.y()));
    widen(*points, "length_m", length_m, long_m);
    widen(*points, "width_m", width_m, wide_m);
    if (std::abs(ahead_m) > kSmallestBody_m) vehicle_.give("centre_ahead_m", centre_ahead_m, ahead_m);
  }

  void widen(const JsonReader& points, std::string_view key, double& size_m, double envelope_m) {
    if (gives(key) && std::abs(envelope_m - size_m) > kSameSize * size_m)
      warn(points,
           fmt::format("{} is {:g} m, and the envelope has {:g} m; the larger counts", key, size_m, envelope_m));
    if (gives(key) && envelope_m <= size_m) return;
    if (!(envelope_m >= kSmallestBody_m && envelope_m <= kLargestBody_m))
      points.refuse(fmt::format("the envelope gives a {} of {:g}; expected 0.001 to 100 m", key, envelope_m));
    gives(key) ? void(size_m = envelope_m) : vehicle_.give(key, size_m, envelope_m);
  }

  void note_left_out(const JsonReader& size) {
    LeftOutThings things;
    for (const auto& key : root_.value().keys) {
      if (key == kSize || std::ranges::find(kGeometry, key) != std::end(kGeometry)) continue;
      if (key != kType) {
        things.add(kOther, root_.at(key).place(), key);
        continue;
      }
      for (const auto& inner : root_.at(key).value().keys) {
        if (inner != "seriesName") things.add(kOther, root_.at(key).at(inner).place(), key + "." + inner);
      }
    }
    for (const auto& key : size.value().keys) {
      if (!is_parameter(key)) things.add(kOther, size.at(key).place(), fmt::format("{}.{}", kSize, key));
    }
    for (const auto key : kGeometry) {
      const auto geometry = root_.find(key);
      if (!geometry) continue;
      for (const auto& inner : geometry->value().keys) {
        if (inner != "envelopes2d") things.add(kOther, geometry->at(inner).place(), fmt::format("{}.{}", key, inner));
      }
    }
    things.tell(warnings_);
  }

  const JsonReader root_;
  std::vector<std::string>& warnings_;
  ForeignVehicle vehicle_;
};

}  // namespace

ForeignVehicle read_factsheet(const std::string& path, std::vector<std::string>& warnings) {
  return parse_factsheet(read_text_file(path), path, warnings);
}

ForeignVehicle parse_factsheet(std::string_view text, std::string_view source, std::vector<std::string>& warnings) {
  const auto root = parse_json(text, source);
  return FactsheetReader(JsonReader(root, source), warnings).read();
}

}  // namespace fleetproof
