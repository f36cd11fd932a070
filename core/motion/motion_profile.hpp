#pragma once

#include <array>
#include <cstddef>

#include "core/base/sim_time.hpp"

namespace fleetproof {

// The limits of a vehicle type's motion. The defaults are the paper's (Sect. 3.3): 2 m/s, 4 s to reach it, 2 s to stop.
struct MotionLimits {
  double speed_mps = 2.0;
  double acceleration_mps2 = 0.5;
  double deceleration_mps2 = 1.0;

  friend bool operator==(const MotionLimits&, const MotionLimits&) = default;
};

// How fast a vehicle type may turn on the spot.
struct TurnLimits {
  double speed_radps = 1.0;
  double acceleration_radps2 = 1.0;
  double deceleration_radps2 = 1.0;

  // The same numbers for a MotionProfile, whose distance is then an angle.
  constexpr MotionLimits as_motion() const { return {speed_radps, acceleration_radps2, deceleration_radps2}; }
  friend bool operator==(const TurnLimits&, const TurnLimits&) = default;
};

// The speeds at the two ends of a way; zero unless the AGV rolls on.
struct EndSpeeds {
  double entry_mps = 0.0, exit_mps = 0.0;
};

// Distance as a function of time. The speed is a trapezoid, or a triangle if the way is too short for the speed limit.
// The distance is piecewise quadratic and exact, without steps. Drives use metres, turns use radians.
class MotionProfile {
 public:
  MotionProfile() = default;
  // Requires: the end speeds are within the speed limit; the distance is long enough to change from one to the other.
  MotionProfile(double distance, const MotionLimits& limits, const EndSpeeds& ends = {});

  double distance() const { return distance_; }
  Duration duration() const { return phase_ends_[2]; }

  double position(double t_s) const;
  double speed(double t_s) const;  // before and after the way: its end speeds
  // The first instant at which `position` reaches `distance`.
  double time_at(double distance) const;
  // The ends of the three phases from the start, in seconds, exact to the nanosecond. A missing phase ends together
  // with the phase before it.
  const std::array<double, 3>& phase_ends_s() const { return phase_ends_s_; }
  const std::array<Duration, 3>& phase_ends() const { return phase_ends_; }
  // The law of one phase (0, 1, 2), also for instants beyond its ends.
  double speed_in_phase(std::size_t phase, double t_s) const;
  double acceleration_in_phase(std::size_t phase) const { return phase == 0 ? up_ : phase == 1 ? 0.0 : -down_; }

 private:
  double distance_ = 0.0, peak_ = 0.0, up_ = 1.0, down_ = 1.0;
  EndSpeeds ends_;
  std::array<double, 3> phase_ends_s_{};
  std::array<Duration, 3> phase_ends_{};
};

}  // namespace fleetproof
