#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Keeps the timelines of a run for a comparison; finds nothing.
class TimelineKeeper final : public Law {
 public:
  explicit TimelineKeeper(const Scenario& scenario) : timelines_(scenario.body_count()) {}

  void piece_ended(const Piece& piece) override { timelines_[piece.entity.index()].push_back(piece); }
  LawFindings findings() const override { return {}; }
  const std::vector<Piece>& of(EntityId entity) const { return timelines_[entity.index()]; }

 private:
  std::vector<std::vector<Piece>> timelines_;
};

// Why a published rule says something else than the judge (laws/README.md, "The five holes").
enum class DifferenceCause : std::uint8_t {
  RestPhase,  // missed: one of the two rests while the other drives, and drives at another time of that drive: its rest
              // is checked by nobody
  BetweenSnapshots,      // missed: over before the next snapshot
  LastInstant,           // missed: from after the last snapshot to the end of a drive, the arrival
  NoDriveActivity,       // missed: nobody drives, one turns on the spot or both stand
  AxisAlignedPerimeter,  // accused wrongly: in the box of the whole drive, not near what the AGV sweeps
  SquareCorners,  // accused wrongly: nearest corner to corner, where a widened box reaches farther than the safety
                  // distance
  Unexplained,
};
const char* name_of(DifferenceCause cause);

struct Difference {
  bool missed = false;  // by the published rule; else accused by it alone
  DifferenceCause cause = DifferenceCause::Unexplained;
  Violation violation;  // as the judge files it if missed, else as the published rule does
};

// What `published` misses of `judge`'s violations, and accuses beside them, in order of (first, a, b), both sorts
// together. A violation of the one counts as found by the other if that files the same pair at a time that overlaps; an
// accusation also if it lies no more than one snapshot off.
std::vector<Difference> compare(const Scenario& scenario, const LawFindings& published, const LawFindings& judge,
                                const TimelineKeeper& timelines);

}  // namespace fleetproof
