#include "campaign/watch/film_clearances.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "campaign/watch/film_floor.hpp"
#include "campaign/watch/film_nearest.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostCurves = 6;
constexpr Duration kCoarseStep = std::chrono::milliseconds(40), kFineStep = std::chrono::milliseconds(4);
constexpr Duration kBefore = std::chrono::seconds(12), kAfter = std::chrono::seconds(2),
                   kFine = std::chrono::milliseconds(400);

// Two bodies that came close.
struct Meeting {
  EntityId a, b;
  SimTime first, closest_at, last;
  std::int64_t clearance_um = 0;  // at closest_at
};

std::set<SimTime> instants_of(const Meeting& m, SimTime end) {
  std::set<SimTime> instants{m.first, m.closest_at, std::min(m.last, m.closest_at + kAfter)};
  const SimTime from = std::max(kStart, m.first - kBefore);
  const SimTime to = std::min(end, std::max(m.closest_at, std::min(m.last, m.first + kAfter)) + kAfter);
  for (SimTime t = from; t <= to; t += kCoarseStep) instants.insert(t);
  for (SimTime t = std::max(from, m.closest_at - kFine); t <= std::min(to, m.closest_at + kFine); t += kFineStep)
    instants.insert(t);
  return instants;
}

// Nothing is drawn of bodies that are together on the floor for an instant only.
void add_curve(web::Film& film, const PiecesOfBodies& bodies, const Meeting& m, SimTime end) {
  web::ClearanceCurve curve{m.a.index(), m.b.index(), {}};
  for (const SimTime t : instants_of(m, end)) {
    const Piece *a = piece_at(bodies, m.a, t), *b = piece_at(bodies, m.b, t);
    if (a == nullptr || b == nullptr) continue;
    const double apart_m = std::max(0.0, clearance_m(a->body_at(t), b->body_at(t)));
    curve.points.push_back({film_us(t), t == m.closest_at ? m.clearance_um : film_um(apart_m)});
  }
  if (curve.points.size() > 1) film.clearances.push_back(std::move(curve));
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
    if (known.emplace(v.a, v.b).second)
      add_curve(film, bodies, {v.a, v.b, v.first, v.closest_at, v.last, v.min_clearance_um}, end);
  }
  if (!outcome.violations.empty()) return;
  const auto nearest = nearest_pair(bodies, outcome.agv_count);
  if (!nearest) return;
  // Cut to a micrometre as the judge does, if it measured: but 0.9 m built of binary fractions stays 0.9 m.
  constexpr double kRoundedUp_um = 1e-3;
  const auto clearance_um = outcome.min_clearance_um.value_or(
      static_cast<std::int64_t>(std::floor(std::max(0.0, nearest->clearance_m) * 1e6 + kRoundedUp_um)));
  film.nearest = web::Nearest{nearest->a.index(), nearest->b.index(), film_us(nearest->at), clearance_um};
  add_curve(film, bodies, {nearest->a, nearest->b, nearest->at, nearest->at, nearest->at, clearance_um}, end);
}

}  // namespace fleetproof
