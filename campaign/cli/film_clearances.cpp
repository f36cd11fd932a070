#include "campaign/cli/film_clearances.hpp"

#include <algorithm>
#include <set>

#include "campaign/cli/film_floor.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::size_t kMostCurves = 6;
constexpr Duration kStep = std::chrono::milliseconds(40), kFineStep = std::chrono::milliseconds(4);
constexpr Duration kBefore = std::chrono::seconds(12), kAfter = std::chrono::seconds(2),
                   kFine = std::chrono::milliseconds(400);

std::set<SimTime> instants_of(const Violation& v, SimTime end) {
  std::set<SimTime> instants{v.first, v.closest_at, std::min(v.last, v.closest_at + kAfter)};
  const SimTime from = std::max(kStart, v.first - kBefore);
  const SimTime to = std::min(end, std::max(v.closest_at, std::min(v.last, v.first + kAfter)) + kAfter);
  for (SimTime t = from; t <= to; t += kStep) instants.insert(t);
  for (SimTime t = std::max(from, v.closest_at - kFine); t <= std::min(to, v.closest_at + kFine); t += kFineStep)
    instants.insert(t);
  return instants;
}

web::ClearanceCurve curve_of(const PiecesOfBodies& bodies, const Violation& v, SimTime end) {
  web::ClearanceCurve curve{v.a.index(), v.b.index(), {}};
  for (const SimTime t : instants_of(v, end)) {
    const Piece *a = piece_at(bodies, v.a, t), *b = piece_at(bodies, v.b, t);
    if (a == nullptr || b == nullptr) continue;
    const double apart_m = std::max(0.0, clearance_m(a->body_at(t), b->body_at(t)));
    curve.points.push_back({film_us(t), t == v.closest_at ? v.min_clearance_um : film_um(apart_m)});
  }
  return curve;
}

}  // namespace

PiecesOfBodies pieces_of_bodies(std::span<const Piece> pieces) {
  PiecesOfBodies bodies;
  for (const Piece& piece : pieces) bodies[piece.entity].push_back(&piece);
  return bodies;
}

const Piece* piece_at(const PiecesOfBodies& bodies, EntityId body, SimTime t) {
  const auto found = bodies.find(body);
  if (found == bodies.end()) return nullptr;
  const auto after = std::ranges::upper_bound(found->second, t, {}, &Piece::begin);
  if (after == found->second.begin()) return nullptr;
  const Piece* piece = *std::prev(after);
  return piece->end >= t ? piece : nullptr;
}

void add_clearances(web::Film& film, const PiecesOfBodies& bodies, const Outcome& outcome) {
  const SimTime end = at_ns(static_cast<std::int64_t>(outcome.simulated_ns));
  std::set<std::pair<EntityId, EntityId>> known;
  for (const Violation& v : outcome.violations) {
    if (film.clearances.size() == kMostCurves) return;
    if (!known.emplace(v.a, v.b).second) continue;
    auto curve = curve_of(bodies, v, end);
    if (curve.points.size() > 1) film.clearances.push_back(std::move(curve));
  }
}

}  // namespace fleetproof::cli
