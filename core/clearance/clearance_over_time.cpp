#include "core/clearance/clearance_over_time.hpp"

#include "core/clearance/advancement.hpp"
#include "core/clearance/closest_search.hpp"

namespace fleetproof {
namespace {

std::optional<SimTime> instant_of(const std::optional<Hit>& hit) { return hit ? std::optional(hit->at) : std::nullopt; }

std::optional<ApproachBelow> approach_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                            EvaluationCount& count, double tolerance_m, Dating dating) {
  if (within.end < within.begin) return std::nullopt;
  const auto hit = advance(a, b, within.begin, within.end, level_m, count, dating);
  if (!hit) return std::nullopt;
  const Hit closest = ClosestSearch(a, b, tolerance_m, count).run(within.begin, *hit, within.end);
  return ApproachBelow{hit->at, {closest.apart.clearance_m, closest.at}};
}

}  // namespace

std::optional<SimTime> first_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                   EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.begin, within.end, level_m, count));
}

std::optional<SimTime> last_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                  EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.end, within.begin, level_m, count));
}

std::optional<SimTime> comes_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                   EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.begin, within.end, level_m, count, Dating::Rough));
}

std::optional<ClosestApproach> closest_approach(const Piece& a, const Piece& b, Interval within, double below_m,
                                                EvaluationCount& count, double tolerance_m) {
  const auto approach = approach_below(a, b, within, below_m, count, tolerance_m, Dating::Rough);
  return approach ? std::optional(approach->closest) : std::nullopt;
}

std::optional<ApproachBelow> approach_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                            EvaluationCount& count, double tolerance_m) {
  return approach_below(a, b, within, level_m, count, tolerance_m, Dating::Exact);
}

}  // namespace fleetproof
