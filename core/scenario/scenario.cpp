#include "core/scenario/scenario.hpp"

#include <algorithm>

namespace fleetproof {

const char* name_of(Fault::Kind kind) {
  switch (kind) {
    case Fault::Kind::Breakdown:
      return "breakdown";
    case Fault::Kind::ProtectiveStop:
      return "protective-stop";
    case Fault::Kind::LoadDrop:
      return "load-drop";
    case Fault::Kind::Restart:
      return "restart";
    case Fault::Kind::Freeze:
      return "freeze";
  }
  return "?";
}

std::uint64_t Scenario::seed_of(Stream stream) const {
  for (const StreamSeed& own : stream_seeds) {
    if (own.stream == stream) return own.seed;
  }
  return seed;
}

std::size_t Scenario::body_count() const {
  const auto drops = std::ranges::count(faults, Fault::Kind::LoadDrop, &Fault::kind);
  return agvs.size() + obstacles.size() + static_cast<std::size_t>(drops);
}

}  // namespace fleetproof
