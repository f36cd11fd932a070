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
      : neighbours_(neighbours), bottleneck_(bottleneck), found_(bottleneck.size()) {}

  void run() {
    for (std::uint32_t s = 0; s < found_.size(); ++s) {
      if (found_[s].number == 0) from(s);
    }
  }

 private:
  struct Found {
    std::uint32_t number = 0, low = 0;   // 0: not found yet
    std::uint32_t below = 1;             // stations found through it, with itself
    std::uint32_t largest = 0, sum = 0;  // of the parts that are cut off without it
  };
  struct Step {
    std::uint32_t station, before, next, end;
  };

  Step step(std::uint32_t station, std::uint32_t before) {
    found_[station].number = found_[station].low = ++numbered_;
    return {station, before, neighbours_.begin[station], neighbours_.begin[station + 1]};
  }

  void from(std::uint32_t root) {
    way_.assign(1, step(root, root));
    while (!way_.empty()) {
      Step& here = way_.back();
      if (here.next < here.end) {
        const std::uint32_t to = neighbours_.stations[here.next++], number = found_[to].number;
        if (number == 0) {
          way_.push_back(step(to, here.station));
        } else if (to != here.before) {
          found_[here.station].low = std::min(found_[here.station].low, number);
        }
        continue;
      }
      const Step done = here;
      way_.pop_back();
      if (!way_.empty()) leave(done);
    }
    judge_all(root);
  }

  // A part below `before` whose stations lead nowhere above it is cut off without `before`.
  void leave(const Step& done) {
    Found &before = found_[done.before], &part = found_[done.station];
    before.below += part.below;
    before.low = std::min(before.low, part.low);
    if (part.low < before.number) return;
    if (before.sum == 0) cut_.push_back(done.before);
    before.largest = std::max(before.largest, part.below);
    before.sum += part.below;
  }

  // The largest part is what remains; all the other parts are cut off from it.
  void judge_all(std::uint32_t root) {
    for (const std::uint32_t station : cut_) {
      const Found& found = found_[station];
      const std::uint32_t above = found_[root].below - 1 - found.sum;
      const std::size_t rest = found.sum + above - std::max(found.largest, above);
      if (rest * kCutOffOneIn >= bottleneck_.size()) bottleneck_[station] = true;
    }
    cut_.clear();
  }

  const Neighbours& neighbours_;
  std::vector<bool>& bottleneck_;
  std::vector<Found> found_;  // by station
  std::vector<Step> way_;
  std::vector<std::uint32_t> cut_;  // stations without which a part is cut off
  std::uint32_t numbered_ = 0;
};

}  // namespace

MapPlaces::MapPlaces(const LogicalMap& map) : bottleneck(map.station_count()), four_way(map.station_count()) {
  CutSearch(Neighbours(map.layout()), bottleneck).run();
  struct Sides {
    std::uint32_t count = 0;
    StationId last;  // that was counted
  };
  std::vector<Sides> sides(map.station_count());
  const auto& lanes = map.lanes();
  for (std::size_t s = 0; s < map.station_count(); ++s) {
    for (const std::uint32_t lane : map.lanes_from(StationId{s})) {
      const std::size_t to = lanes[lane].to.index();
      if (sides[to].last == StationId{s}) continue;
      sides[to].last = StationId{s};
      if (++sides[to].count == kSides) four_way[to] = true;
    }
  }
}

}  // namespace fleetproof
