#include "generators/families/mutated_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "generators/map/core_only.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/strong_components.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kMostLeftOut_percent = 10, kMostTurned_percent = 10;
constexpr double kFarthestMove_m = 0.3, kMargin_m = 3.0;

// Uniform in a disc.
Vec2 draw_move(Draws& draws) {
  while (true) {
    const double x = draws.uniform(-kFarthestMove_m, kFarthestMove_m),
                 y = draws.uniform(-kFarthestMove_m, kFarthestMove_m);
    if (x * x + y * y <= kFarthestMove_m * kFarthestMove_m) return {x, y};
  }
}

// Control points go along with the nearer end of their segment.
void move(Layout& layout, Draws& draws) {
  const double scale = draws.uniform(0.8, 1.2);
  std::vector<Vec2> moves;
  for (auto& station : layout.stations) {
    moves.push_back(draw_move(draws));
    station.position_m = scale * station.position_m + moves.back();
  }
  for (auto& segment : layout.segments) {
    auto& points = segment.control_points_m;
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = scale * points[i] + moves[(2 * i < points.size() ? segment.from : segment.to).index()];
    }
    smooth_joints(segment);
  }
}

enum class Delivery : std::uint8_t { AsItIs, Turned, LeftOut };

// By segment.
std::vector<Delivery> draw_deliveries(const Layout& base, Draws& draws) {
  const std::uint32_t left_out_percent = draws.below(kMostLeftOut_percent + 1),
                      turned_percent = draws.below(kMostTurned_percent + 1);
  // If only one segment of a ring is reversed, stations usually become unreachable. If all of them are reversed, every
  // station stays reachable.
  const bool all_turned = draws.below(4) == 0;
  std::vector<Delivery> deliveries(base.segments.size());
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    const bool left_out = draws.below(100) < left_out_percent, turned = draws.below(100) < turned_percent;
    deliveries[i] = left_out                                                  ? Delivery::LeftOut
                    : turned != all_turned && !base.segments[i].bidirectional ? Delivery::Turned
                                                                              : Delivery::AsItIs;
  }
  return deliveries;
}

// Which stations reach each other afterwards. This comes before any segment is copied, because it refuses most draws.
StrongComponents parts_left(const Layout& base, const std::vector<Delivery>& deliveries) {
  std::vector<Arrow> arrows;
  arrows.reserve(2 * deliveries.size());
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    const auto& segment = base.segments[i];
    if (deliveries[i] == Delivery::LeftOut) continue;
    if (segment.bidirectional || deliveries[i] == Delivery::AsItIs)
      arrows.push_back({segment.from.value, segment.to.value});
    if (segment.bidirectional || deliveries[i] == Delivery::Turned)
      arrows.push_back({segment.to.value, segment.from.value});
  }
  return strong_components(base.stations.size(), arrows);
}

Layout what_is_left(const Layout& base, const std::vector<Delivery>& deliveries) {
  Layout layout;
  layout.name = fmt::format("{}/{}", kMutatedImport, base.name);
  layout.stations = base.stations;
  // Stations move, and the lanes of a mutation no longer arrive with these headings.
  for (Station& station : layout.stations) {
    station.turning = true;
    station.heading.reset();
  }
  layout.blocks = base.blocks;
  layout.segments.reserve(deliveries.size());
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    if (deliveries[i] == Delivery::LeftOut) continue;
    auto& segment = layout.segments.emplace_back(base.segments[i]);
    if (deliveries[i] != Delivery::Turned) continue;
    std::swap(segment.from, segment.to);
    std::ranges::reverse(segment.control_points_m);
  }
  return layout;
}

bool is_kept(const Segment& segment, const StrongComponents& parts) {
  return parts.in_largest(segment.from.index()) && parts.in_largest(segment.to.index());
}

bool is_drivable(const Curve& curve) { return fault_of_curve(curve).empty(); }

}  // namespace

// Judges like problems_of(), but without the parts that no mutation changes: names, references and numbers of control
// points are those of the base.
std::shared_ptr<const LogicalMap> draw_mutated_map(const Layout& base, Draws& draws, RejectionCounts& counts) {
  const auto refused = [&](ProblemKind kind) -> std::shared_ptr<const LogicalMap> {
    ++counts.of(kind);
    return nullptr;
  };
  const auto deliveries = draw_deliveries(base, draws);
  const auto parts = parts_left(base, deliveries);
  if (2 * parts.largest_size < base.stations.size() || parts.largest_size < 2) return refused(ProblemKind::WeakCore);
  Layout layout = what_is_left(base, deliveries);
  move(layout, draws);
  fit_floor(layout, kMargin_m);  // it holds all points
  if (!on_the_floor(layout.floor_low_m) || !on_the_floor(layout.floor_high_m))
    return refused(ProblemKind::NumberOutOfRange);
  // A bad segment refuses the draw also if it is cut off below. Otherwise seeds would draw other layouts than before.
  for (const auto& segment : layout.segments) {
    if (!is_kept(segment, parts) && !is_drivable(segment_curve(layout, segment)))
      return refused(ProblemKind::BadGeometry);
  }
  keep_largest(layout, parts);
  fit_floor(layout, kMargin_m);
  auto map = std::make_shared<const LogicalMap>(layout);
  for (const auto& lane : map->lanes()) {
    const bool forward = lane.from == map->segment(lane.segment).from;
    if (forward && !is_drivable(lane.curve)) return refused(ProblemKind::BadGeometry);
  }
  return map;
}

std::optional<Layout> draw_mutation(const Layout& base, Draws& draws, RejectionCounts& counts) {
  if (const auto map = draw_mutated_map(base, draws, counts)) return map->layout();
  return std::nullopt;
}

}  // namespace fleetproof
