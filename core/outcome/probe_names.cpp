#include "core/outcome/probe_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/words.hpp"

namespace fleetproof {
namespace {

using enum EncounterKind;
constexpr std::array<EncounterKind, kEncounterKinds> kEncounters{HeadOn, Crossing, Following, Merging};
constexpr std::string_view kFaultPrefix = "fault:";

}  // namespace

const char* name_of(EncounterKind kind) {
  switch (kind) {
    case HeadOn:
      return "head-on";
    case Crossing:
      return "crossing";
    case Following:
      return "following";
    case Merging:
      return "merging";
  }
  invariant_violated("an encounter has a name");
}

std::string probe_name(Fault::Kind fault) { return fmt::format("{} {}", kFaultPrefix, name_of(fault)); }

std::span<const std::string_view> world_probes() {
  static const std::vector<std::string> faults = [] {
    std::vector<std::string> names;
    for (const Fault::Kind fault : kValuesOf<Fault::Kind>) names.push_back(probe_name(fault));
    return names;
  }();
  static const std::vector<std::string_view> all = [] {
    std::vector<std::string_view> names;
    for (const EncounterKind kind : kEncounters) names.emplace_back(name_of(kind));
    names.insert(names.end(), {kNearMissProbe, kEncounterProbe, kSafeModeProbe});
    names.insert(names.end(), faults.begin(), faults.end());
    return names;
  }();
  return all;
}

bool is_encounter_probe(std::string_view name) {
  return std::ranges::any_of(kEncounters, [&](EncounterKind kind) { return name == name_of(kind); });
}

bool is_world_probe(std::string_view name) {
  return name.starts_with(kFaultPrefix) || std::ranges::find(world_probes(), name) != world_probes().end();
}

bool is_misspelt_world_probe(std::string_view name) {
  return name.starts_with(kFaultPrefix) && std::ranges::find(world_probes(), name) == world_probes().end();
}

}  // namespace fleetproof
