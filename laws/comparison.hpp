#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Stores the timelines of a run for a comparison. It finds nothing itself.
class TimelineKeeper final : public Law {
 public:
  explicit TimelineKeeper(const Scenario& scenario) : timelines_(scenario.entity_count()) {}

  void piece_ended(const Piece& piece) override { timelines_[piece.entity.index()].push_back(piece); }
  LawResults findings() const override { return {}; }
  const std::vector<Piece>& of(EntityId entity) const { return timelines_[entity.index()]; }

 private:
  std::vector<std::vector<Piece>> timelines_;
};

// Why a published law and the judge differ (see the five holes in laws/README.md).
enum class DifferenceCause : std::uint8_t {
  RestPhase,  // missed: one body rests during a part of the other's drive and drives during another part; its rest is
              // never checked
  BetweenSnapshots,      // missed: the violation ends before the next snapshot
  LastInstant,           // missed: between the last snapshot and the end of a drive, the arrival
  NoDriveActivity,       // missed: no body drives; one turns on the spot, or both stand
  AxisAlignedPerimeter,  // accused wrongly: inside the box of the whole drive, but not near what the AGV sweeps
  SquareCorners,  // accused wrongly: the bodies are nearest corner to corner, where a widened box reaches farther
                  // than the safety distance
  Unexplained,
};
const char* name_of(DifferenceCause cause);

struct Difference {
  bool missed = false;  // the published law missed it; else only the published law accused it
  DifferenceCause cause = DifferenceCause::Unexplained;
  Violation violation;  // as the judge filed it if it was missed, else as the published law filed it
};

// The violations of `judge` that `published` misses, and the accusations that only `published` makes; together in the
// order of (first, a, b). A violation of one law counts as found by the other law if the other law files the same pair
// at an overlapping time. For an accusation, the times may also be up to one snapshot apart.
std::vector<Difference> compare(const Scenario& scenario, const LawResults& published, const LawResults& judge,
                                const TimelineKeeper& timelines);

}  // namespace fleetproof
