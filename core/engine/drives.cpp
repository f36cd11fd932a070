#include "core/engine/drives.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/tolerances.hpp"
#include "core/engine/scanner.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// Whether an AGV may roll from one lane onto the next: it changes neither its heading nor the end that goes first.
bool goes_on(const Lane& arriving, const Lane& leaving) {
  return arriving.is_backward() == leaving.is_backward() &&
         std::abs(angle_between(arriving.end_heading(), leaving.start_heading())) <= kAligned_rad;
}

}  // namespace

Drives::Drives(RunContext& run, const Ports& ports) : run_(run), ports_(ports), drives_(run.agvs.size()) {}

void Drives::begin(AgvId agv, const Lane& lane, double from_m, double entry_mps, const Lane* next) {
  Drive& drive = drive_of(agv);
  drive.lane = &lane;
  drive.next = next;
  drive.limits = draw_limits(agv, lane.is_backward(), ++drive.begun);
  ++run_.counters.drives;
  run_.progressed(agv);
  plan(agv, from_m, entry_mps);
  ports_.activities.begin_moving(agv, ActivityKind::Drive, piece_of_leg(agv),
                                 traced::ActivityBegins::drive_subject(lane.segment, lane.is_backward()));
  if (run_.scenario.scanner.on) ports_.scanner.drive_begins(agv);
}

MotionLimits Drives::draw_limits(AgvId agv, bool backward, std::uint32_t number) const {
  const VehicleType& type = run_.type_of(agv);
  MotionLimits limits = type.drive_with(run_.is_loaded(agv), backward);
  if (type.speed_deviation > 0.0) {
    const double draw = run_.motion_draw(MotionTopic::Speed, agv, number);
    const double factor = 1.0 + type.speed_deviation * (2.0 * draw - 1.0);
    limits.speed_mps *= factor;
    limits.acceleration_mps2 *= factor;  // not the brakes: a stop that is possible must stay possible
  }
  return limits;
}

void Drives::plan(AgvId agv, double from_m, double speed_mps) {
  Drive& drive = drive_of(agv);
  const Curve& curve = drive.lane->curve;
  const MotionLimits limits = drive.lane->limits(drive.limits);
  from_m = std::min(from_m, curve.length_m());  // the sum of the legs may be rounded up
  drive.leg = 0;
  if (!run_.status(agv).halts.empty()) {
    plan_stop(curve, limits, from_m, speed_mps, drive.legs);
  } else {
    plan_legs(curve, limits, run_.type_of(agv).lateral_mps2, from_m, {speed_mps, exit_speed_mps(agv)}, drive.legs);
  }
}

// The speed at which the AGV may pass the station at the end of its lane. Zero, unless the next action has been
// released and goes straight on.
double Drives::exit_speed_mps(AgvId agv) const {
  const Drive& drive = drives_[agv.index()];
  if (drive.next == nullptr || !goes_on(*drive.lane, *drive.next)) return 0.0;
  const VehicleType& type = run_.type_of(agv);
  MotionLimits limits = drive.limits;
  const bool backward = drive.next->is_backward();  // as this lane
  limits.speed_mps = std::min(limits.speed_mps, type.drive_with(run_.is_loaded(agv), backward).speed_mps);
  const double entry_mps = highest_entry_mps(drive.next->curve, drive.next->limits(limits), type.lateral_mps2);
  return std::min(entry_mps, drive.lane->limits(drive.limits).speed_mps);
}

Piece Drives::piece_of_leg(AgvId agv) const {
  const Drive& drive = drives_[agv.index()];
  const Leg& leg = drive.legs[drive.leg];
  Piece piece = run_.standing_piece(agv, run_.pose_now(agv));
  piece.manner = Manner::Drive;
  piece.segment = drive.lane->segment;
  piece.curve = &drive.lane->curve;
  piece.way_begin_m = leg.begin_m;
  MotionLimits limits = drive.limits;
  limits.speed_mps = leg.limit_mps;
  piece.profile = MotionProfile(leg.end_m - leg.begin_m, limits, leg.speeds);
  piece.end = piece.begin + piece.profile.duration();
  return piece;
}

const Piece& Drives::current_piece(AgvId agv) const {
  return std::get<SpatialEvolution>(run_.status(agv).activity->evolution).piece;
}

void Drives::replan(AgvId agv) {
  const Piece& piece = current_piece(agv);
  plan(agv, piece.way_at(run_.now), piece.speed_at(run_.now));
  ports_.activities.continue_with(agv, piece_of_leg(agv));
}

void Drives::release_next(AgvId agv, const Lane& next) {
  Drive& drive = drive_of(agv);
  drive.next = &next;
  if (!run_.status(agv).halts.empty() || exit_speed_mps(agv) == 0.0) return;
  const Piece& piece = current_piece(agv);
  const bool last_leg = drive.leg + 1 == drive.legs.size();
  const bool braking = last_leg && to_seconds(run_.now - piece.begin) >= piece.profile.phase_ends_s()[1];
  if (!braking) replan(agv);
}

LegEnd Drives::leg_ends(AgvId agv) {
  Drive& drive = drive_of(agv);
  const Leg done = drive.legs[drive.leg];
  if (++drive.leg < drive.legs.size()) {
    ports_.activities.continue_with(agv, piece_of_leg(agv));
    return {.kind = LegEnd::Kind::NextLegBegins};
  }
  const bool arrived = done.end_m >= drive.lane->curve.length_m();
  return {.kind = arrived ? LegEnd::Kind::Arrived : LegEnd::Kind::Halted,
          .way_m = done.end_m,
          .speed_mps = done.speeds.exit_mps};
}

}  // namespace fleetproof
