#include "core/engine/position_sensor.hpp"

#include <algorithm>

#include "core/base/random.hpp"

namespace fleetproof {

PositionSensor::PositionSensor(RunContext& run) : run_(run), past_(run.agvs.size()) {
  late_.reserve(run.agvs.size());
  for (const AgvSetup& agv : run.scenario.agvs) late_.push_back(seconds(agv.sensing.position_late_s));
}

void PositionSensor::piece_ends(AgvId agv) {
  const Duration late = late_[agv.index()];
  if (late == Duration::zero()) return;
  auto& past = past_[agv.index()];
  past.push_back(run_.world.body(agv).piece);
  past.back().end = run_.now;
  while (past.front().end < run_.now - late) past.pop_front();
}

Pose PositionSensor::perceived(AgvId agv) const {
  constexpr std::int64_t kErrorLasts_ns = 100'000'000;
  const SimTime seen = std::max(kStart, run_.now - late_[agv.index()]);
  const auto& past = past_[agv.index()];
  const auto piece = std::ranges::find_if(past, [&](const Piece& p) { return seen < p.end; });
  Pose pose = piece != past.end() ? piece->pose_at(seen) : run_.world.pose_of(agv, seen);
  const double error_m = run_.setup(agv).sensing.position_error_m;
  if (error_m == 0.0) return pose;
  const auto slot = static_cast<std::uint64_t>(to_ns(run_.now) / kErrorLasts_ns);
  const Block block =
      philox(run_.motion_key, {static_cast<std::uint32_t>(slot), static_cast<std::uint32_t>(slot >> 32),
                               static_cast<std::uint32_t>(MotionTopic::Position), run_.draw_numbers.of(agv).value});
  const auto error = [&](std::size_t half) { return error_m * (2.0 * unit_interval(word64(block, half)) - 1.0); };
  pose.position_m += Vec2{error(0), error(1)};
  return pose;
}

}  // namespace fleetproof
