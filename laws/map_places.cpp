#include "laws/map_places.hpp"

#include <algorithm>
#include <cstdint>

namespace fleetproof {
namespace {

constexpr std::size_t kCutOffOneIn = 10;  // stations
constexpr std::size_t kSides = 4;

// The stations at the other ends of the segments of each station, one list after the other.
struct Neighbours {
  explicit Neighbours(const Layout& layout) : begin(layout.stations.size() + 1), stations(2 * layout.segments.size()) {
    for (const Segment& segment : layout.segments) ++begin[segment.from.index()], ++begin[segment.to.index()];
    for (std::size_t s = 1; s < begin.size(); ++s) begin[s] += begin[s - 1];
    // Filled from behind: at the end, `begin` is where each list begins.
    for (const Segment& segment : layout.segments) {
      stations[--begin[segment.from.index()]] = segment.to.value;
      stations[--begin[segment.to.index()]] = segment.from.value;
    }
  }
  std::vector<std::uint32_t> begin;  // by station, and the end of the last list
  std::vector<std::uint32_t> stations;
};

// The search for cut stations (Hopcroft and Tarjan 1973), which also counts what each of them cuts off.
class CutSearch {
 public:
  CutSearch(const Neighbours& neighbours, std::vector<bool>& bottleneck)
      : neighbours_(neighbours),
        bottleneck_(bottleneck),
        number_(bottleneck.size()),
        low_(bottleneck.size()),
        below_(bottleneck.size(), 1) {}

  void run() {
    for (std::uint32_t s = 0; s < number_.size(); ++s) {
      if (number_[s] == 0) from(s);
    }
  }

 private:
  struct Step {
    std::uint32_t station, before, next;
  };

  Step step(std::uint32_t station, std::uint32_t before) const { return {station, before, neighbours_.begin[station]}; }

  void from(std::uint32_t root) {
    std::vector<Step> way{step(root, root)};
    number_[root] = low_[root] = ++numbered_;
    while (!way.empty()) {
      Step& here = way.back();
      if (here.next < neighbours_.begin[here.station + 1]) {
        const std::uint32_t to = neighbours_.stations[here.next++];
        if (number_[to] == 0) {
          number_[to] = low_[to] = ++numbered_;
          way.push_back(step(to, here.station));
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
      if (rest * kCutOffOneIn >= bottleneck_.size()) bottleneck_[station] = true;
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
  CutSearch(Neighbours(map.layout()), bottleneck).run();
  std::vector<std::size_t> sides(map.station_count());
  std::vector<StationId> last(map.station_count());  // of the stations counted as a side of a station
  for (std::size_t s = 0; s < map.station_count(); ++s) {
    for (const std::uint32_t lane : map.lanes_from(StationId{s})) {
      const std::size_t to = map.lanes()[lane].to.index();
      if (last[to] != StationId{s}) ++sides[to];
      last[to] = StationId{s};
    }
  }
  for (std::size_t s = 0; s < map.station_count(); ++s) four_way[s] = sides[s] >= kSides;
}

}  // namespace fleetproof
