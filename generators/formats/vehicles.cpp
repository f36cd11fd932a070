#include "generators/formats/vehicles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/base/outside_text.hpp"
#include "core/scenario/vehicle_fields.hpp"

namespace fleetproof {
namespace {

// Beyond these, a number is probably in another unit: AGVs are up to 10 m long, and drive up to 3 m/s; tyres brake with
// the weight of the vehicle at most.
constexpr double kLongest_m = 12.0, kQuickest_mps = 10.0, kHardest_mps2 = 15.0, kQuickest_radps = 10.0;

std::string in_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

// The fields that the file gave, one a line.
std::string fields_text(const ForeignVehicle& vehicle) {
  std::string text;
  visit_fields(vehicle.type, [&](const Field& field, const auto& value) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, double>) {
      if (std::ranges::find(vehicle.keys, field.key) != vehicle.keys.end())
        text += fmt::format("{} = {}\n", field.key, value);
    }
  });
  return text;
}

}  // namespace

std::vector<ForeignVehicle> joined(const std::vector<ForeignVehicle>& vehicles) {
  std::vector<ForeignVehicle> types;
  for (const auto& vehicle : vehicles) {
    const auto text = fields_text(vehicle);
    const auto same = std::ranges::find_if(types, [&](const ForeignVehicle& t) { return fields_text(t) == text; });
    if (same == types.end()) {
      types.push_back(vehicle);
    } else {
      same->vehicles.insert(same->vehicles.end(), vehicle.vehicles.begin(), vehicle.vehicles.end());
    }
  }
  return types;
}

std::string name_as_permitted(const ForeignVehicle& vehicle, const Layout& layout) {
  const std::string &series = vehicle.type.name, end = vehicle.manufacturer + "." + series;
  std::set<std::string> alike;
  for (const Segment& segment : layout.segments) {
    for (const Permission& permission : segment.permissions) {
      const std::string& name = permission.vehicle_type;
      if (name == series) return series;
      if (vehicle.manufacturer.empty() ? name.ends_with(end) : name == end) alike.insert(name);
    }
  }
  return alike.size() == 1 ? *alike.begin() : series;
}

std::vector<std::string> vehicle_questions(const VehicleType& type) {
  std::vector<std::string> questions;
  const auto ask = [&](std::string_view key, double value, double low, double high, std::string_view question) {
    if (value > 0.0 && (value < low || value > high))
      questions.push_back(fmt::format("{} is {:g}: is that in {}?", key, value, question));
  };
  const auto& body = type.footprint;
  ask("length_m", body.length_m, 0.1, kLongest_m, "millimetres, centimetres or decimetres, and not in metres");
  ask("width_m", body.width_m, 0.1, kLongest_m, "millimetres, centimetres or decimetres, and not in metres");
  ask("speed_mps", type.drive.speed_mps, 0.0, kQuickest_mps, "km/h, m/min or mm/s, and not in m/s");
  ask("reverse_speed_mps", type.reverse_speed_mps, 0.0, kQuickest_mps, "km/h, m/min or mm/s, and not in m/s");
  ask("acceleration_mps2", type.drive.acceleration_mps2, 0.0, kHardest_mps2, "mm/s2, and not in m/s2");
  ask("deceleration_mps2", type.drive.deceleration_mps2, 0.0, kHardest_mps2, "mm/s2, and not in m/s2");
  ask("turn_speed_radps", type.turn.speed_radps, 0.0, kQuickest_radps, "degrees/s, and not in rad/s");
  return questions;
}

std::string fleet_text(const std::vector<ForeignVehicle>& vehicles, std::string_view source) {
  auto text = fmt::format("# vehicles of {}\n", printable(source));
  for (const auto& vehicle : vehicles) {
    text += fmt::format("\n[[vehicle]]\nname = {}\n", in_toml(vehicle.type.name));
    if (vehicle.vehicles.size() > 1)
      text += fmt::format("share = {}  # {}\n", vehicle.vehicles.size(), fmt::join(vehicle.vehicles, ", "));
    text += fields_text(vehicle);
  }
  return text;
}

}  // namespace fleetproof
