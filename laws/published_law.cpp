#include "laws/published_law.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "laws/second_opinion.hpp"

namespace fleetproof {
namespace {

double half_diagonal_m(const OrientedRectangle& rectangle) {
  return Vec2(rectangle.half_length_m, rectangle.half_width_m).norm();
}

bool overlap(const OrientedRectangle& first, const OrientedRectangle& second) {
  const double reach_m = half_diagonal_m(first) + half_diagonal_m(second);
  if ((first.centre_m - second.centre_m).squaredNorm() > reach_m * reach_m) return false;  // most pairs of a warehouse
  return overlap_by_fcl(first, second);
}

}  // namespace

PublishedLaw::PublishedLaw(const Scenario& scenario)
    : threshold_m_(violation_threshold_m(scenario.law)),
      step_(seconds(scenario.law.snapshot_s)),
      timelines_(scenario.entity_count()) {
  ensure(step_ > Duration::zero(), "snapshots are at least a nanosecond apart");
}

void PublishedLaw::piece_ended(const Piece& piece) {
  ensure(piece.entity.index() < timelines_.size(), "a law hears only of the bodies of its scenario");
  timelines_[piece.entity.index()].push_back(piece);
}

void PublishedLaw::finish(SimTime) {
  for (const auto& pieces : timelines_) {
    for (const Piece& piece : pieces) {
      if (piece.manner != Manner::Drive) continue;
      const std::uint64_t before = perimeter_checks_;
      inspect(piece);
      drives_.push_back({piece.entity, piece.begin, piece.end, perimeter_checks_ - before});
    }
  }
  episodes_ = joined(std::move(episodes_), step_);
}

LawResults PublishedLaw::findings() const {
  LawResults findings;
  findings.violations = filed(episodes_);
  findings.perimeter_checks = perimeter_checks_;
  findings.distance_evaluations = distance_evaluations_;
  findings.drives = drives_;
  return findings;
}

const Piece* PublishedLaw::piece_at(EntityId entity, SimTime t) const {
  const auto pieces = timeline(entity);
  const auto later = std::ranges::upper_bound(pieces, t, {}, &Piece::begin);
  return later == pieces.begin() || (later - 1)->end < t ? nullptr : &*(later - 1);
}

bool PublishedLaw::is_there_throughout(EntityId entity, SimTime begin, SimTime end) const {
  SimTime covered = begin;
  for (const Piece& piece : timeline(entity)) {
    if (piece.begin <= covered) covered = std::max(covered, piece.end);
  }
  return covered >= end && piece_at(entity, begin) != nullptr;
}

bool PublishedLaw::checked(bool overlap) {
  ++perimeter_checks_;
  return overlap;
}

void PublishedLaw::check_snapshot(const Piece& drive, const Piece& other, SimTime t) {
  const OrientedRectangle mine = drive.body_at(t), theirs = other.body_at(t);
  if (!checked(overlap(widened(mine, threshold_m_), theirs))) return;
  ++distance_evaluations_;
  accuse(episode_of(drive, other, t, t, {clearance_m(mine, theirs), t}));
}

void PublishedLaw::accuse_throughout(const Piece& drive, EntityId entity) {
  const auto seen_at = [&](SimTime t) {
    ++distance_evaluations_;
    const Piece* other = piece_at(entity, t);
    ensure(other != nullptr, "a body that stood there when the drive began stands there throughout");
    return episode_of(drive, *other, t, t, {clearance_m(drive.body_at(t), other->body_at(t)), t});
  };
  Episode whole = seen_at(drive.end);
  for (SimTime t = drive.begin; t < drive.end; t += step_) whole.absorb(seen_at(t));
  accuse(whole);
}

void PublishedLaw::accuse(const Episode& episode) {
  const bool goes_on = !episodes_.empty() && episodes_.back().a == episode.a && episodes_.back().b == episode.b &&
                       episode.first >= episodes_.back().first && episode.first - episodes_.back().last <= step_;
  if (goes_on) {
    episodes_.back().absorb(episode);
  } else {
    episodes_.push_back(episode);
  }
}

namespace {

class GlobalStepLaw final : public PublishedLaw {
 public:
  using PublishedLaw::PublishedLaw;

 private:
  void inspect(const Piece& drive) override {
    for (std::size_t i = 0; i < entity_count(); ++i) {
      const EntityId entity{i};
      if (entity == drive.entity) continue;
      for (SimTime t = drive.begin; t < drive.end; t += step()) {
        if (const Piece* other = piece_at(entity, t)) check_snapshot(drive, *other, t);
      }
    }
  }
};

}  // namespace

std::unique_ptr<Law> make_global_step_law(const Scenario& scenario) {
  return std::make_unique<GlobalStepLaw>(scenario);
}

namespace {

bool in_same_time(const Piece& drive, const Piece& other) { return drive.begin < other.end && other.begin < drive.end; }

OrientedRectangle as_rectangle(const Box& box) {
  const Vec2 half_m = 0.5 * (box.high_m - box.low_m);
  return {0.5 * (box.low_m + box.high_m), Vec2::UnitX(), half_m.x(), half_m.y()};
}

class PaperLaw final : public PublishedLaw {
 public:
  using PublishedLaw::PublishedLaw;

 private:
  Box activity_perimeter(const Piece& drive) const { return drive.swept_box(drive.end).grown(threshold_m()); }
  void inspect(const Piece& drive) override;
  void inspect_stationary(const Piece& drive, EntityId entity);
  void inspect_other_drive(const Piece& drive, const Piece& other);
};

void PaperLaw::inspect(const Piece& drive) {
  for (std::size_t i = 0; i < entity_count(); ++i) {
    const EntityId entity{i};
    if (entity == drive.entity) continue;
    bool stationary = true;
    for (const Piece& other : timeline(entity)) {
      if (other.manner != Manner::Drive || !in_same_time(drive, other)) continue;
      stationary = false;
      inspect_other_drive(drive, other);
    }
    if (stationary) inspect_stationary(drive, entity);
  }
}

void PaperLaw::inspect_stationary(const Piece& drive, EntityId entity) {
  const OrientedRectangle perimeter = as_rectangle(activity_perimeter(drive));
  const Piece* standing = piece_at(entity, drive.begin);
  if (standing == nullptr || !is_there_throughout(entity, drive.begin, drive.end))
    return;  // the paper has no entities that come or go
  const OrientedRectangle body = standing->body_at(drive.begin);
  if (checked(overlap_by_fcl(perimeter, body))) accuse_throughout(drive, entity);
}

void PaperLaw::inspect_other_drive(const Piece& drive, const Piece& other) {
  if (!checked(activity_perimeter(drive).overlaps(activity_perimeter(other)))) return;
  const SimTime begin = std::max(drive.begin, other.begin), end = std::min(drive.end, other.end);
  for (SimTime t = begin; t < end; t += step()) check_snapshot(drive, other, t);
}

}  // namespace

std::unique_ptr<Law> make_paper_law(const Scenario& scenario) { return std::make_unique<PaperLaw>(scenario); }

}  // namespace fleetproof
