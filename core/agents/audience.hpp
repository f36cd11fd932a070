#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/protocol_messages.hpp"
#include "core/agents/zone_set.hpp"

namespace fleetproof::agents {

// The other AGVs that matter to an AGV: in a fleet that is divided into zones those that announce a zone of its own, in
// other fleets all.
class Audience {
 public:
  Audience(std::uint32_t self, std::uint32_t fleet_count, bool divided)
      : divided_(divided), hears_of_all_(!divided || fleet_count <= HeardFrom::kMax) {
    for (std::uint32_t agv = 0; !divided && agv < fleet_count; ++agv) {
      if (agv != self) agvs_.push_back(agv);
    }
  }

  // Whether the fleet is so large that an AGV only talks to those in its zones.
  bool is_divided() const { return divided_; }
  // Whether an AGV hears of the whole fleet now and then: not in a divided fleet of more AGVs than one message has room
  // to acknowledge.
  bool hears_of_all() const { return hears_of_all_; }
  const ZoneSet& own_zones() const { return own_zones_; }
  // By ascending number.
  std::span<const std::uint32_t> agvs() const { return agvs_; }

  // Requires of these two: the fleet is divided. After the own zones have changed, each AGV must be noted again.
  void set_own_zones(const ZoneSet& zones) {
    own_zones_ = zones;
    agvs_.clear();
  }
  void note(std::uint32_t agv, const ZoneSet& zones) {
    const auto at = std::ranges::lower_bound(agvs_, agv);
    const bool is_there = at != agvs_.end() && *at == agv, belongs = zones.meets(own_zones_);
    if (belongs && !is_there) agvs_.insert(at, agv);
    if (!belongs && is_there) agvs_.erase(at);
  }

 private:
  bool divided_, hears_of_all_;
  ZoneSet own_zones_;
  std::vector<std::uint32_t> agvs_;
};

}  // namespace fleetproof::agents
