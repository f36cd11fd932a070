#include "core/agents/registrar.hpp"

namespace fleetproof::agents {

bool Registrar::is_ready() {
  while (heard_from_ < neighbours_.fleet_count() && has_heard_from(heard_from_)) ++heard_from_;
  return heard_from_ == neighbours_.fleet_count();
}

void Registrar::fill_in(Roll& roll, const ZoneSet& zones, std::uint32_t applicant, std::uint32_t from) const {
  roll.from = from;
  roll.next = FP_NONE;
  roll.count = 0;
  for (std::uint32_t agv = from; agv < neighbours_.fleet_count(); ++agv) {
    if (agv == applicant) continue;
    const bool is_self = agv == neighbours_.self();
    const Neighbour& n = neighbours_.of(agv);
    if (!(is_self ? neighbours_.audience().own_zones() : n.zones).meets(zones)) continue;
    if (roll.count == Roll::kMax) {
      roll.next = agv;
      return;
    }
    roll.list[roll.count++] = is_self ? RollEntry{agv, 0, 0} : newest_of(agv, n);
  }
}

}  // namespace fleetproof::agents
