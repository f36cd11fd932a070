#include "generators/formats/lif_trajectories.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/tolerances.hpp"
#include "generators/formats/nurbs.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

Nurbs nurbs_of(const JsonReader& trajectory) {
  Nurbs nurbs;
  if (const auto degree = trajectory.find("degree")) {
    const double value = degree->number();
    if (!(value >= 1.0 && value <= 9.0 && value == std::floor(value)))
      degree->refuse("expected a degree of 1 to 9, a whole number");
    nurbs.degree = static_cast<std::size_t>(value);
  }
  for (const auto& knot : trajectory.at("knotVector").items()) nurbs.knots.push_back(knot.number());
  for (const auto& point : trajectory.at("controlPoints").items()) {
    nurbs.points_m.emplace_back(point.at("x").number(), point.at("y").number());
    nurbs.weights.push_back(1.0);
    point.read("weight", nurbs.weights.back());
  }
  if (const auto fault = fault_of(nurbs); !fault.empty()) trajectory.refuse(fault);
  return nurbs;
}

struct Drawn {
  std::optional<JsonReader> first;  // of all trajectories
  bool differ = false;
};

Drawn drawn_by(const std::vector<JsonReader>& rules) {
  Drawn drawn;
  std::set<bool> has_one;
  for (const auto& rule : rules) {
    const auto trajectory = rule.find("trajectory");
    has_one.insert(trajectory.has_value());
    if (drawn.first && trajectory) drawn.differ |= nurbs_of(*trajectory) != nurbs_of(*drawn.first);
    if (!drawn.first) drawn.first = trajectory;
  }
  drawn.differ |= has_one.size() > 1;
  return drawn;
}

}  // namespace

void LifTrajectories::Changed::add(const JsonReader& at, const std::string& edge, double much) {
  if (edges.empty()) place = at.place();
  edges.push_back(edge);
  most = std::max(most, much);
}

void LifTrajectories::bend(const std::vector<JsonReader>& rules, const Vec2& from_m, const Vec2& to_m,
                           Segment& segment) {
  const auto [trajectory, differ] = drawn_by(rules);
  if (!trajectory) return;
  if (differ) drawn_by_type_.add(*trajectory, segment.name);
  auto pieces = cubic_pieces(nurbs_of(*trajectory));
  const auto miss_m = [&](const Vec2& begin_m, const Vec2& end_m) {
    return std::max((begin_m - from_m).norm(), (end_m - to_m).norm());
  };
  if (miss_m(pieces.end_m, pieces.begin_m) < std::min(kOnTheNode_m, miss_m(pieces.begin_m, pieces.end_m))) {
    std::swap(pieces.begin_m, pieces.end_m);
    std::ranges::reverse(pieces.control_points_m);
    turned_.add(*trajectory, segment.name);
  }
  if (const auto fault = fault_of_ends(pieces.begin_m, pieces.end_m, from_m, to_m, "node"); !fault.empty())
    trajectory->refuse(fault);
  if (pieces.off_m > 0.0)
    (pieces.off_m > kNurbsByCubics_m ? rounded_ : replaced_).add(*trajectory, segment.name, pieces.off_m);
  const double beside_m = miss_m(pieces.begin_m, pieces.end_m);
  if (beside_m > kOnTheNode_m) beside_.add(*trajectory, segment.name, beside_m);
  segment.control_points_m = std::move(pieces.control_points_m);
  const double kink_rad = largest_kink_rad(segment);
  if (!(kink_rad > kKink_rad && kink_rad <= kSmoothedKink_rad)) return;
  smooth_joints(segment);
  aligned_.add(*trajectory, segment.name, kink_rad);
}

void LifTrajectories::tell(std::vector<std::string>& warnings) const {
  const auto say = [&](const Changed& changed, std::string_view sentence) {
    const std::size_t count = changed.edges.size();
    const auto list = name_list(changed.edges);
    if (count == 0) return;
    warnings.push_back(changed.place + ": " + fmt::vformat(sentence, fmt::make_format_args(count, list, changed.most)));
  };
  say(drawn_by_type_,
      "{0} edges have another trajectory for some types of vehicles, or none ({1}); the first counts for all");
  say(turned_, "the trajectories of {0} edges run from the end to the start ({1}); they are turned round");
  say(rounded_,
      "the trajectories of {0} edges are polylines with corners ({1}); here an arc leads round each corner, and passes "
      "by it at {2:.3f} m at most");
  say(replaced_,
      "the trajectories of {0} edges are no cubic Bezier curves ({1}); here they are such curves, which are less than "
      "{2:g} m off");
  say(beside_,
      "the trajectories of {0} edges end beside their nodes ({1}), by up to {2:.3f} m; they are drawn to the nodes");
  say(aligned_,
      "the curves of {0} edges meet at an angle ({1}) of up to {2:.3f} rad; their control points were aligned");
}

}  // namespace fleetproof
