#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario.hpp"

namespace fleetproof {

// The quickest ways from one station to all others: from rest to rest over every lane, the way agents that ask nobody drive. Ways are
// chosen without regard to turns; the times of arrival contain them. The first lane is driven without turning.
struct QuickestWays {
  static constexpr std::uint32_t kNone = ~0U;

  StationId from;
  std::vector<std::uint32_t> arrival_lane;   // by station; kNone at `from` and where no way leads
  std::vector<Duration> drives_off, arrives;  // by station: when the arrival lane is begun, after the turn, and ended
  std::vector<bool> unique;                  // by station: no other way is as quick, to the microsecond

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
  QuickestWays search(StationId from) const;
  Duration turn(std::uint32_t before, std::uint32_t after) const;

  const LogicalMap& map_;
  const VehicleType& type_;
  std::vector<Duration> drive_;  // by lane
  std::vector<QuickestWays> ways_;
  std::vector<bool> known_;
};

}  // namespace fleetproof
