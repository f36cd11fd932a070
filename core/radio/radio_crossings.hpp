#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "core/motion/piece.hpp"
#include "core/radio/radio_places.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// AGVs that change their access point by driving over a border of cells, see PlaceSetup::roaming_at_crossing. What an
// AGV's crossings are follows from its own pieces, whoever asks and however often; how long each lasts is keyed by AGV
// and number of the crossing.
//
// A cell is left once the reference point is more than a micrometre outside of it, so an AGV that stands on a border or
// drives along it stays where it is. On straight ways that instant is exact to the nanosecond. On a bend an excursion
// into another cell that is shallower than a tenth of a millimetre is not seen. For one run, on one thread.
class RadioCrossings {
 public:
  RadioCrossings(const PlaceSetup& setup, std::uint64_t key) : setup_(setup), key_(key) {}

  bool is_on() const { return setup_.roaming_at_crossing; }
  // The AGV does this from now on, and did what it was doing until now.
  void piece_begins(const Piece& piece);
  // Somebody moves it to where its next piece begins, which is no crossing.
  void is_carried(AgvId agv);
  // Whether it is changing over at t, which lies in its latest piece and does not decrease from call to call.
  bool is_deaf(AgvId agv, SimTime t);

 private:
  struct Crossing {
    SimTime at;
    AccessCell to;
  };
  struct Track {
    bool is_known = false;  // it has moved, or stood, as we were told
    AccessCell cell;
    std::uint32_t crossings = 0;
    SimTime deaf_until = kStart;
    std::deque<Crossing> ahead;  // on its latest piece, if that goes as planned
  };

  void catch_up(AgvId agv, Track& track, SimTime t);

  PlaceSetup setup_;
  std::uint64_t key_;
  std::vector<Track> tracks_;  // by AGV
};

}  // namespace fleetproof
