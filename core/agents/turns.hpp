#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/shapes.hpp"

namespace fleetproof::agents {

// A turn on the spot by the shorter way, in either direction.
struct Turn {
  Vec from, to;
};

// The turns on the spot that AGVs make, by number. At each station one stands for all turns, whatever their headings:
// its number is that of the station. Further numbers are of turns of less than three eighths between two headings that
// the lanes of a station have there. Requires: the map outlives the object.
class Turns {
 public:
  explicit Turns(const MapView& map);
  // From the tables of another one; they outlive it.
  explicit Turns(TableReader& tables);
  Turns(const Turns&) = delete;
  Turns& operator=(const Turns&) = delete;
  void add_to(TableWriter& tables) const;

  // Of those for all turns, too.
  std::uint32_t count() const { return station_count() + static_cast<std::uint32_t>(turns_.size()); }
  std::uint32_t station_count() const { return static_cast<std::uint32_t>(begin_.size()) - 1; }
  bool is_any(std::uint32_t number) const { return number < station_count(); }
  std::uint32_t number_of(std::uint32_t station, Vec from, Vec to) const;
  std::uint32_t station_of(std::uint32_t number) const;
  // Requires: it is not one that stands for all turns.
  const Turn& turn(std::uint32_t number) const { return turns_[number - station_count()]; }

 private:
  std::vector<std::uint32_t> own_begin_{0};
  std::vector<Turn> own_turns_;
  std::span<const std::uint32_t> begin_;  // by station
  std::span<const Turn> turns_;
};

}  // namespace fleetproof::agents
