#include "generators/formats/vehicles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/base/outside_text.hpp"
#include "core/scenario/vehicle_fields.hpp"

namespace fleetproof {
namespace {

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
