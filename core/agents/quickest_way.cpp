#include "core/agents/quickest_way.hpp"

#include <algorithm>
#include <cmath>

#include "core/agents/lane_costs.hpp"

namespace fleetproof::agents {
namespace {

// Sums of the same times in another order differ by less.
constexpr double kRounding = 1e-9;
// Small maps are searched sooner than their landmarks.
constexpr std::uint32_t kFewestStations = 1000, kLandmarks = 8;

constexpr auto is_later = [](const auto& a, const auto& b) {
  return a.bound_s != b.bound_s ? a.bound_s > b.bound_s : a.station > b.station;
};

// Each landmark is the station that is farthest from all landmarks before it, of those that they reach.
void derive_landmarks(const fp_facts* from, std::uint64_t agv, fp_answer* to) {
  const MapView map(*from);
  const auto lane_s = lane_times_s(*from, static_cast<std::uint32_t>(agv));
  std::vector<double> table(std::size_t{2} * kLandmarks * map.station_count());
  std::vector<double> apart_s(map.station_count(), INFINITY);
  std::uint32_t landmark = 0;
  for (std::uint32_t i = 0; i < kLandmarks; ++i) {
    const auto there_s = least_costs_s(map, lane_s, landmark, false),
               back_s = least_costs_s(map, lane_s, landmark, true);
    for (std::uint32_t station = 0; station < map.station_count(); ++station) {
      double* row = table.data() + std::size_t{2} * (std::size_t{kLandmarks} * station + i);
      row[0] = there_s[station], row[1] = back_s[station];
      if (there_s[station] < INFINITY) apart_s[station] = std::min(apart_s[station], there_s[station]);
      if (apart_s[station] == INFINITY) apart_s[station] = 0.0;
    }
    landmark = static_cast<std::uint32_t>(std::ranges::max_element(apart_s) - apart_s.begin());
  }
  answer(*from, to, table);
}

}  // namespace

QuickestWay::QuickestWay(const fp_facts& facts, const MapView& map, const Routes& routes, std::uint32_t agv)
    : map_(map),
      routes_(routes),
      times_s_(lane_times_s(facts, agv)),
      landmark_count_(map.station_count() < kFewestStations ? 0 : kLandmarks),
      known_(map.station_count()) {
  if (landmark_count_ > 0) landmarks_s_ = ask<double>(facts, derive_landmarks, model_of(facts, agv));
}

void QuickestWay::Known::clear() {
  for (const Station& station : stations_) places_[station.number] = 0;
  stations_.clear();
}

void QuickestWay::Known::forget_costs() {
  for (Station& station : stations_) station.cost_s = INFINITY;
}

void QuickestWay::push(Open open) {
  open_.push_back(open);
  std::ranges::push_heap(open_, is_later);
}

QuickestWay::Open QuickestWay::pop() {
  std::ranges::pop_heap(open_, is_later);
  const Open least = open_.back();
  open_.pop_back();
  return least;
}

// A way that begins at a landmark, or ends there, is not shorter for a detour.
double QuickestWay::least_s(std::uint32_t from, std::uint32_t station) const {
  double least_s = 0.0;
  const double* here = landmarks_s_.data() + std::size_t{2} * landmark_count_ * from;
  const double* there = landmarks_s_.data() + std::size_t{2} * landmark_count_ * station;
  for (std::uint32_t i = 0; i < 2 * landmark_count_; i += 2) {
    least_s = std::max(least_s, there[i] - here[i]);
    least_s = std::max(least_s, here[i + 1] - there[i + 1]);
  }
  return least_s * (1.0 - kRounding);
}

void QuickestWay::search_back(std::uint32_t from, std::uint32_t to) {
  known_.clear();
  open_.clear();
  known_.at(to).remains_s = 0.0;
  push({0.0, 0.0, to});
  double until_s = INFINITY;
  while (!open_.empty()) {
    const auto [bound_s, so_far_s, here] = pop();
    if (bound_s > until_s) break;
    if (so_far_s > remains_s(here)) continue;
    if (here == from) {
      until_s = so_far_s * (1.0 + 10.0 * kRounding);  // and a little farther: everything that may be as quick
      continue;
    }
    for (const std::uint32_t lane : map_.lanes_to(here)) {
      const std::uint32_t before = map_.lane(lane).from;
      const double sum_s = so_far_s + times_s_[lane];
      Station& station = known_.at(before);
      if (sum_s >= station.remains_s) continue;
      const double with_start_s = sum_s + least_s(from, before);
      if (with_start_s > until_s) continue;
      station.remains_s = sum_s;
      push({with_start_s, sum_s, before});
    }
  }
}

bool QuickestWay::is_quick(double lane_s, std::uint32_t to, double remains_s) const {
  return lane_s + this->remains_s(to) <= remains_s * (1.0 + kRounding);
}

std::uint32_t QuickestWay::next_lane(std::uint32_t from, std::uint32_t to) {
  if (goal_ != to || at_ != from) search_back(from, to);
  goal_ = to;
  at_ = from;
  const double all_s = remains_s(from);
  if (all_s == INFINITY) return FP_NONE;
  std::uint32_t next = FP_NONE, quick = 0;
  for (const auto& [lane, end] : routes_.hops_from(from)) {
    if (!is_quick(times_s_[lane], end, all_s)) continue;
    next = lane;
    ++quick;
  }
  if (quick > 1) next = search_forward(from, to);
  at_ = map_.lane(next).to;
  return next;
}

// The search of Routes::search, but only over stations that lie on a quickest way. All others make no difference to
// the way: whatever it holds for a station on a quickest way, a lane from another station does not give so little.
std::uint32_t QuickestWay::search_forward(std::uint32_t from, std::uint32_t to) {
  known_.forget_costs();
  open_.clear();
  const double all_s = remains_s(from);
  known_.at(from).cost_s = 0.0;
  push({0.0, 0.0, from});
  while (!open_.empty()) {
    const auto [bound_s, so_far_s, here] = pop();
    if (here == to) break;
    if (so_far_s > known_.at(here).cost_s) continue;
    for (const auto& [lane, end] : routes_.hops_from(here)) {
      const double sum_s = so_far_s + times_s_[lane];
      if (!is_quick(sum_s, end, all_s)) continue;
      Station& station = known_.at(end);
      if (sum_s >= station.cost_s) continue;
      station.cost_s = sum_s;
      station.arrival = lane;
      push({sum_s, sum_s, end});
    }
  }
  std::uint32_t first = known_.at(to).arrival;
  while (map_.lane(first).from != from) first = known_.at(map_.lane(first).from).arrival;
  return first;
}

}  // namespace fleetproof::agents
