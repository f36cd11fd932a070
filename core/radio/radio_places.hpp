#pragma once

#include <map>
#include <tuple>

#include "core/geometry/pose.hpp"
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

}  // namespace fleetproof
