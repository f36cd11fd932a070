#include "generators/mutated_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "generators/layout_check.hpp"
#include "generators/reachability.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kMostLeftOut_percent = 10, kMostTurned_percent = 10;
constexpr double kFarthestMove_m = 0.3;

// Uniform in a disc.
Vec2 draw_move(Draws& draws) {
  while (true) {
    const double x = draws.uniform(-kFarthestMove_m, kFarthestMove_m), y = draws.uniform(-kFarthestMove_m, kFarthestMove_m);
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

void thin_out(Layout& layout, Draws& draws) {
  const std::uint32_t left_out_percent = draws.below(kMostLeftOut_percent + 1), turned_percent = draws.below(kMostTurned_percent + 1);
  // One turned alone usually cuts off what lies on its line; all of them turned keep every way round.
  const bool all_turned = draws.below(4) == 0;
  std::vector<Segment> kept;
  for (auto& segment : layout.segments) {
    const bool left_out = draws.below(100) < left_out_percent, turned = draws.below(100) < turned_percent;
    if (left_out) continue;
    if (turned != all_turned && !segment.bidirectional) {
      std::swap(segment.from, segment.to);
      std::ranges::reverse(segment.control_points_m);
    }
    kept.push_back(std::move(segment));
  }
  layout.segments = std::move(kept);
}

// The stations of the core. Who reaches whom hangs on no bend.
std::vector<StationId> core_of(const Layout& layout) {
  Layout straight;
  straight.stations = layout.stations;
  for (const auto& segment : layout.segments) straight.segments.push_back({{}, segment.from, segment.to, segment.bidirectional, {}});
  const LogicalMap map(straight);
  return Reachability(map).core();
}

void keep(Layout& layout, const std::vector<StationId>& core) {
  constexpr auto kGone = ~0U;
  std::vector<std::uint32_t> number(layout.stations.size(), kGone);
  std::vector<Station> stations;
  for (const auto station : core) {
    number[station.index()] = static_cast<std::uint32_t>(stations.size());
    stations.push_back(std::move(layout.stations[station.index()]));
  }
  std::erase_if(layout.segments, [&](const Segment& s) { return number[s.from.index()] == kGone || number[s.to.index()] == kGone; });
  for (auto& segment : layout.segments) {
    segment.from = StationId{number[segment.from.index()]};
    segment.to = StationId{number[segment.to.index()]};
  }
  layout.stations = std::move(stations);
}

}  // namespace

std::optional<Layout> draw_mutation(const Layout& base, Draws& draws, RejectionCounts& counts) {
  Layout layout = base;
  layout.name = fmt::format("{}/{}", kMutatedImport, base.name);
  thin_out(layout, draws);
  // Most draws that are refused are so for this, and it is known before anything is moved.
  const auto core = core_of(layout);
  if (2 * core.size() < base.stations.size() || core.size() < 2) {
    ++counts.of(ProblemKind::WeakCore);
    return std::nullopt;
  }
  move(layout, draws);
  fit_floor(layout, 3.0);
  if (const auto problems = problems_of(layout); !problems.empty()) {
    ++counts.of(problems[0].kind);
    return std::nullopt;
  }
  keep(layout, core);
  fit_floor(layout, 3.0);
  return layout;
}

}  // namespace fleetproof
