#pragma once

#include <span>
#include <vector>

#include "core/outcome/law.hpp"
#include "laws/stretch.hpp"

namespace fleetproof {

// What the paper's two ways of detecting have in common: both look at the drive activities of a finished run, one after
// the other, and check perimeters at snapshots `scenario.law.snapshot_s` apart. A derived law says what it checks for
// one drive activity.
//
// The perimeter of an entity at an instant is its body with every side moved out by the threshold, an oriented box; it
// is checked against the body of the other by FCL. A pair is accused once, whichever of the two activities it was found
// from: snapshots of a pair that follow each other without a clean one between them are one violation, whose smallest
// clearance is the smallest at those snapshots.
class PublishedLaw : public Law {
 public:
  explicit PublishedLaw(const Scenario& scenario);

  void piece_ended(const Piece& piece) final;
  void finish(SimTime end) final;
  LawFindings findings() const final;

 protected:
  virtual void inspect(const Piece& drive) = 0;

  std::size_t entity_count() const { return timelines_.size(); }
  std::span<const Piece> timeline(EntityId entity) const { return timelines_[entity.index()]; }
  // The piece that covers `t`; at a seam the later one. Null while the entity is not on the floor.
  const Piece* piece_at(EntityId entity, SimTime t) const;
  // Whether its pieces cover the interval: it is not taken off the floor meanwhile.
  bool is_there_throughout(EntityId entity, SimTime begin, SimTime end) const;
  double threshold_m() const { return threshold_m_; }
  Duration step() const { return step_; }

  // Counts one check of whatever perimeters it is given the overlap of.
  bool checked(bool overlap);
  // One check: the perimeter of `drive` against the body of `other`, at `t`. Accuses the pair if they overlap.
  void check_snapshot(const Piece& drive, const Piece& other, SimTime t);
  // Accuses the pair for the whole of `drive`.
  void accuse_throughout(const Piece& drive, EntityId other);

 private:
  void accuse(const Stretch& stretch);

  double threshold_m_;
  Duration step_;
  std::vector<std::vector<Piece>> timelines_;  // of each entity, every piece that it really had
  std::vector<Stretch> stretches_;
  std::uint64_t perimeter_checks_ = 0;
  std::uint64_t distance_evaluations_ = 0;
};

}  // namespace fleetproof
