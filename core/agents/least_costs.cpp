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
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    own_first_.push_back(static_cast<std::uint32_t>(own_steps_.size()));
    for (const std::uint32_t lane : back ? map.lanes_to(station) : map.lanes_from(station)) {
      if (std::isinf(lane_costs[lane])) continue;
      own_steps_.push_back({lane_costs[lane], back ? map.lane(lane).from : map.lane(lane).to});
      sum += lane_costs[lane];
    }
  }
  own_first_.push_back(static_cast<std::uint32_t>(own_steps_.size()));
  if (sum > 0.0) width_ = sum / (kWidthsInALane * static_cast<double>(own_steps_.size()));
  steps_ = own_steps_;
  first_ = own_first_;
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

std::vector<double> LeastCosts::from(std::uint32_t station) const {
  std::vector<double> least(first_.size() - 1, INFINITY), looked_from = least;
  NearQueue open(std::min(kMostBuckets, static_cast<std::uint32_t>(kBucketsPerStation * least.size())));
  open.begin(0.0, width_);
  open.push(0.0, station);
  least[station] = 0.0;
  while (open.find_next()) {
    const std::uint32_t here = open.pop();
    const double so_far = least[here];
    if (so_far >= looked_from[here]) continue;
    looked_from[here] = so_far;
    for (std::uint32_t i = first_[here]; i < first_[here + 1]; ++i) {
      const auto& [cost, to] = steps_[i];
      if (so_far + cost >= least[to]) continue;
      least[to] = so_far + cost;
      open.push(least[to], to);
    }
  }
  return least;
}

}  // namespace fleetproof::agents
