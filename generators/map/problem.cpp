#include "generators/map/problem.hpp"

namespace fleetproof {

const char* name_of(ProblemKind kind) {
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
  return "unknown";
}

}  // namespace fleetproof
