#include "generators/reachability.hpp"

#include <algorithm>
#include <limits>

namespace fleetproof {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

Reachability::Reachability(const LogicalMap& map) : map_(&map), component_(map.station_count(), kNone) {
  find_components();
  std::vector<std::uint32_t> sizes(component_count_, 0);
  for (const auto component : component_) ++sizes[component];
  std::uint32_t largest = 0;
  for (const auto component : component_) {
    if (sizes[component] > largest) {
      largest = sizes[component];
      core_component_ = component;
    }
  }
  core_.reserve(largest);
  for (std::size_t i = 0; i < component_.size(); ++i) {
    if (component_[i] == core_component_) core_.emplace_back(i);
  }
}

// Tarjan 1972, with a stack of its own: imported maps have tens of thousands of stations in a row.
void Reachability::find_components() {
  struct Frame {
    std::uint32_t station;
    std::uint32_t next_lane;
  };
  const auto n = component_.size();
  std::vector<std::uint32_t> number(n, kNone), low(n, 0), path;
  std::vector<Frame> frames;
  std::uint32_t visited = 0;
  for (std::uint32_t root = 0; root < n; ++root) {
    if (number[root] != kNone) continue;
    frames.push_back({root, 0});
    while (!frames.empty()) {
      auto& [station, next_lane] = frames.back();
      if (next_lane == 0) {
        number[station] = low[station] = visited++;
        path.push_back(station);
      }
      const auto& lanes = map_->lanes_from(StationId{station});
      if (next_lane < lanes.size()) {
        const auto to = map_->lanes()[lanes[next_lane++]].to.value;
        if (number[to] == kNone) {
          frames.push_back({to, 0});
        } else if (component_[to] == kNone) {
          low[station] = std::min(low[station], number[to]);
        }
        continue;
      }
      const auto done = station;
      frames.pop_back();
      if (!frames.empty()) low[frames.back().station] = std::min(low[frames.back().station], low[done]);
      if (low[done] != number[done]) continue;
      std::uint32_t member = kNone;
      do {
        member = path.back();
        path.pop_back();
        component_[member] = component_count_;
      } while (member != done);
      ++component_count_;
    }
  }
}

bool Reachability::reaches(StationId from, StationId to) const {
  if (component_[from.index()] == component_[to.index()]) return true;
  std::vector<bool> seen(component_.size(), false);
  std::vector<StationId> open{from};
  seen[from.index()] = true;
  while (!open.empty()) {
    const auto station = open.back();
    open.pop_back();
    for (const auto lane : map_->lanes_from(station)) {
      const auto next = map_->lanes()[lane].to;
      if (next == to) return true;
      if (!seen[next.index()]) {
        seen[next.index()] = true;
        open.push_back(next);
      }
    }
  }
  return false;
}

}  // namespace fleetproof
