// Radio outages that belong to places: cells of access points, and the borders between them.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <tuple>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/motion/piece.hpp"
#include "core/radio/outage_process.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// The square that an access point serves: its column and row in the grid.
struct AccessCell {
  std::int32_t column = 0, row = 0;
};
AccessCell access_cell(const Vec2& at_m, double spacing_m);

// Outages that belong to a place: to the cell of an access point, or to the border between two cells. The answers are
// pure functions of place and time. The map stores the progress of each process, only for speed.
// Threads: one object serves one run on one thread.
class RadioPlaces {
 public:
  // `cell_law`: the law of the outages of a cell.
  RadioPlaces(const PlaceSetup& setup, const OutageLaw& cell_law, std::uint64_t key);

  bool has_borders() const { return setup_.roaming_border_m > 0.0; }
  bool cell_is_out(const Vec2& at_m, SimTime t);
  // Whether an AGV at this place is changing its access point.
  bool is_roaming(const Vec2& at_m, SimTime t);

 private:
  enum class Kind : std::uint32_t {
    Cell = 1,
    BorderAcrossX,
    BorderAcrossY
  };  // a border across x is crossed by driving along x

  bool bad_at(Kind kind, std::int32_t i, std::int32_t k, const OutageLaw& law, SimTime t);
  // Whether a border is near this coordinate. `number`: the border between the access points number and number + 1.
  bool near_border(double coordinate_m, std::int32_t& number) const;

  PlaceSetup setup_;
  OutageLaw cell_law_, border_law_;
  std::uint64_t key_;
  std::map<std::tuple<Kind, std::int32_t, std::int32_t>, OutageProcess> processes_;
};

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
