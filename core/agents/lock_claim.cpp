#include "core/agents/lock_claim.hpp"

#include <algorithm>

namespace fleetproof::agents {

void AnnouncedWay::replace(const Path& way, std::uint32_t first_ms) {
  std::uint32_t same = 0;
  if (way.station == path_.station) {
    while (same < std::min(way.count, path_.count) && way.lane_ids[same] == path_.lane_ids[same]) ++same;
  }
  path_ = way;
  for (std::uint32_t i = same; i < way.count; ++i) since_ms_[i] = first_ms;
}

void AnnouncedWay::shorten(const MapView& map, std::uint32_t lanes) {
  std::copy(since_ms_.begin() + lanes, since_ms_.begin() + path_.count, since_ms_.begin());
  for (std::uint32_t i = 0; i < lanes; ++i) pass_first_lane(map, path_);
}

}  // namespace fleetproof::agents
