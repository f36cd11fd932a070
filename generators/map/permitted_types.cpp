#include "generators/map/permitted_types.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/catalogue.hpp"
#include "core/base/outside_text.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

bool any(const Segment& segment, LoadState load) {
  return std::ranges::find(segment.permissions, load, &Permission::load) != segment.permissions.end();
}

bool names_a_type(const Permission& permission) { return !permission.vehicle_type.empty(); }

constexpr std::size_t kTypesListed = 10;

std::string listed(std::span<const std::string> fleet) {
  return name_list(std::vector<std::string>(fleet.begin(), fleet.end()), kTypesListed);
}

}  // namespace

std::vector<std::string> lift_types(Layout& layout) {
  std::vector<std::string> names;
  for (auto& segment : layout.segments) {
    if (std::ranges::none_of(segment.permissions, names_a_type)) continue;
    const bool all = any(segment, LoadState::Any), empty = any(segment, LoadState::Empty),
               loaded = any(segment, LoadState::Loaded);
    segment.permissions.clear();
    if (!all && empty != loaded) segment.permissions.push_back({"", empty ? LoadState::Empty : LoadState::Loaded});
    names.push_back(segment.name);
  }
  return names;
}

std::vector<ForeignType> foreign_types(const Layout& layout, std::span<const std::string> fleet) {
  std::vector<ForeignType> foreign;
  std::vector<std::string_view> unnamed(fleet.begin(), fleet.end());
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    const auto& permissions = layout.segments[i].permissions;
    for (std::size_t k = 0; k < permissions.size(); ++k) {
      const std::string& name = permissions[k].vehicle_type;
      std::erase(unnamed, name);
      if (name.empty() || std::ranges::find(fleet, name) != fleet.end()) continue;
      if (std::ranges::find(foreign, name, &ForeignType::name) == foreign.end()) foreign.push_back({i, k, name});
    }
  }
  for (auto& type : foreign) type.meant = nearest_name(type.name, unnamed).value_or("");
  return foreign;
}

std::string sentence_on(const ForeignType& type, const Layout& layout, std::span<const std::string> fleet) {
  return fmt::format("segment {} is for vehicle type {}, which this fleet does not have ({}){}",
                     in_quotes(layout.segments[type.segment].name), in_quotes(type.name), listed(fleet),
                     type.meant.empty() ? "" : fmt::format("; did you mean {}?", in_quotes(type.meant)));
}

std::string foreign_types_hint(const Layout& layout, std::span<const std::string> fleet) {
  std::vector<std::string> names;
  for (const auto& type : foreign_types(layout, fleet)) names.push_back(type.name);
  if (names.empty()) return "";
  return fmt::format("; permissions name {}, which this fleet does not have ({})", name_list(names, kTypesListed),
                     listed(fleet));
}

}  // namespace fleetproof
