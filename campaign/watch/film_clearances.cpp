// The clearance of bodies over time, and the two bodies that came closest.
#include "campaign/watch/film_clearances.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "campaign/watch/film_floor.hpp"
#include "core/clearance/clearance_over_time.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostCurves = 6;
constexpr Duration kCoarseStep = std::chrono::milliseconds(40), kFineStep = std::chrono::milliseconds(4);
constexpr Duration kBefore = std::chrono::seconds(12), kAfter = std::chrono::seconds(2),
                   kFine = std::chrono::milliseconds(400);

// When two bodies were close to each other.
struct CloseTimes {
  EntityId a, b;
  SimTime first, closest_at, last;
  std::int64_t clearance_um = 0;  // at closest_at
};

std::set<SimTime> instants_of(const CloseTimes& m, SimTime end) {
  std::set<SimTime> instants{m.first, m.closest_at, std::min(m.last, m.closest_at + kAfter)};
  const SimTime from = std::max(kStart, m.first - kBefore);
  const SimTime to = std::min(end, std::max(m.closest_at, std::min(m.last, m.first + kAfter)) + kAfter);
  for (SimTime t = from; t <= to; t += kCoarseStep) instants.insert(t);
  for (SimTime t = std::max(from, m.closest_at - kFine); t <= std::min(to, m.closest_at + kFine); t += kFineStep)
    instants.insert(t);
  return instants;
}

// Nothing is drawn of bodies that are together on the floor for an instant only.
void add_curve(web::Film& film, const PiecesOfBodies& bodies, const CloseTimes& m, SimTime end) {
  web::ClearanceCurve curve{m.a.index(), m.b.index(), {}};
  for (const SimTime t : instants_of(m, end)) {
    const Piece *a = piece_at(bodies, m.a, t), *b = piece_at(bodies, m.b, t);
    if (a == nullptr || b == nullptr) continue;
    const double apart_m = std::max(0.0, clearance_m(a->body_at(t), b->body_at(t)));
    curve.points.push_back({film_us(t), t == m.closest_at ? m.clearance_um : film_um(apart_m)});
  }
  if (curve.points.size() > 1) film.clearances.push_back(std::move(curve));
}

// ---- the two bodies that came closest

// The smallest clearance of a run, and the two bodies that had it.
struct NearestPair {
  EntityId a, b;
  SimTime at;
  double clearance_m = 0.0;
};

constexpr double kAnywhere_m = 1e6;  // more than any two bodies are apart

// A piece, and the box of all that its body covers.
struct Swept {
  const Piece* piece;
  Box box;
};

double gap_m(const Box& a, const Box& b) {
  const auto apart = [](double low_a, double high_a, double low_b, double high_b) {
    return std::max({0.0, low_b - high_a, low_a - high_b});
  };
  return Vec2(apart(a.low_m.x(), a.high_m.x(), b.low_m.x(), b.high_m.x()),
              apart(a.low_m.y(), a.high_m.y(), b.low_m.y(), b.high_m.y()))
      .norm();
}

class NearestSearch {
 public:
  // Both in order of time, so one walk meets every two pieces that share an instant.
  void look(const std::vector<Swept>& ours, const std::vector<Swept>& theirs) {
    for (auto a = ours.begin(), b = theirs.begin(); a != ours.end() && b != theirs.end();) {
      measure(*a, *b);
      if (a->piece->end < b->piece->end) {
        ++a;
      } else {
        ++b;
      }
    }
  }
  const std::optional<NearestPair>& found() const { return found_; }

 private:
  void measure(const Swept& a, const Swept& b) {
    const Interval common{std::max(a.piece->begin, b.piece->begin), std::min(a.piece->end, b.piece->end)};
    const double below_m = found_ ? found_->clearance_m : kAnywhere_m;
    if (common.begin > common.end || gap_m(a.box, b.box) >= below_m) return;
    const auto closest = closest_approach(*a.piece, *b.piece, common, below_m, count_);
    if (closest) found_ = NearestPair{a.piece->entity, b.piece->entity, closest->at, closest->clearance_m};
  }

  std::optional<NearestPair> found_;
  EvaluationCount count_;
};

// Of an AGV and any other body. Of equal clearances, that of the first pair counts, and its first instant. Nothing: no
// AGV was on the floor together with another body.
std::optional<NearestPair> nearest_pair(const PiecesOfBodies& bodies, std::size_t agv_count) {
  std::vector<std::vector<Swept>> swept;
  for (const auto& [entity, pieces] : bodies) {
    auto& own = swept.emplace_back();
    for (const Piece* piece : pieces) own.push_back({piece, piece->swept_box(piece->end)});
  }
  NearestSearch search;
  std::size_t number = 0;
  for (auto one = bodies.begin(); one != bodies.end() && one->first.index() < agv_count; ++one, ++number) {
    for (std::size_t other = number + 1; other < swept.size(); ++other) search.look(swept[number], swept[other]);
  }
  return search.found();
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
