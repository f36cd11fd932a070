#pragma once

#include <array>
#include <cstdint>

#include "generators/map/problem.hpp"

namespace fleetproof {

// What was refused while worlds were drawn, summed over any number of worlds.
struct RejectionCounts {
  std::uint64_t worlds = 0;                        // made
  std::uint64_t worlds_rejected = 0;               // refused as a whole and replaced by the next draw
  std::uint64_t fleets_without_room = 0;           // attempts that ran out of stations
  std::uint64_t starts_tried = 0;                  // stations drawn for an AGV
  std::uint64_t worlds_without_storage = 0;        // in which transports lead between stations that are not for storage
  std::uint64_t pairs_wanted = 0, pairs_made = 0;  // pairs of AGVs that should meet
  std::array<std::uint64_t, kProblemKinds> reasons{};  // of rejected starts and worlds, by ProblemKind

  std::uint64_t& of(ProblemKind kind) { return reasons[static_cast<std::size_t>(kind)]; }
  std::uint64_t of(ProblemKind kind) const { return reasons[static_cast<std::size_t>(kind)]; }

  void add(const RejectionCounts& other) {
    worlds += other.worlds;
    worlds_rejected += other.worlds_rejected;
    fleets_without_room += other.fleets_without_room;
    starts_tried += other.starts_tried;
    worlds_without_storage += other.worlds_without_storage;
    pairs_wanted += other.pairs_wanted;
    pairs_made += other.pairs_made;
    for (std::size_t i = 0; i < reasons.size(); ++i) reasons[i] += other.reasons[i];
  }
  friend bool operator==(const RejectionCounts&, const RejectionCounts&) = default;
};

}  // namespace fleetproof
