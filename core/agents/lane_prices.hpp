#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/drive_rules.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/path.hpp"

namespace fleetproof::agents {

// What each lane costs an AGV now: its usual cost, and a price for the other AGVs there. Many prices are taken anew for
// each search. Requires: map, rules and usual costs outlive the object.
class LanePrices {
 public:
  // `usual_s`: by lane. `few_agvs`: seldom have more AGVs a price at once.
  LanePrices(const MapView& map, const DriveRules& rules, std::span<const double> usual_s, std::uint32_t few_agvs);

  // By lane; infinite where the AGV must not drive.
  std::span<const double> costs_s() const { return costs_s_; }

  // Forgets all prices. `loaded`: the AGV carries a load, which may forbid lanes.
  void begin(bool loaded);
  bool loaded() const { return loaded_; }
  // For an AGV that stands at the station or will: all lanes that begin or end there get dearer.
  void price_station(std::uint32_t station, double extra_s);
  // For an AGV that drives these lanes or announces them: meeting it there is dear.
  void price_meetings(const Path& other);

 private:
  // On a lane, an AGV meets those on the lanes back, which begin where it ends and have the same segment. Most lanes
  // have one; a lane that has none makes itself no dearer.
  struct Meeting {
    std::uint32_t lane_back = 0;
    std::uint32_t next = 0;  // where the next one of the same lane stands; 0: there is none
    double extra_s = 0.0;
  };
  static std::vector<std::byte> work_out(const MapView& map);
  void read(std::span<const std::byte> tables);

  const MapView& map_;
  const DriveRules& rules_;
  std::span<const double> usual_s_;
  std::vector<std::byte> own_;                     // the tables, if they are not shared
  std::span<const Meeting> meetings_;              // the first ones by the lane that is driven, then the others
  std::span<const std::uint32_t> touching_;        // lanes, by the station at which they end or begin
  std::span<const std::uint32_t> first_touching_;  // by station, and one more
  std::vector<double> costs_s_;
  struct Dearer {
    std::uint32_t lane;
    double before_s;
  };
  std::vector<Dearer> dearer_;  // in this order
  bool remembers_;              // dearer_ is kept
  bool loaded_ = false;
};

}  // namespace fleetproof::agents
