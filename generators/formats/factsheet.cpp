#include "generators/formats/factsheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/formats/vehicles.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr Topic kLoadPlaces{"{0} load sets do not say where the load lies ({1}); it lies over the middle of the body"};
constexpr Topic kAngles{"{0} load sets have a load that lies askew ({1}); the circle around it counts"};
constexpr Topic kOneSide{
    "{0} load sets have a load that reaches farther out on one side ({1}); here it does so on both sides"};
constexpr Topic kNoSize{"{0} load sets have no dimensions ({1}); these loads do not change the body"};
constexpr Topic kWeights{"{0} load sets have a largest weight ({1}); it is left out: no weight is modelled"};
constexpr Topic kOtherLoadDetails{"{0} kinds of details of load sets are left out ({1})"};

constexpr double kSlightest_m = 1e-6;       // what a load adds below this is rounding
constexpr double kSlightest_rad = 1e-3;     // as in files that round pi
constexpr double kSmallestShare = 0.1;      // that the model has
constexpr double kLargestAngle_rad = 1000;  // far beyond any number of turns that is meant

constexpr std::string_view kLoadKeysRead[] = {"setName",
                                              "boundingBoxReference",
                                              "loadDimensions",
                                              "maxWeight",
                                              "maximumWeight",
                                              "agvSpeedLimit",
                                              "maximumSpeed",
                                              "agvAccelerationLimit",
                                              "maximumAcceleration",
                                              "agvDecelerationLimit",
                                              "pickTime",
                                              "maximumDeceleration",
                                              "dropTime"};

// A member as versions 2 and 3 of VDA 5050 call it. Throws InputError if there are both.
std::optional<JsonReader> either_spelling(const JsonReader& of, std::string_view old_key, std::string_view new_key) {
  auto old_one = of.find(old_key), new_one = of.find(new_key);
  if (old_one && new_one && old_key != new_key)
    new_one->refuse(fmt::format("{} is there, too; remove one of them", old_key));
  return old_one ? old_one : new_one;
}

// Throws InputError if the value is not an object.
void expect_an_object(const JsonReader& value) {
  if (value.value().shape != JsonValue::Shape::Object) value.refuse("expected an object {...}");
}

// A number within these bounds. Throws InputError.
double number_within(const JsonReader& value, double low, double high) {
  const double number = value.number();
  if (!(number >= low && number <= high)) value.refuse(fmt::format("expected {:g} to {:g}", low, high));
  return number;
}

// ---- load sets

// The lowest of the numbers that load sets give.
struct Lowest {
  std::optional<double> value;

  void take(std::optional<double> other) {
    if (other) value = std::min(value.value_or(*other), *other);
  }
};

class LoadSets {
 public:
  LoadSets(ForeignVehicle& vehicle, std::vector<std::string>& warnings) : vehicle_(vehicle), warnings_(warnings) {}

  void read(const JsonReader& list) {
    const auto sets = list.items();
    for (std::size_t i = 0; i < sets.size(); ++i) {
      expect_an_object(sets[i]);
      const auto name = sets[i].find("setName");
      name_ = name ? printable(name->text(), 40) : fmt::format("{}", i);
      read_set(sets[i]);
    }
    if (sets.size() > 1)
      warnings_.push_back(
          fmt::format("{}: the {} load sets become one; the largest load and the lowest limits and times count",
                      list.place(), sets.size()));
    things_.tell(warnings_);
    give_size(list);
    give_speed(list);
    if (pick_s_.value) vehicle_.give("pick_s", vehicle_.type.pick_s, *pick_s_.value);
    if (drop_s_.value) vehicle_.give("drop_s", vehicle_.type.drop_s, *drop_s_.value);
  }

 private:
  void read_set(const JsonReader& set) {
    if (const auto size = set.find("loadDimensions")) {
      cover(set, *size);
    } else {
      things_.add(kNoSize, set.place(), name_);
    }
    const auto limit = [&](std::string_view old_key, std::string_view new_key) -> std::optional<double> {
      const auto found = either_spelling(set, old_key, new_key);
      return found ? std::optional(number_within(*found, kSlowest, kFastest)) : std::nullopt;
    };
    speed_mps_.take(limit("agvSpeedLimit", "maximumSpeed"));
    acceleration_mps2_.take(limit("agvAccelerationLimit", "maximumAcceleration"));
    deceleration_mps2_.take(limit("agvDecelerationLimit", "maximumDeceleration"));
    const auto duration = [&](std::string_view key) -> std::optional<double> {
      const auto found = set.find(key);
      return found ? std::optional(number_within(*found, 0.0, kHour_s)) : std::nullopt;
    };
    pick_s_.take(duration("pickTime"));
    drop_s_.take(duration("dropTime"));
    if (const auto weight = either_spelling(set, "maxWeight", "maximumWeight")) {
      number_within(*weight, 0.0, 1e9);
      things_.add(kWeights, weight->place(), name_);
    }
    for (const auto& key : set.value().keys) {
      if (std::ranges::find(kLoadKeysRead, key) == std::end(kLoadKeysRead))
        things_.add(kOtherLoadDetails, set.at(key).place(), key);
    }
    note_others(set, "loadDimensions", {"length", "width"});
    note_others(set, "boundingBoxReference", {"x", "y", "theta"});
  }

  void note_others(const JsonReader& set, std::string_view key, std::initializer_list<std::string_view> read) {
    const auto part = set.find(key);
    if (!part) return;
    for (const auto& inner : part->value().keys) {
      if (std::ranges::find(read, inner) == read.end())
        things_.add(kOtherLoadDetails, part->at(inner).place(), fmt::format("{}.{}", key, inner));
    }
  }

