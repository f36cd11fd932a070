#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "core/motion/piece.hpp"
#include "core/radio/radio_places.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// AGVs that change their access point when they drive over a border of cells, see PlaceSetup::roaming_at_crossing. The
// crossings of an AGV follow from its own pieces and do not depend on the questions that are asked. The length of a
// change is keyed by AGV and number of the crossing.
//
// An AGV leaves a cell when its reference point is more than a micrometre outside. An AGV that stands on a border or
// drives along it therefore stays in its cell. On straight lines, the instant is exact to the nanosecond. On bends, an
// excursion into another cell is not seen if it is shallower than a tenth of a millimetre.
// Threads: one object serves one run on one thread.
class RadioCrossings {
 public:
  RadioCrossings(const PlaceSetup& setup, std::uint64_t key) : setup_(setup), key_(key) {}

  bool is_on() const { return setup_.roaming_at_crossing; }
  // The AGV starts this piece now. Its former piece ends now.
  void piece_begins(const Piece& piece);
  // The AGV is carried to the place where its next piece begins. That is not a crossing.
  void forget_path(AgvId agv);
  // Whether the AGV is changing its access point at t.
  // Requires: t lies in the latest piece of the AGV and does not decrease from call to call.
  bool is_deaf(AgvId agv, SimTime t);

 private:
  struct Crossing {
    SimTime at;
    AccessCell to;
  };
  struct Track {
    bool is_known = false;  // `cell` is the cell of the AGV
    AccessCell cell;
    std::uint32_t crossings = 0;
    SimTime deaf_until = kStart;
    std::deque<Crossing> ahead;  // the crossings on its latest piece, if the piece ends as planned
  };

  void catch_up(AgvId agv, Track& track, SimTime t);

  PlaceSetup setup_;
  std::uint64_t key_;
  std::vector<Track> tracks_;  // by AGV
};

}  // namespace fleetproof
