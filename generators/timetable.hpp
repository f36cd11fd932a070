#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/scenario.hpp"

namespace fleetproof {

// The quickest ways from one station to all others: from rest to rest over every lane, the way agents that ask nobody drive. Ways are
// chosen without regard to turns; the times of arrival contain them. The first lane is driven without turning.
struct QuickestWays {
  static constexpr std::uint32_t kNone = ~0U;

  StationId from;
  std::vector<std::uint32_t> arrival_lane;    // by station; kNone at `from` and where no way leads
  std::vector<Duration> drives_off, arrives;  // by station: when the arrival lane is begun, after the turn, and ended
  std::vector<std::uint8_t> unique;           // by station: no other way is as quick, to the microsecond

  bool reaches(StationId station) const { return station == from || arrival_lane[station.index()] != kNone; }
  // Lanes from `from` to `station`, in the order they are driven.
  std::vector<std::uint32_t> lanes(const LogicalMap& map, StationId station) const;
};

// Quickest ways of one vehicle type, searched when first asked for. Map and type outlive it.
class Timetable {
 public:
  Timetable(const LogicalMap& map, const VehicleType& type);

  const QuickestWays& from(StationId station);

 private:
  QuickestWays search(StationId from);
  Duration turn(std::uint32_t before, std::uint32_t after);

  const LogicalMap& map_;
  const VehicleType& type_;
  // By lane, side by side for the search.
  struct Hop {
    std::uint32_t from, to;
    Duration drive;
  };
  std::vector<Hop> hops_;
  std::vector<std::pair<Vec2, Vec2>> headings_;  // by lane, at its start and at its end
  std::vector<std::vector<Duration>> turns_;     // by lane, and number of the next one in lanes_from(); negative: not asked for yet
  std::vector<QuickestWays> ways_;
  std::vector<bool> known_;

  // Memory of a search, kept for the next.
  using Open = std::pair<Duration, std::uint32_t>;
  std::vector<Open> open_;
  std::vector<Duration> cost_;
  std::vector<std::uint32_t> order_, quickest_;
};

}  // namespace fleetproof
