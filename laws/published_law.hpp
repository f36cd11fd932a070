// The laws of the paper: a global step, and a step by activities.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/outcome/law.hpp"
#include "laws/episode.hpp"

namespace fleetproof {

// What the two published laws have in common. Both look at the drive activities of a finished run, one after the other,
// and check perimeters at snapshots that are `scenario.law.snapshot_s` apart. A derived law decides what it checks for
// one drive activity.
//
// The perimeter of an entity at an instant is its body with every side moved out by the threshold: an oriented box. FCL
// checks it against the body of the other entity. A pair is accused once, no matter from which of the two activities it
// was found. Consecutive snapshots of a pair without a clean snapshot between them are one violation. Its smallest
// clearance is the smallest at these snapshots.
class PublishedLaw : public Law {
 public:
  explicit PublishedLaw(const Scenario& scenario);

  void piece_ended(const Piece& piece) final;
  void finish(SimTime end) final;
  LawResults findings() const final;

 protected:
  virtual void inspect(const Piece& drive) = 0;

  std::size_t entity_count() const { return timelines_.size(); }
  std::span<const Piece> timeline(EntityId entity) const { return timelines_[entity.index()]; }
  // The piece that covers `t`; at a seam, the later piece. Null while the entity is not on the floor.
  const Piece* piece_at(EntityId entity, SimTime t) const;
  // Whether the entity is on the floor during the whole interval.
  bool is_there_throughout(EntityId entity, SimTime begin, SimTime end) const;
  double threshold_m() const { return threshold_m_; }
  Duration step() const { return step_; }

  // Counts one perimeter check and returns its result.
  bool checked(bool overlap);
  // One check: the perimeter of `drive` against the body of `other`, at `t`. Accuses the pair if they overlap.
  void check_snapshot(const Piece& drive, const Piece& other, SimTime t);
  // Accuses the pair for the whole of `drive`.
  void accuse_throughout(const Piece& drive, EntityId other);

 private:
  void accuse(const Episode& episode);

  double threshold_m_;
  Duration step_;
  std::vector<std::vector<Piece>> timelines_;  // by entity: its pieces, as they happened, not as planned
  std::vector<Episode> episodes_;
  std::vector<DriveChecks> drives_;
  std::uint64_t perimeter_checks_ = 0;
  std::uint64_t distance_evaluations_ = 0;
};

// The baseline of the paper (Sect. 5.2): at every step of every drive activity, one check with every other entity. It
// needs 38 400 checks on Fig. 4; the paper's law needs 4 020.
std::unique_ptr<Law> make_global_step_law(const Scenario& scenario);

// The collision detection law of Fig. 5 as published, except for the loop index in line 28 (`j` instead of `i`). It
// reproduces the figures of the paper: 4 020 checks on Fig. 4 at 400 snapshots a second. It also shows what the
// published rule misses. Campaigns do not judge by it.
//
// For each drive activity and each other entity:
// - If the other entity has no drive activity during the interval: one check of the activity perimeter against its
//   body.
// - Otherwise, for each drive activity of the other entity in that time: one check of the two activity perimeters. If
//   they overlap: one check for each snapshot of the common interval, without its end. An activity perimeter is the
//   axis-aligned box of everything that the AGV covers, widened by the threshold. A turn on the spot is not a drive
//   activity.
//
// An entity that stands in an activity perimeter is accused for the whole activity, because the rule does not give a
// shorter time. The filed smallest clearance is the smallest at the snapshots and the end of the activity. If it is
// above the safety distance, the accusation is false.
std::unique_ptr<Law> make_paper_law(const Scenario& scenario);

}  // namespace fleetproof
