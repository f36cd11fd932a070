#pragma once

#include <map>
#include <set>
#include <vector>

#include "campaign/watch/activity_hull.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A piece that is in progress at an instant, its first and last instant included.
struct MomentPiece {
  Piece piece;
  Hull hull;

  bool moves() const { return piece.manner != Manner::Rest; }
};

// A body on the floor at an instant.
struct MomentBody {
  EntityId entity;
  OrientedRectangle place;
  bool is_loaded = false;
  std::vector<MomentPiece> pieces;  // two if one ends and the next begins at the instant
};

// Two bodies of which one could be in the way of the other.
struct Meeting {
  EntityId a, b;
  bool perimeters_overlap = false;   // both move, and their activity perimeters overlap
  SimTime common_begin, common_end;  // then: while both activities are in progress
  bool stands_in_perimeter = false;  // a moves, b stands in its activity perimeter
  bool is_too_close = false;         // below the safety distance at the instant
  double clearance_m = 0.0;
};

struct Moment {
  SimTime at;
  std::vector<MomentBody> bodies;  // in the order of their ids
  std::vector<Meeting> meetings;   // those that are too close first
};

// Listens to a run and keeps one instant of it.
class MomentKeeper final : public TraceSink {
 public:
  // Requires: the scenario outlives the keeper.
  MomentKeeper(const Scenario& scenario, SimTime at) : scenario_(scenario), at_(at) {}
  void record(const TraceRecord& record, std::string_view text) override;
  void piece_ended(const Piece& piece) override;
  SimTime at() const { return at_; }
  // Call this after the run.
  Moment moment() const;

 private:
  const Scenario& scenario_;
  SimTime at_;
  std::map<EntityId, std::vector<Piece>> pieces_;
  std::map<LoadId, AgvId> carriers_;
};

}  // namespace fleetproof
