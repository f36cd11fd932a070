#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/words.hpp"
#include "core/scenario/faults.hpp"

namespace fleetproof {

// The names of the probes that the world reports. They stand in campaign files ([coverage] probes), archives and
// reports, so no other place writes or parses one.
//
// name                                              | met when                                  | reported by
// --------------------------------------------------|-------------------------------------------|----------------
// "head-on", "crossing", "following", "merging"     | the drives of two AGVs met in this way    | law coverage
// "tight-gap", "curve-beside-lane", "overhang-pass" | two AGVs drove side by side in this way   | law coverage
// "back-in"                                         | two drives met, one of them backward      | law coverage
// "bottleneck", "four-way"                          | two AGVs drove to such a place            | law coverage
// "near-miss"                                       | two AGVs came close without a violation   | law coverage
// "fault: KIND", as in "fault: breakdown"           | a fault of this kind struck               | law coverage
// "fault: named WORD", as in "fault: named cut"     | a named fault with this word struck       | law coverage
// "encounter"                                       | any of the first four                     | evidence
// "safe-mode"                                       | an AGV was in safe mode                   | evidence

// How the drives of two AGVs meet (laws/encounter.hpp says which is which).
enum class EncounterKind : std::uint8_t { HeadOn, Crossing, Following, Merging };
constexpr const char* name_of(EncounterKind kind) {
  switch (kind) {
    case EncounterKind::HeadOn:
      return "head-on";
    case EncounterKind::Crossing:
      return "crossing";
    case EncounterKind::Following:
      return "following";
    case EncounterKind::Merging:
      return "merging";
  }
  return kNoWord;
}
inline constexpr std::size_t kEncounterKinds = kValuesOf<EncounterKind>.size();

// What two AGVs met on the floor, beside each other (laws/side_by_side.hpp) or at a place (laws/map_places.hpp).
enum class SceneKind : std::uint8_t { TightGap, CurveBesideLane, OverhangPass, Bottleneck, FourWay, BackIn };
constexpr const char* name_of(SceneKind kind) {
  switch (kind) {
    case SceneKind::TightGap:
      return "tight-gap";
    case SceneKind::CurveBesideLane:
      return "curve-beside-lane";
    case SceneKind::OverhangPass:
      return "overhang-pass";
    case SceneKind::Bottleneck:
      return "bottleneck";
    case SceneKind::FourWay:
      return "four-way";
    case SceneKind::BackIn:
      return "back-in";
  }
  return kNoWord;
}
inline constexpr std::size_t kSceneKinds = kValuesOf<SceneKind>.size();

inline constexpr std::string_view kNearMissProbe = "near-miss";
inline constexpr std::string_view kEncounterProbe = "encounter";
inline constexpr std::string_view kSafeModeProbe = "safe-mode";
// `word`: of a named fault.
std::string probe_name(Fault::Kind fault, std::string_view word = {});

// Every name of the world but those of named faults, whose words a campaign chooses.
std::span<const std::string_view> world_probes();

bool is_encounter_probe(std::string_view name);
// Whether the name belongs to the world, so that no agent can declare it: a name of the list, or one that begins with
// "fault:".
bool is_world_probe(std::string_view name);
// Whether the name begins with "fault:", so that it has to name a fault.
bool is_fault_probe(std::string_view name);

}  // namespace fleetproof
