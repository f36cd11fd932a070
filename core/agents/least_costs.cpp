#include "core/agents/least_costs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/agents/near_queue.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kWidthsInALane = 4.0;
constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::uint32_t kMostBuckets = 4096;
constexpr std::size_t kBucketsPerStation = 2;

}  // namespace

LeastCosts::LeastCosts(const MapView& map, std::span<const double> lane_costs, bool back)
    : step_of_lane_(map.lane_count()) {
  double sum = 0.0;
  own_steps_.reserve(map.lane_count()), own_first_.reserve(map.station_count() + 1);
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    own_first_.push_back(static_cast<std::uint32_t>(own_steps_.size()));
    for (const std::uint32_t lane : back ? map.lanes_to(station) : map.lanes_from(station)) {
      if (std::isinf(lane_costs[lane])) continue;
      step_of_lane_[lane] = static_cast<std::uint32_t>(own_steps_.size());
      own_steps_.push_back({lane_costs[lane], back ? map.lane(lane).from : map.lane(lane).to, 0});
      sum += lane_costs[lane];
    }
  }
  own_first_.push_back(static_cast<std::uint32_t>(own_steps_.size()));
  if (sum > 0.0) width_ = sum / (kWidthsInALane * static_cast<double>(own_steps_.size()));
  steps_ = own_steps_;
  first_ = own_first_;
  mark_dead_ends();
  write_runs();
}

LeastCosts::LeastCosts(std::span<const std::byte> bytes) {
  TableReader tables(bytes);
  steps_ = tables.next<Step>();
  first_ = tables.next<std::uint32_t>();
  runs_ = tables.next<Run>();
  run_steps_ = tables.next<std::uint32_t>();
  width_ = tables.next<double>().front();
}

std::vector<std::byte> LeastCosts::bytes() const {
  TableWriter tables;
  tables.add(own_steps_, own_first_, own_runs_, own_run_steps_, std::vector{width_});
  return tables.bytes();
}

void LeastCosts::mark_dead_ends() {
  for (std::uint32_t station = 0; station + 1 < first_.size(); ++station) {
    for (std::uint32_t i = first_[station]; i < first_[station + 1]; ++i) {
      Step& step = own_steps_[i];
      step.is_dead_end = 1;
      for (std::uint32_t on = first_[step.to]; on < first_[step.to + 1]; ++on) {
        if (steps_[on].to != station) step.is_dead_end = 0;
      }
    }
  }
}

void LeastCosts::write_runs() {
  std::vector<bool> any_branch(first_.size() - 1, false);
  for (std::uint32_t station = 0; station + 1 < first_.size(); ++station) {
    for (std::uint32_t i = first_[station]; i < first_[station + 1]; ++i) {
      const std::uint32_t to = steps_[i].to;
      if (!any_branch[to] && steps_[i].is_dead_end == 0) any_branch[to] = branches(station, to);
    }
  }
  own_runs_.resize(steps_.size());
  own_run_steps_.reserve(2 * steps_.size());
  for (std::uint32_t station = 0; station + 1 < first_.size(); ++station) {
    if (!any_branch[station]) continue;
    for (std::uint32_t i = first_[station]; i < first_[station + 1]; ++i)
      own_runs_[i] = follow(station, i, own_run_steps_);
  }
  runs_ = own_runs_;
  run_steps_ = own_run_steps_;
}

// Whether several ways lead on from a station, dead ends aside.
bool LeastCosts::branches(std::uint32_t before, std::uint32_t station) const {
  std::uint32_t ways = 0;
  for (std::uint32_t i = first_[station]; i < first_[station + 1]; ++i)
    ways += steps_[i].to != before && steps_[i].is_dead_end == 0 ? 1 : 0;
  return ways > 1;
}

LeastCosts::Run LeastCosts::follow(std::uint32_t from, std::uint32_t step, std::vector<std::uint32_t>& steps) const {
  Run run{static_cast<std::uint32_t>(steps.size())};
  std::uint32_t before = from, dead_end = steps_[step].is_dead_end;
  while (true) {
    steps.push_back(step);
    const std::uint32_t here = steps_[step].to;
    run.branches = dead_end == 0 && branches(before, here) ? 1 : 0;
    // A ring without an end costs more at every round.
    const bool is_ring = here == from || steps.size() - run.first > first_.size();
    if (dead_end != 0 || run.branches != 0 || is_ring) break;
    std::uint32_t onward = kNone;
    for (std::uint32_t i = first_[here]; i < first_[here + 1]; ++i) {
      if (steps_[i].to == before) continue;
      if (steps_[i].is_dead_end != 0) {
        steps.push_back(i);
      } else {
        onward = i;
      }
    }
    if (onward == kNone) break;
    before = here;
    step = onward;
  }
  run.end = static_cast<std::uint32_t>(steps.size());
  return run;
}

// Any order of looking at stations ends with the same costs.
std::vector<double> LeastCosts::from(std::uint32_t station) const {
  std::vector<double> least(first_.size() - 1, INFINITY);
  std::vector<std::uint8_t> is_open(least.size(), 0);
  NearQueue open(std::min(kMostBuckets, static_cast<std::uint32_t>(kBucketsPerStation * least.size())));
  const auto drive = [&](std::uint32_t from, std::span<const std::uint32_t> steps, bool branches) {
    double cost = least[from];
    std::uint32_t here = from;
    for (const std::uint32_t step : steps) {
      const auto& [more, to, is_dead_end] = steps_[step];
      if (is_dead_end != 0) {
        least[to] = std::min(least[to], cost + more);
        continue;
      }
      if (cost + more >= least[to]) return;
      least[to] = cost = cost + more;
      here = to;
    }
    if (!branches) return;
    is_open[here] = 1;
    open.push(cost, here);
  };
  open.begin(0.0, width_);
  open.push(0.0, station);
  least[station] = 0.0;
  is_open[station] = 1;
  std::vector<std::uint32_t> unwritten;
  while (open.find_next()) {
    const std::uint32_t here = open.pop();
    if (std::exchange(is_open[here], std::uint8_t{0}) == 0) continue;
    for (std::uint32_t i = first_[here]; i < first_[here + 1]; ++i) {
      if (runs_[i].is_written()) {
        drive(here, run_steps_.subspan(runs_[i].first, runs_[i].end - runs_[i].first), runs_[i].branches != 0);
      } else {  // where the search begins
        unwritten.clear();
        const Run run = follow(here, i, unwritten);
        drive(here, unwritten, run.branches != 0);
      }
    }
  }
  return least;
}

}  // namespace fleetproof::agents
