#include "generators/map/antiparallel.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

bool is_mirrored(const Segment& there, const Segment& back) {
  return std::ranges::equal(there.control_points_m.begin(), there.control_points_m.end(),
                            back.control_points_m.rbegin(), back.control_points_m.rend(),
                            [](const Vec2& a, const Vec2& b) { return (a - b).norm() <= kSameTrack_m; });
}

}  // namespace

std::size_t merge_antiparallel(Layout& layout) {
  std::vector<Segment> kept;
  std::multimap<std::pair<std::size_t, std::size_t>, std::size_t> waiting;  // by (from, to): one-way segments in `kept`
  for (auto& segment : layout.segments) {
    const auto from = segment.from.index(), to = segment.to.index();
    const auto [begin, end] = waiting.equal_range({to, from});
    const auto twin = std::find_if(begin, end, [&](const auto& entry) {
      return !segment.bidirectional && is_mirrored(kept[entry.second], segment);
    });
    if (twin != end) {
      kept[twin->second].bidirectional = true;
      waiting.erase(twin);
      continue;
    }
    if (!segment.bidirectional) waiting.emplace(std::pair(from, to), kept.size());
    kept.push_back(std::move(segment));
  }
  const auto pairs = layout.segments.size() - kept.size();
  layout.segments = std::move(kept);
  return pairs;
}

}  // namespace fleetproof
