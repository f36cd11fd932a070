#include "core/motion/motion_profile.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"

namespace fleetproof {

MotionProfile::MotionProfile(double distance, const MotionLimits& limits, const EndSpeeds& ends)
    : distance_(distance), up_(limits.acceleration_mps2), down_(limits.deceleration_mps2), ends_(ends) {
  ensure(distance >= 0.0 && distance < 1e9, "a way is not negative, and finite");
  ensure(limits.speed_mps > 0.0 && up_ > 0.0 && down_ > 0.0, "motion limits are positive");
  const double entry2 = ends.entry_mps * ends.entry_mps, exit2 = ends.exit_mps * ends.exit_mps,
               limit = limits.speed_mps;
  // Longest way on which the speed limit is not reached or only touched.
  const double ramps = limit * limit * (0.5 / up_ + 0.5 / down_) - entry2 * (0.5 / up_) - exit2 * (0.5 / down_);
  const bool level = distance > ramps;
  peak_ = level ? limit : std::sqrt((2.0 * distance * up_ * down_ + down_ * entry2 + up_ * exit2) / (up_ + down_));
  const double faster_end = std::max(ends.entry_mps, ends.exit_mps);
  ensure(peak_ > faster_end - kReachable_mps, "the speeds at the ends of a way can be reached within it");
  peak_ = std::max(peak_, faster_end);
  phase_ends_s_[0] = (peak_ - ends.entry_mps) / up_;
  phase_ends_s_[1] = phase_ends_s_[0] + (level ? (distance - ramps) / limit : 0.0);
  phase_ends_s_[2] = phase_ends_s_[1] + (peak_ - ends.exit_mps) / down_;
  for (std::size_t i = 0; i < 3; ++i) phase_ends_[i] = seconds(phase_ends_s_[i]);
}

double MotionProfile::position(double t_s) const {
  const auto& ends = phase_ends_s_;
  if (t_s <= 0.0) return 0.0;
  if (t_s >= ends[2] || t_s >= to_seconds(duration())) return distance_;
  if (t_s < ends[0]) return ends_.entry_mps * t_s + 0.5 * up_ * t_s * t_s;
  if (t_s < ends[1]) return peak_ * (t_s - 0.5 * ends[0] * (1.0 - ends_.entry_mps / peak_));
  const double left_s = ends[2] - t_s;
  return distance_ - ends_.exit_mps * left_s - 0.5 * down_ * left_s * left_s;
}

double MotionProfile::speed(double t_s) const {
  const auto& ends = phase_ends_s_;
  if (t_s <= 0.0) return ends_.entry_mps;
  if (t_s >= ends[2]) return ends_.exit_mps;
  return speed_in_phase(t_s < ends[0] ? 0 : t_s < ends[1] ? 1 : 2, t_s);
}

double MotionProfile::speed_in_phase(std::size_t phase, double t_s) const {
  if (phase == 0) return ends_.entry_mps + up_ * t_s;
  return phase == 1 ? peak_ : ends_.exit_mps + down_ * (phase_ends_s_[2] - t_s);
}

double MotionProfile::time_at(double distance) const {
  const auto& ends = phase_ends_s_;
  if (distance <= 0.0) return 0.0;
  if (distance >= distance_) return ends[2];
  const double entry = ends_.entry_mps, exit = ends_.exit_mps;
  const double ramp_up = 0.5 * (entry + peak_) * ends[0], ramp_down = 0.5 * (exit + peak_) * (ends[2] - ends[1]);
  if (distance < ramp_up)
    return entry == 0.0 ? std::sqrt(2.0 * distance / up_)
                        : (std::sqrt(entry * entry + 2.0 * up_ * distance) - entry) / up_;
  if (distance <= distance_ - ramp_down) return 0.5 * ends[0] * (1.0 - entry / peak_) + distance / peak_;
  const double left = distance_ - distance;
  return ends[2] -
         (exit == 0.0 ? std::sqrt(2.0 * left / down_) : (std::sqrt(exit * exit + 2.0 * down_ * left) - exit) / down_);
}

}  // namespace fleetproof
