#include "laws/map_places.hpp"

#include <algorithm>
#include <cstdint>

namespace fleetproof {
namespace {

constexpr std::size_t kCutOffOneIn = 10;  // stations
constexpr std::size_t kSides = 4;

using Neighbours = std::vector<std::vector<std::uint32_t>>;

void once(std::vector<std::uint32_t>& stations) {
  std::ranges::sort(stations);
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
}

// The search for cut stations (Hopcroft and Tarjan 1973), which also counts what each of them cuts off.
class CutSearch {
 public:
  CutSearch(const Neighbours& neighbours, std::vector<bool>& bottleneck)
      : neighbours_(neighbours),
        bottleneck_(bottleneck),
        number_(neighbours.size()),
        low_(neighbours.size()),
        below_(neighbours.size(), 1) {}

  void run() {
    for (std::uint32_t s = 0; s < number_.size(); ++s) {
      if (number_[s] == 0) from(s);
    }
  }

 private:
  struct Step {
    std::uint32_t station, before;
    std::size_t next = 0;
  };

  void from(std::uint32_t root) {
    std::vector<Step> way{{root, root}};
    number_[root] = low_[root] = ++numbered_;
    while (!way.empty()) {
      Step& here = way.back();
      if (here.next < neighbours_[here.station].size()) {
        const std::uint32_t to = neighbours_[here.station][here.next++];
        if (number_[to] == 0) {
          number_[to] = low_[to] = ++numbered_;
          way.push_back({to, here.station});
        } else if (to != here.before) {
          low_[here.station] = std::min(low_[here.station], number_[to]);
        }
        continue;
      }
      const Step done = here;
      way.pop_back();
      if (!way.empty()) leave(done);
    }
    judge_all(root);
  }

  // A part below `before` whose stations lead nowhere above it is cut off without `before`.
  void leave(const Step& done) {
    below_[done.before] += below_[done.station];
    low_[done.before] = std::min(low_[done.before], low_[done.station]);
    if (low_[done.station] < number_[done.before]) return;
    parts_.push_back({done.before, below_[done.station]});
  }

  // The largest part is what remains; all the other parts are cut off from it.
  void judge_all(std::uint32_t root) {
    std::vector<std::size_t> largest(number_.size()), sum(number_.size());
    for (const auto& [station, size] : parts_) {
      largest[station] = std::max(largest[station], size);
      sum[station] += size;
    }
    for (const auto& [station, size] : parts_) {
      const std::size_t above = below_[root] - 1 - sum[station];
      const std::size_t rest = sum[station] + above - std::max(largest[station], above);
      if (rest * kCutOffOneIn >= neighbours_.size()) bottleneck_[station] = true;
    }
    parts_.clear();
  }

  struct Part {
    std::uint32_t station;
    std::size_t size;
  };

  const Neighbours& neighbours_;
  std::vector<bool>& bottleneck_;
  std::vector<std::uint32_t> number_, low_;  // by station; 0: not found yet
  std::vector<std::size_t> below_;           // stations found through it, with itself
  std::vector<Part> parts_;
  std::uint32_t numbered_ = 0;
};

}  // namespace

MapPlaces::MapPlaces(const LogicalMap& map) : bottleneck(map.station_count()), four_way(map.station_count()) {
  Neighbours before(map.station_count()), beside(map.station_count());
  for (const Lane& lane : map.lanes()) {
    before[lane.to.index()].push_back(lane.from.value);
    beside[lane.from.index()].push_back(lane.to.value);
    beside[lane.to.index()].push_back(lane.from.value);
  }
  for (std::size_t s = 0; s < before.size(); ++s) {
    once(before[s]);
    once(beside[s]);
    four_way[s] = before[s].size() >= kSides;
  }
  CutSearch(beside, bottleneck).run();
}

}  // namespace fleetproof
