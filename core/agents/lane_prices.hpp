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
  void make_dearer(std::uint32_t lane, double extra_s) {
    if (remembers_) dearer_.push_back({lane, costs_s_[lane]});
    costs_s_[lane] += extra_s;
  }
  // For an AGV that drives these lanes or announces them: meeting it there is dear.
  void price_meetings(const Path& other);

 private:
  // On a lane, an AGV meets those on the lanes back, which begin where it ends and have the same segment.
  struct Meeting {
    std::uint32_t lane_back = 0, unused = 0;  // no byte is left open: the table is copied as bytes
    double extra_s = 0.0;
  };
  static std::vector<std::byte> work_out(const MapView& map);
  void read(std::span<const std::byte> tables);

  const MapView& map_;
  const DriveRules& rules_;
  std::span<const double> usual_s_;
  std::vector<std::byte> own_;                     // the tables, if they are not shared
  std::span<const Meeting> meetings_;              // by the lane that is driven
  std::span<const std::uint32_t> first_meetings_;  // by lane, and one more: where its meetings begin
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