  // The load's box; its reference is the middle of its floor, in the coordinates of the vehicle.
  void cover(const JsonReader& set, const JsonReader& size) {
    expect_an_object(size);
    double half_x_m = number_within(size.at("length"), kSmallestBody_m, kLargestBody_m) / 2.0;
    double half_y_m = number_within(size.at("width"), kSmallestBody_m, kLargestBody_m) / 2.0;
    const double middle_m = vehicle_.type.footprint.centre_ahead_m;
    double x_m = middle_m, y_m = 0.0;
    if (const auto reference = set.find("boundingBoxReference")) {
      expect_an_object(*reference);
      x_m = number_within(reference->at("x"), -kLargestBody_m, kLargestBody_m);
      y_m = number_within(reference->at("y"), -kLargestBody_m, kLargestBody_m);
      if (const auto theta = reference->find("theta")) turn(*theta, half_x_m, half_y_m);
    } else {
      things_.add(kLoadPlaces, set.place(), name_);
    }
    const double ahead_m = x_m + half_x_m - middle_m, behind_m = middle_m - x_m + half_x_m;
    const double left_m = y_m + half_y_m, right_m = half_y_m - y_m;
    const auto& body = vehicle_.type.footprint;
    if (reaches_out(ahead_m, behind_m, body.length_m) || reaches_out(left_m, right_m, body.width_m))
      things_.add(kOneSide, set.place(), name_);
    length_m_ = std::max({length_m_, 2.0 * ahead_m, 2.0 * behind_m});
    width_m_ = std::max({width_m_, 2.0 * left_m, 2.0 * right_m});
  }

  static bool reaches_out(double one_m, double other_m, double size_m) {
    return std::max(one_m, other_m) > size_m / 2.0 + kSlightest_m && std::abs(one_m - other_m) > kSlightest_m;
  }

  // By quarters of a turn exactly. Any other angle needs no sine if the load may lie at every angle.
  void turn(const JsonReader& theta, double& half_x_m, double& half_y_m) {
    const double quarters = number_within(theta, -kLargestAngle_rad, kLargestAngle_rad) / (std::numbers::pi / 2.0);
    const double whole = std::round(quarters);
    if (std::abs(quarters - whole) * (std::numbers::pi / 2.0) > kSlightest_rad) {
      things_.add(kAngles, theta.place(), name_);
      half_x_m = half_y_m = std::sqrt(half_x_m * half_x_m + half_y_m * half_y_m);
    } else if (static_cast<int>(whole) % 2 != 0) {
      std::swap(half_x_m, half_y_m);
    }
  }

  void give_size(const JsonReader& list) {
    auto& [extra_length_m, extra_width_m, speed_share, acceleration_share] = vehicle_.type.loaded;
    const auto give = [&](std::string_view key, double& target, double with_load_m, double body_m) {
      if (with_load_m > kLargestBody_m)
        list.refuse(
            fmt::format("the body with its load is {:g} m; expected at most {:g} m", with_load_m, kLargestBody_m));
      if (with_load_m > body_m + kSlightest_m) vehicle_.give(key, target, with_load_m - body_m);
    };
    give("loaded_extra_length_m", extra_length_m, length_m_, vehicle_.type.footprint.length_m);
    give("loaded_extra_width_m", extra_width_m, width_m_, vehicle_.type.footprint.width_m);
  }

  void give_speed(const JsonReader& list) {
    const auto warn = [&](std::string_view sentence) {
      warnings_.push_back(fmt::format("{}: {}", list.place(), sentence));
    };
    const auto& drive = vehicle_.type.drive;
    const auto give = [&](std::string_view key, double& target, double share) {
      if (share < kSmallestShare)
        warn(fmt::format("{} would be {:.3g}; it is {:g}, the least that is modelled", key, share, kSmallestShare));
      if (share < 1.0) vehicle_.give(key, target, std::max(share, kSmallestShare));
    };
    auto& loaded = vehicle_.type.loaded;
    if (speed_mps_.value) give("loaded_speed_share", loaded.speed_share, *speed_mps_.value / drive.speed_mps);
    const double speeding_up = acceleration_mps2_.value.value_or(drive.acceleration_mps2) / drive.acceleration_mps2;
    const double braking = deceleration_mps2_.value.value_or(drive.deceleration_mps2) / drive.deceleration_mps2;
    if (std::min(speeding_up, 1.0) != std::min(braking, 1.0))
      warn("acceleration and braking with a load differ in their shares; the lower share counts for both");
    give("loaded_acceleration_share", loaded.acceleration_share, std::min(speeding_up, braking));
  }

  ForeignVehicle& vehicle_;
  std::vector<std::string>& warnings_;
  LeftOutThings things_;
  std::string name_;  // of the set that is read
  double length_m_ = 0.0, width_m_ = 0.0;
  Lowest speed_mps_, acceleration_mps2_, deceleration_mps2_, pick_s_, drop_s_;
};

// What the load sets of a factsheet (loadSpecification) say of the vehicle with a load. The body covers every load that
// they allow. The lowest speed, acceleration and braking count, and the shortest times of transfers. `warnings`
// receives a sentence for each kind of thing that was left out or changed. Throws InputError with file, line, key,
// value, remedy. Requires: the vehicle has its size, speed and accelerations already.
void read_load_sets(const JsonReader& specification, ForeignVehicle& vehicle, std::vector<std::string>& warnings) {
  expect_an_object(specification);
  if (const auto list = specification.find("loadSets"); list && !list->items().empty())
    LoadSets(vehicle, warnings).read(*list);
}

// ---- the factsheet

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
