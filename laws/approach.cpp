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
  const Drive before = std::exchange(drives_[agv.index()], {segment, false, true});
  if (before.cut_short && before.segment == segment) return;
  const Segment& driven = map_.segment(segment);
  StationId& here = here_[agv.index()];
  if (here != driven.from && here != driven.to) return;
  here = here == driven.from ? driven.to : driven.from;
  std::uint32_t& last = last_[agv.index()];
  passed_.push_back({here, last});
  last = static_cast<std::uint32_t>(passed_.size() - 1);
}

void Approach::drive_ends(EntityId agv, bool as_planned) {
  Drive& drive = drives_[agv.index()];
  drive.under_way = false;
  drive.cut_short = !as_planned;
}

void Approach::spend(EntityId agv, Duration time) {
  if (const std::uint32_t last = last_[agv.index()]; last != kNone) passed_[last].took += time;
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
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (!drives_[i].under_way) continue;
    const Segment& driven = map_.segment(drives_[i].segment);
    if (here_[i] != driven.from && here_[i] != driven.to) continue;
    was_[i] = here_[i] == driven.from ? driven.to : driven.from;
    last_[i] = static_cast<std::uint32_t>(passed_.size());
    passed_.push_back({here_[i]});
  }
}

Approach::Gain Approach::gain(EntityId agv, StationId goal) {
  const std::vector<double>& lengths_m = lengths_to_m(goal);
  const double before_m = lengths_m[was_[agv.index()].index()];
  if (before_m == std::numeric_limits<double>::infinity()) return {};
  Answer& known = answers_[agv.index()];
  if (known.goal != goal) known = {goal, before_m};
  fresh_.clear();
  for (std::uint32_t at = last_[agv.index()]; at != known.until; at = passed_[at].before) fresh_.push_back(at);
  Answer now = known;
  for (std::size_t i = fresh_.size(); i-- > 0;) {
    known = now;  // without the last one
    const Passed& passed = passed_[fresh_[i]];
    if (const double length_m = lengths_m[passed.station.index()]; length_m < now.nearest_m)
      now.nearest_m = length_m, now.took += passed.took;
    now.until = fresh_[i];
  }
  return {before_m - now.nearest_m, now.took, now.nearest_m < known.nearest_m};
}

const std::vector<double>& Approach::lengths_to_m(StationId goal) {
  std::vector<double>& lengths_m = lengths_m_[goal];
  if (lengths_m.empty()) lengths_m = lengths_to(map_, goal);
  return lengths_m;
}

}  // namespace fleetproof
