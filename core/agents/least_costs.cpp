#include "core/agents/least_costs.hpp"

#include <algorithm>
#include <cmath>

#include "core/agents/near_queue.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kWidthsInALane = 4.0;
constexpr std::uint32_t kMostBuckets = 4096;
constexpr std::size_t kBucketsPerStation = 8;

}  // namespace

LeastCosts::LeastCosts(const MapView& map, std::span<const double> lane_costs, bool back) {
  double sum = 0.0;
  own_steps_.reserve(map.lane_count()), own_first_.reserve(map.station_count() + 1);
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    own_first_.push_back(static_cast<std::uint32_t>(own_steps_.size()));
    for (const std::uint32_t lane : back ? map.lanes_to(station) : map.lanes_from(station)) {
      if (std::isinf(lane_costs[lane])) continue;
      own_steps_.push_back({lane_costs[lane], back ? map.lane(lane).from : map.lane(lane).to, 0});
      sum += lane_costs[lane];
    }
  }
  own_first_.push_back(static_cast<std::uint32_t>(own_steps_.size()));
  if (sum > 0.0) width_ = sum / (kWidthsInALane * static_cast<double>(own_steps_.size()));
  steps_ = own_steps_;
  first_ = own_first_;
  mark_dead_ends();
}

LeastCosts::LeastCosts(std::span<const std::byte> bytes) {
  TableReader tables(bytes);
  steps_ = tables.next<Step>();
  first_ = tables.next<std::uint32_t>();
  width_ = tables.next<double>().front();
}

std::vector<std::byte> LeastCosts::bytes() const {
  TableWriter tables;
  tables.add(own_steps_), tables.add(own_first_), tables.add(std::vector{width_});
  return tables.bytes();
}

void LeastCosts::mark_dead_ends() {
  for (std::uint32_t station = 0; station + 1 < own_first_.size(); ++station) {
    for (std::uint32_t i = own_first_[station]; i < own_first_[station + 1]; ++i) {
      Step& step = own_steps_[i];
      step.is_dead_end = 1;
      for (std::uint32_t on = own_first_[step.to]; on < own_first_[step.to + 1]; ++on) {
        if (own_steps_[on].to != station) step.is_dead_end = 0;
      }
    }
  }
}

struct LeastCosts::Search {
  const LeastCosts& in;
  std::vector<double>& least;
  NearQueue open;

  // By one step, and on: a station waits in the queue only if more than one way leads on from there. Any order of
  // looking at stations ends with the same costs.
  void go(std::uint32_t before, const Step* step) {
    for (double cost = least[before] + step->cost; cost < least[step->to]; cost = least[before] + step->cost) {
      const std::uint32_t here = step->to;
      least[here] = cost;
      if (step->is_dead_end != 0) return;
      const Step* onward = nullptr;
      for (std::uint32_t i = in.first_[here]; i < in.first_[here + 1]; ++i) {
        const Step& next = in.steps_[i];
        if (next.to == before) continue;
        if (next.is_dead_end != 0) {
          least[next.to] = std::min(least[next.to], cost + next.cost);
        } else if (onward != nullptr) {
          return open.push(cost, here);
        } else {
          onward = &next;
        }
      }
      if (onward == nullptr) return;
      before = here;
      step = onward;
    }
  }
};

std::vector<double> LeastCosts::from(std::uint32_t station) const {
  std::vector<double> least(first_.size() - 1, INFINITY), looked_from = least;
  Search search{*this, least,
                NearQueue(std::min(kMostBuckets, static_cast<std::uint32_t>(kBucketsPerStation * least.size())))};
  search.open.begin(0.0, width_);
  search.open.push(0.0, station);
  least[station] = 0.0;
  while (search.open.find_next()) {
    const std::uint32_t here = search.open.pop();
    if (least[here] >= looked_from[here]) continue;
    looked_from[here] = least[here];
    for (std::uint32_t i = first_[here]; i < first_[here + 1]; ++i) search.go(here, &steps_[i]);
  }
  return least;
}

}  // namespace fleetproof::agents
