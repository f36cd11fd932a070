#include "core/outcome/probe_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/base/words.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kFaultPrefix = "fault:";

}  // namespace

std::string probe_name(Fault::Kind fault, std::string_view word) {
  return fmt::format("{} {}{}{}", kFaultPrefix, name_of(fault), word.empty() ? "" : " ", word);
}

std::span<const std::string_view> world_probes() {
  static const std::vector<std::string> faults = [] {
    std::vector<std::string> names;
    for (const Fault::Kind fault : kValuesOf<Fault::Kind>) {
      if (fault != Fault::Kind::Named) names.push_back(probe_name(fault));
    }
    return names;
  }();
  static const std::vector<std::string_view> all = [] {
    std::vector<std::string_view> names;
    names.assign(kWordsOf<EncounterKind>.begin(), kWordsOf<EncounterKind>.end());
    names.insert(names.end(), kWordsOf<SceneKind>.begin(), kWordsOf<SceneKind>.end());
    names.insert(names.end(), {kNearMissProbe, kEncounterProbe, kSafeModeProbe});
    names.insert(names.end(), faults.begin(), faults.end());
    return names;
  }();
  return all;
}

bool is_encounter_probe(std::string_view name) { return value_of<EncounterKind>(name).has_value(); }

bool is_world_probe(std::string_view name) {
  return is_fault_probe(name) || std::ranges::find(world_probes(), name) != world_probes().end();
}

bool is_fault_probe(std::string_view name) { return name.starts_with(kFaultPrefix); }

}  // namespace fleetproof
