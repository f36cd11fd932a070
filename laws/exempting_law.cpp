#include "laws/exempting_law.hpp"

#include <algorithm>

#include "laws/comparison.hpp"
#include "laws/exact_law.hpp"

namespace fleetproof {
namespace {

// on a straight line the two ends are enough, because a disc is convex
constexpr Duration kSample = std::chrono::milliseconds(10);

class ExemptingLaw final : public Law {
 public:
  explicit ExemptingLaw(const Scenario& scenario)
      : exact_(make_exact_law(scenario)),
        timelines_(scenario),
        scenario_(scenario),
        radius_m_(scenario.law.exempt_radius_m) {
    for (const Station& station : scenario.map->layout().stations) {
      if ((station.purposes.bits() & scenario.law.exempt_purposes.bits()) != 0) places_m_.push_back(station.position_m);
    }
  }

  double looks_within_m() const override { return exact_->looks_within_m(); }
  Pieces hears_pieces() const override { return Pieces::Ends; }
  void had_company(const Piece& piece, std::span<const Piece* const> others) override {
    exact_->had_company(piece, others);
  }
  void piece_ended(const Piece& piece) override {
    exact_->piece_ended(piece);
    timelines_.piece_ended(piece);
  }
  void finish(SimTime end) override { exact_->finish(end); }
  LawResults findings() const override {
    LawResults findings = exact_->findings();
    std::erase_if(findings.violations,
                  [&](const Violation& v) { return !v.contact && (is_exempt_pair(v) || is_at_exempt_place(v)); });
    return findings;
  }

 private:
  bool is_exempt_pair(const Violation& v) const {
    const std::string_view a = kind_of(v.a), b = kind_of(v.b);
    return std::ranges::any_of(scenario_.law.exempt_pairs, [&](const ExemptPair& pair) {
      return (pair.one == a && pair.other == b) || (pair.one == b && pair.other == a);
    });
  }

  std::string_view kind_of(EntityId body) const {
    if (body.index() >= scenario_.agvs.size()) return kAnyObstacle;
    return scenario_.type_of(scenario_.agvs[body.index()]).name;
  }

  bool is_at_exempt_place(const Violation& v) const {
    return std::ranges::any_of(
        places_m_, [&](const Vec2& place_m) { return stays_at(place_m, v.a, v) && stays_at(place_m, v.b, v); });
  }

  bool stays_at(const Vec2& place_m, EntityId entity, const Violation& v) const {
    for (const Piece& piece : timelines_.of(entity)) {
      const SimTime from = std::max(piece.begin, v.first), to = std::min(piece.end, v.last);
      if (from > to) continue;
      for (SimTime t = from;; t = std::min(t + kSample, to)) {
        if ((piece.pose_at(t).position_m - place_m).norm() > radius_m_) return false;
        if (t == to || piece.manner == Manner::Rest) break;
      }
    }
    return true;
  }

  std::unique_ptr<Law> exact_;
  TimelineKeeper timelines_;
  const Scenario& scenario_;
  double radius_m_;
  std::vector<Vec2> places_m_;
};

}  // namespace

std::unique_ptr<Law> make_safety_distance_law(const Scenario& scenario) {
  if (scenario.law.exempt_purposes.bits() == 0 && scenario.law.exempt_pairs.empty()) return make_exact_law(scenario);
  return std::make_unique<ExemptingLaw>(scenario);
}

}  // namespace fleetproof
