#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// How much nearer AGVs have come to where they have to go, by the shortest way over the lanes of the map. Driving to
// and fro brings nobody nearer.
class Approach {
 public:
  // Requires: the scenario outlives the object.
  explicit Approach(const Scenario& scenario);

  // The AGV sets out along a segment. It counts as being at the other end already: a drive may take long. If the drive
  // before was along the same segment and was cut short, the AGV goes on.
  void drive_begins(EntityId agv, SegmentId segment);
  void drive_ends(EntityId agv, bool as_planned);
  // The AGV spends time on its last drive: to turn to it, to drive, to settle after it.
  void spend(EntityId agv, Duration time);
  void set_down(EntityId agv, StationId at);
  // From here on, what was gained before does not count. A drive under way counts from its beginning.
  void begin_anew();

  struct Gain {
    // From the station where the AGV was then, to the one nearest to the goal that it has been at since. 0 if no way
    // leads to the goal.
    double way_m = 0.0;
    Duration took{};             // by the drives that brought it nearer than it had been
    bool by_last_drive = false;  // the last drive is one of these
  };
  // If it is asked again for the same goal, it looks only at the stations passed since.
  Gain gain(EntityId agv, StationId goal);

 private:
  const std::vector<double>& lengths_to_m(StationId goal);

  const LogicalMap& map_;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Passed {
    StationId station;
    std::uint32_t before = kNone;  // place in passed_: the one before it, of the same AGV
    Duration took{};               // the drive to it
  };
  std::vector<Passed> passed_;         // since begin_anew()
  std::vector<std::uint32_t> last_;    // by AGV: place in passed_
  std::vector<StationId> was_, here_;  // by AGV: at begin_anew(), and now
  struct Drive {
    SegmentId segment;
    bool cut_short = false, under_way = false;
  };
  std::vector<Drive> drives_;  // by AGV: the last one
  struct Answer {
    StationId goal;  // invalid: none is known
    double nearest_m = 0.0;
    Duration took{};
    std::uint32_t until = kNone;  // place in passed_ up to which that holds: before the last one, which may go on
  };
  std::vector<Answer> answers_;                         // by AGV: the last one since begin_anew()
  std::vector<std::uint32_t> fresh_;                    // places in passed_ that an answer does not know yet
  std::map<StationId, std::vector<double>> lengths_m_;  // by goal, by station
};

}  // namespace fleetproof
