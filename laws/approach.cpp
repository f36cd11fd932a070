#include "laws/approach.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/scenario/ways.hpp"

namespace fleetproof {

Approach::Approach(const Scenario& scenario)
    : map_(*scenario.map), last_(scenario.agvs.size()), drives_(scenario.agvs.size()), answers_(scenario.agvs.size()) {
  here_.reserve(last_.size()), passed_.reserve(4 * last_.size());
  for (const AgvSetup& agv : scenario.agvs) here_.push_back(agv.start);
  begin_anew();
}

void Approach::drive_begins(EntityId agv, SegmentId segment) {
  if (segment.index() >= map_.segment_count()) return;
  const Drive before = std::exchange(drives_[agv.index()], {segment, false});
  if (before.cut_short && before.segment == segment) return;
  const Segment& driven = map_.segment(segment);
  StationId& here = here_[agv.index()];
  if (here != driven.from && here != driven.to) return;
  here = here == driven.from ? driven.to : driven.from;
  std::uint32_t& last = last_[agv.index()];
  passed_.push_back({here, last});
  last = static_cast<std::uint32_t>(passed_.size() - 1);
}

void Approach::set_down(EntityId agv, StationId at) {
  here_[agv.index()] = was_[agv.index()] = at;
  last_[agv.index()] = kNone;
  drives_[agv.index()] = {};
  answers_[agv.index()] = {};
}

void Approach::begin_anew() {
  was_ = here_;
  passed_.clear();
  std::ranges::fill(last_, kNone);
  std::ranges::fill(answers_, Answer{});
}

double Approach::gained_m(EntityId agv, StationId goal) {
  const std::vector<double>& lengths_m = lengths_to_m(goal);
  const double before_m = lengths_m[was_[agv.index()].index()];
  Answer& answer = answers_[agv.index()];
  if (answer.goal != goal) answer = {goal, before_m};
  for (std::uint32_t at = last_[agv.index()]; at != answer.until; at = passed_[at].before)
    answer.nearest_m = std::min(answer.nearest_m, lengths_m[passed_[at].station.index()]);
  answer.until = last_[agv.index()];
  return before_m < std::numeric_limits<double>::infinity() ? before_m - answer.nearest_m : 0.0;
}

const std::vector<double>& Approach::lengths_to_m(StationId goal) {
  std::vector<double>& lengths_m = lengths_m_[goal];
  if (lengths_m.empty()) lengths_m = lengths_to(map_, goal);
  return lengths_m;
}

}  // namespace fleetproof
