#include "campaign/watch/film_nearest.hpp"

#include <algorithm>

#include "core/clearance/clearance_over_time.hpp"

namespace fleetproof {
namespace {

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

}  // namespace

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

}  // namespace fleetproof
