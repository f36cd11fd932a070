#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fleetproof {

// What can be wrong with a layout or a scenario. The first five make it unusable; the others make it a poor test, which
// a generator avoids and a hand-written scenario may want.
enum class ProblemKind : std::uint8_t {
  NumberOutOfRange,
  BadName,           // missing, repeated or not plain UTF-8
  UnknownReference,  // to a station, segment or vehicle type that is not there
  BadGeometry,       // a segment that cannot be built as a smooth curve
  EmptyFleet,
  WeakCore,  // less than 90 % of the stations can all reach each other
  StartsTooClose,
  StartNearObstacle,
  StartWithoutLane,  // no lane leaves the start
  Unreachable,       // a transport that cannot be driven
};
inline constexpr std::size_t kProblemKinds = 10;

constexpr bool is_unusable(ProblemKind kind) { return kind <= ProblemKind::EmptyFleet; }

// "starts-too-close" and the like: for counts and pages.
const char* name_of(ProblemKind kind);

struct Problem {
  ProblemKind kind{};
  std::string pointer;   // JSON pointer to the field in the scenario or layout file
  std::string sentence;  // value, what is wrong, remedy
};

using Problems = std::vector<Problem>;

}  // namespace fleetproof
