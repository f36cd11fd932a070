#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/words.hpp"

namespace fleetproof {

// What can be wrong with a layout or a scenario. The first five kinds make it unusable. The others make it a poor test:
// generators avoid them, but a hand-written scenario may contain them on purpose.
enum class ProblemKind : std::uint8_t {
  NumberOutOfRange,
  BadName,           // missing, repeated or not plain UTF-8
  UnknownReference,  // to a station, segment or vehicle type that does not exist
  BadGeometry,       // a segment that cannot be built as a smooth curve
  EmptyFleet,
  WeakCore,  // less than 90 % of the stations can all reach each other
  StartsTooClose,
  StartNearObstacle,
  StartWithoutLane,  // no lane leaves the start
  Unreachable,       // a transport for which there is no way
};

// The name of a kind in counts and pages, for example "starts-too-close".
constexpr const char* name_of(ProblemKind kind) {
  switch (kind) {
    case ProblemKind::NumberOutOfRange:
      return "number-out-of-range";
    case ProblemKind::BadName:
      return "bad-name";
    case ProblemKind::UnknownReference:
      return "unknown-reference";
    case ProblemKind::BadGeometry:
      return "bad-geometry";
    case ProblemKind::EmptyFleet:
      return "empty-fleet";
    case ProblemKind::WeakCore:
      return "weak-core";
    case ProblemKind::StartsTooClose:
      return "starts-too-close";
    case ProblemKind::StartNearObstacle:
      return "start-near-obstacle";
    case ProblemKind::StartWithoutLane:
      return "start-without-lane";
    case ProblemKind::Unreachable:
      return "unreachable";
  }
  return kNoWord;
}

inline constexpr std::size_t kProblemKinds = kValuesOf<ProblemKind>.size();

struct Problem {
  ProblemKind kind{};
  std::string pointer;   // JSON pointer to the field in the scenario or layout file
  std::string sentence;  // value, what is wrong, remedy
};

using Problems = std::vector<Problem>;

}  // namespace fleetproof
