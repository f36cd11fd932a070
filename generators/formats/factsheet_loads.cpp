#include "generators/formats/factsheet_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "core/base/outside_text.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/left_out.hpp"

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

}  // namespace

std::optional<JsonReader> either_spelling(const JsonReader& of, std::string_view old_key, std::string_view new_key) {
  auto old_one = of.find(old_key), new_one = of.find(new_key);
  if (old_one && new_one && old_key != new_key)
    new_one->refuse(fmt::format("{} is there, too; remove one of them", old_key));
  return old_one ? old_one : new_one;
}

void expect_an_object(const JsonReader& value) {
  if (value.value().shape != JsonValue::Shape::Object) value.refuse("expected an object {...}");
}

double number_within(const JsonReader& value, double low, double high) {
  const double number = value.number();
  if (!(number >= low && number <= high)) value.refuse(fmt::format("expected {:g} to {:g}", low, high));
  return number;
}

void read_load_sets(const JsonReader& specification, ForeignVehicle& vehicle, std::vector<std::string>& warnings) {
  expect_an_object(specification);
  if (const auto list = specification.find("loadSets"); list && !list->items().empty())
    LoadSets(vehicle, warnings).read(*list);
}

}  // namespace fleetproof
