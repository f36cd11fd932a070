#pragma once

#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"
#include "core/motion/speed_plan.hpp"

namespace fleetproof {

// How a leg of a drive has ended.
struct LegEnd {
  enum class Kind : std::uint8_t { NextLegBegins, Arrived, Halted } kind = Kind::Arrived;
  double way_m = 0.0;      // Halted: along the lane
  double speed_mps = 0.0;  // Arrived: with which the AGV passes the station
};

// Drives along one lane: a sequence of legs of one speed limit each. An AGV with a halt brakes; one whose next lane is
// known and goes straight on rolls through the station.
class Drives {
 public:
  struct Ports {
    ActivitiesPort activities;
    Scanner& scanner;
  };
  Drives(RunContext& run, const Ports& ports);

  // `from_m`: along the lane. `next`: the lane that follows if the next action has been released, else null.
  // Requires: the AGV stands or passes at that place of the lane, with the lane's heading.
  void begin(AgvId agv, const Lane& lane, double from_m, double entry_mps, const Lane* next);
  // Something has changed that decides how fast the AGV drives: it goes on from where it is, as fast as it is.
  // Requires: a drive is under way. So for the two functions below.
  void replan(AgvId agv);
  // The next lane has become known. The drive is planned anew if the AGV need not brake for the station any more.
  void release_next(AgvId agv, const Lane& next);
  // At the planned end of the drive's activity. If a next leg follows, it has begun when this returns; else the drive's
  // activity is still under way, for the caller to end.
  LegEnd leg_ends(AgvId agv);
  // How many drives the AGV has begun in this run.
  std::uint32_t begun(AgvId agv) const { return drives_[agv.index()].begun; }

 private:
  struct Drive {
    const Lane* lane = nullptr;
    const Lane* next = nullptr;
    std::vector<Leg> legs;
    std::size_t leg = 0;  // the one under way
    MotionLimits limits;  // in its direction, with the load, and with the deviation drawn for this drive
    std::uint32_t begun = 0;
  };
  Drive& drive_of(AgvId agv) { return drives_[agv.index()]; }
  MotionLimits draw_limits(AgvId agv, bool backward, std::uint32_t number) const;
  void plan(AgvId agv, double from_m, double speed_mps);
  double exit_speed_mps(AgvId agv) const;
  Piece piece_of_leg(AgvId agv) const;
  const Piece& current_piece(AgvId agv) const;

  RunContext& run_;
  Ports ports_;
  std::vector<Drive> drives_;  // by AGV: the drive under way, or the last one
};

}  // namespace fleetproof
