#include "core/clearance_over_time.hpp"
#include "core/advancement.hpp"
namespace fleetproof {
std::optional<SimTime> first_below(const Piece& a, const Piece& b, Interval within, double level_m, EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  const auto hit = advance(a, b, within.begin, within.end, level_m, count);
  return hit ? std::optional(hit->at) : std::nullopt;
}

std::optional<SimTime> last_below(const Piece& a, const Piece& b, Interval within, double level_m, EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  const auto hit = advance(a, b, within.end, within.begin, level_m, count);
  return hit ? std::optional(hit->at) : std::nullopt;
}
}
