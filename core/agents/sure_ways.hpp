#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// Ways between all stations and a few of them, the roots: trees that are made once. If a station and some lanes are
// taken away, most of these ways are not broken. So most stations still reach the roots, and are reached from them,
// and no search has to show that.
class SureWays {
 public:
  // From the bytes of `work_out`. Requires: map and bytes outlive the object.
  SureWays(const MapView& map, std::span<const std::byte> tables);

  // Requires: there is a root, and the roots reach each other while nothing is missing.
  static std::vector<std::byte> work_out(const MapView& map, std::span<const std::uint32_t> roots);

  // From now on, this station and these lanes are missing. Most of the roots that are left still reach each other:
  // these roots stay, the others are not looked at.
  void take_away(std::uint32_t station, std::span<const std::uint32_t> lanes);
  // True only if the station still reaches the roots that stay; backwards, only if they still reach the station.
  bool is_sure(std::uint32_t station, bool backwards) const;

 private:
  // Of a station in a tree: the lane by which its way leaves, or arrives, and the numbers of all stations whose ways
  // lead through it, the own number first.
  struct Place {
    std::uint32_t lane = FP_NONE, first = 0, end = 0;
  };
  // What is missing breaks the ways of the stations with these numbers.
  struct Broken {
    std::uint32_t first, end;
  };
  struct Tree {
    std::span<const Place> places;  // by station
    std::vector<Broken> broken;

    bool is_whole(std::uint32_t station) const;
  };
  struct Root {
    std::uint32_t station;
    Tree there, back;  // the ways to the root, and those from it
    bool stays = false;
  };

  static std::vector<Place> grow(const MapView& map, std::uint32_t root, bool backwards);
  std::size_t keep_those_with(const Root& root);

  const MapView& map_;
  std::vector<Root> roots_;
};

}  // namespace fleetproof::agents
