#include "generators/formats/factsheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/factsheet_loads.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr Topic kOtherParts{"{0} parts of the factsheet are left out ({1})"};
constexpr Topic kMaker{"the manufacturer only serves to find the vehicle in the permissions of a layout"};
constexpr double kSameSize = 0.01;  // share by which a body and its envelope may differ

constexpr std::string_view kSize = "physicalParameters", kType = "typeSpecification", kLoads = "loadSpecification";
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
    expect_an_object(*size);
    name_vehicle();
    if (const auto manufacturer = root_.find("manufacturer"); manufacturer && manufacturer->is_text())
      vehicle_.manufacturer = manufacturer->text();
    vehicle_.vehicles.push_back(vehicle_.type.name);
    for (const auto& parameter : kParameters) take(*size, parameter);
    if (const auto geometry = either_spelling(root_, kGeometry[0], kGeometry[1])) {
      expect_an_object(*geometry);
      envelopes(*geometry);
    }
    if (!has_envelope_)
      warn(root_, "gives no envelope; the reference point is taken to be the middle of the body (centre_ahead_m 0)");
    if (!gives("length_m") || !gives("width_m"))
      size->refuse("gives no length and width, and there is no envelope; add them");
    if (const auto loads = root_.find(kLoads)) read_load_sets(*loads, vehicle_, warnings_);
    note_left_out(*size);
    return std::move(vehicle_);
  }

 private:
  bool gives(std::string_view key) const { return std::ranges::find(vehicle_.keys, key) != vehicle_.keys.end(); }
  void warn(const JsonReader& at, std::string_view sentence) {
    warnings_.push_back(fmt::format("{}: {}", at.place(), sentence));
  }

  void name_vehicle() {
    const auto type = root_.find(kType);
    if (type) expect_an_object(*type);
    const auto name = type ? type->find("seriesName") : std::nullopt;
    if (!name) return warn(root_, fmt::format("gives no seriesName; the vehicle is called {}", vehicle_.type.name));
    vehicle_.type.name = name->text();
    if (const char* fault = fault_of_name(vehicle_.type.name)) name->refuse(fault);
  }

  void take(const JsonReader& size, const Parameter& parameter) {
    const auto found = either_spelling(size, parameter.old_key, parameter.new_key);
    double& target = parameter.of(vehicle_.type);
    if (found) return vehicle_.give(parameter.field, target, number_within(*found, parameter.low, parameter.high));
    const bool may_follow = parameter.old_key == "length" || parameter.old_key == "width";  // from an envelope
    if (!may_follow) warn(size, fmt::format("gives no {}; {} stays {:g}", parameter.new_key, parameter.field, target));
  }

  // The first of them. The body is the rectangle around it and around length and width.
  void envelopes(const JsonReader& geometry) {
    const auto list = geometry.find("envelopes2d");
    if (!list || list->items().empty()) return;
    has_envelope_ = true;
    const auto all = list->items();
    if (all.size() > 1) warn(*list, fmt::format("the first of {} envelopes is read", all.size()));
    expect_an_object(all[0]);
    const auto points = either_spelling(all[0], "polygonPoints", "vertices");
    if (!points) all[0].refuse("has no polygonPoints; add them, or remove the envelope");
    const auto coordinate = [](const JsonReader& point, const char* axis) {
      return number_within(point.at(axis), -kLargestBody_m, kLargestBody_m);
    };
    Box box;
    std::vector<Vec2> corners_m;
    for (const auto& point : points->items()) corners_m.emplace_back(coordinate(point, "x"), coordinate(point, "y"));
    for (const Vec2& corner_m : corners_m) box.add(corner_m);
    if (points->items().size() < 3) points->refuse("an envelope has 3 points or more");
    auto& [length_m, width_m, centre_ahead_m] = vehicle_.type.footprint;
    const double ahead_m = (box.low_m.x() + box.high_m.x()) / 2.0;
    const double long_m = box.high_m.x() - box.low_m.x(),
                 wide_m = 2.0 * std::max(std::abs(box.low_m.y()), std::abs(box.high_m.y()));
    widen(*points, "length_m", length_m, long_m);
    widen(*points, "width_m", width_m, wide_m);
    if (std::abs(box.high_m.y() + box.low_m.y()) > kSmallestBody_m)
      warn(*points,
           fmt::format("the envelope reaches from {:g} m to {:g} m across; here the body reaches {:g} m to both "
                       "sides",
                       box.low_m.y(), box.high_m.y(), width_m / 2.0));
    if (std::abs(area_m2(corners_m)) < (1.0 - kSameSize) * long_m * (box.high_m.y() - box.low_m.y()))
      warn(*points, "the envelope is no rectangle; the rectangle around it counts");
    if (std::abs(ahead_m) > kSmallestBody_m) vehicle_.give("centre_ahead_m", centre_ahead_m, ahead_m);
  }

  // By the shoelace formula; negative if the corners go round clockwise.
  static double area_m2(const std::vector<Vec2>& corners_m) {
    double twice = 0.0;
    for (std::size_t i = 0; i < corners_m.size(); ++i) {
      const Vec2 &a = corners_m[i], &b = corners_m[(i + 1) % corners_m.size()];
      twice += a.x() * b.y() - b.x() * a.y();
    }
    return twice / 2.0;
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

  void note_loads_left_out(LeftOutThings& things) {
    const JsonReader loads = root_.at(kLoads);
    for (const auto& inner : loads.value().keys) {
      if (inner != "loadSets") things.add(kOtherParts, loads.at(inner).place(), fmt::format("{}.{}", kLoads, inner));
    }
  }

  // What the first envelope says beside the coordinates of its corners.
  void note_envelope(const JsonReader& list, LeftOutThings& things) {
    const auto all = list.items();
    if (all.empty()) return;
    for (const auto& key : all[0].value().keys) {
      if (key == "polygonPoints" || key == "vertices") {
        note_coordinates(all[0].at(key), things);
      } else {
        things.add(kOtherParts, all[0].at(key).place(), "envelopes2d." + key);
      }
    }
  }

  void note_coordinates(const JsonReader& points, LeftOutThings& things) {
    for (const auto& point : points.items()) {
      for (const auto& key : point.value().keys) {
        if (key != "x" && key != "y")
          things.add(kOtherParts, point.at(key).place(), "envelopes2d.polygonPoints." + key);
      }
    }
  }

  void note_left_out(const JsonReader& size) {
    LeftOutThings things;
    for (const auto& key : root_.value().keys) {
      if (key == kLoads) note_loads_left_out(things);
      if (key == kSize || key == kLoads || std::ranges::find(kGeometry, key) != std::end(kGeometry)) continue;
      if (key != kType) {
        const bool is_maker = key == "manufacturer" && !vehicle_.manufacturer.empty();
        things.add(is_maker ? kMaker : kOtherParts, root_.at(key).place(), key);
        continue;
      }
      for (const auto& inner : root_.at(key).value().keys) {
        if (inner != "seriesName") things.add(kOtherParts, root_.at(key).at(inner).place(), key + "." + inner);
      }
    }
    for (const auto& key : size.value().keys) {
      if (!is_parameter(key)) things.add(kOtherParts, size.at(key).place(), fmt::format("{}.{}", kSize, key));
    }
    for (const auto key : kGeometry) {
      const auto geometry = root_.find(key);
      if (!geometry) continue;
      for (const auto& inner : geometry->value().keys) {
        if (inner == "envelopes2d") {
          note_envelope(geometry->at(inner), things);
        } else {
          things.add(kOtherParts, geometry->at(inner).place(), fmt::format("{}.{}", key, inner));
        }
      }
    }
    things.tell(warnings_);
  }

  const JsonReader root_;
  std::vector<std::string>& warnings_;
  ForeignVehicle vehicle_;
  bool has_envelope_ = false;
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
