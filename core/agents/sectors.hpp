#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/shapes.hpp"

namespace fleetproof::agents {

// A turn on the spot from one heading to the other, or back, by the shorter way.
struct Sector {
  Vec from, to;
  std::uint32_t station = 0;
};

// All pairs of headings between which an AGV may turn at a station: those with which lanes end or begin there, if they
// are less than about three eighths of a full turn apart; none at a station with more than 24 headings. Half a turn is
// no sector, because it may go either way; hull-lock relies on that after a restart. Requires: the map outlives the
// object.
class Sectors {
 public:
  explicit Sectors(const MapView& map);
  // From the tables of another one; they outlive it.
  explicit Sectors(TableReader& tables);
  Sectors(const Sectors&) = delete;
  Sectors& operator=(const Sectors&) = delete;
  void add_to(TableWriter& tables) const;

  std::uint32_t count() const { return static_cast<std::uint32_t>(sectors_.size()); }
  const Sector& operator[](std::uint32_t number) const { return sectors_[number]; }
  // FP_NONE: there is none, and this turn may sweep the whole disc.
  std::uint32_t find(std::uint32_t station, Vec from, Vec to) const;
  // Those at a station: from the number begin_at(station) up to, and without, begin_at(station + 1).
  std::uint32_t begin_at(std::uint32_t station) const { return begin_[station]; }

 private:
  std::vector<std::uint32_t> own_begin_{0};
  std::vector<Sector> own_sectors_;
  std::span<const std::uint32_t> begin_;  // by station
  std::span<const Sector> sectors_;
};

}  // namespace fleetproof::agents
