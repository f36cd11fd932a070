#include "core/scenario/scenario.hpp"

#include <algorithm>

namespace fleetproof {

std::uint64_t Scenario::seed_of(Stream stream) const {
  for (const StreamSeed& own : stream_seeds) {
    if (own.stream == stream) return own.seed;
  }
  return seed;
}

std::size_t Scenario::entity_count() const {
  const auto drops = std::ranges::count(faults, Fault::Kind::LoadDrop, &Fault::kind);
  return first_fallen_load().index() + static_cast<std::size_t>(drops);
}

}  // namespace fleetproof
