#include "core/motion_profile.hpp"

#include <cmath>

#include "core/error.hpp"

namespace fleetproof {

MotionProfile::MotionProfile(double distance, const MotionLimits& limits)
    : distance_(distance), up_(limits.acceleration_mps2), down_(limits.deceleration_mps2) {
  ensure(distance >= 0.0 && distance < 1e9, "a way is not negative, and finite");
  ensure(limits.speed_mps > 0.0 && up_ > 0.0 && down_ > 0.0, "motion limits are positive");
  // Longest way on which the speed limit is not reached or only touched.
  const double ramps = limits.speed_mps * limits.speed_mps * (0.5 / up_ + 0.5 / down_);
  const bool level = distance > ramps;
  peak_ = level ? limits.speed_mps : std::sqrt(2.0 * distance * up_ * down_ / (up_ + down_));
  phase_ends_s_[0] = peak_ / up_;
  phase_ends_s_[1] = phase_ends_s_[0] + (level ? (distance - ramps) / limits.speed_mps : 0.0);
  phase_ends_s_[2] = phase_ends_s_[1] + peak_ / down_;
  duration_ = seconds(phase_ends_s_[2]);
}

double MotionProfile::position(double t_s) const {
  const auto& ends = phase_ends_s_;
  if (t_s <= 0.0) return 0.0;
  if (t_s >= ends[2] || t_s >= to_seconds(duration_)) return distance_;
  if (t_s < ends[0]) return 0.5 * up_ * t_s * t_s;
  if (t_s < ends[1]) return peak_ * (t_s - 0.5 * ends[0]);
  const double left_s = ends[2] - t_s;
  return distance_ - 0.5 * down_ * left_s * left_s;
}

double MotionProfile::speed(double t_s) const {
  const auto& ends = phase_ends_s_;
  if (t_s <= 0.0 || t_s >= ends[2]) return 0.0;
  if (t_s < ends[0]) return up_ * t_s;
  return t_s < ends[1] ? peak_ : down_ * (ends[2] - t_s);
}

double MotionProfile::acceleration(double t_s) const {
  const auto& ends = phase_ends_s_;
  if (t_s < 0.0 || t_s >= ends[2]) return 0.0;
  if (t_s < ends[0]) return up_;
  return t_s < ends[1] ? 0.0 : -down_;
}

double MotionProfile::time_at(double distance) const {
  const auto& ends = phase_ends_s_;
  if (distance <= 0.0) return 0.0;
  if (distance >= distance_) return ends[2];
  const double ramp_up = 0.5 * peak_ * ends[0], ramp_down = 0.5 * peak_ * (ends[2] - ends[1]);
  if (distance < ramp_up) return std::sqrt(2.0 * distance / up_);
  if (distance <= distance_ - ramp_down) return 0.5 * ends[0] + distance / peak_;
  return ends[2] - std::sqrt(2.0 * (distance_ - distance) / down_);
}

}  // namespace fleetproof
