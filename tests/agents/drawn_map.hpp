#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

// Maps for the tests of the agents, built without the project's own layouts: the agents see nothing but the C header,
// and so do their tests.
namespace fleetproof::agents::testing {

inline constexpr fp_agv kTestAgv{1.6, 1.0, 2.0, 0.5, 1.0, 1.0, 1.0, 1.0, 1.6, 1.0, 0.0, 0.0, 0.0, 0};

// Stations and segments by number, in the order in which they were added. Finish with map().
class DrawnMap {
 public:
  std::uint32_t station(double x_m, double y_m, std::uint32_t purposes = FP_ROUTING, const char* name = "") {
    stations_.push_back({name, x_m, y_m, purposes, 0, nullptr, 0, 0.0, 0.0});
    return static_cast<std::uint32_t>(stations_.size() - 1);
  }

  // Straight, both ways or one-way.
  std::uint32_t segment(std::uint32_t from, std::uint32_t to, bool both_ways = true) {
    lane(from, to, {straight(from, to)});
    if (both_ways) lane(to, from, {straight(to, from)});
    return segments_++;
  }

  // One more lane of the newest segment, as for driving backward.
  void beside(std::uint32_t from, std::uint32_t to) {
    --segments_;
    lane(from, to, {straight(from, to)});
    ++segments_;
  }

  // One-way, along an arc that leaves `from` with this heading.
  std::uint32_t bend(std::uint32_t from, std::uint32_t to, double heading_x, double heading_y, double length_m,
                     double curvature_per_m) {
    lane(from, to,
         {fp_arc{{stations_[from].x_m, stations_[from].y_m, heading_x, heading_y}, length_m, curvature_per_m}});
    return segments_++;
  }

  void drive_backward(std::uint32_t lane) { lanes_[lane].backward = 1; }

  // The lane is for AGVs with this load alone: FP_EMPTY_ONLY or FP_LOADED_ONLY.
  void permit(std::uint32_t from, std::uint32_t to, std::uint32_t load) {
    permissions_.push_back({FP_ANY_TYPE, load});
    fp_lane& lane = lanes_[lane_between(from, to)];
    lane.permission_count = 1;
    lane.permissions = &permissions_.back();
  }

  const fp_map& map() {
    leaving_.assign(stations_.size(), {});
    for (std::uint32_t id = 0; id < lanes_.size(); ++id) leaving_[lanes_[id].from].push_back(id);
    for (std::size_t s = 0; s < stations_.size(); ++s) {
      stations_[s].lane_count = static_cast<std::uint32_t>(leaving_[s].size());
      stations_[s].lanes = leaving_[s].data();
    }
    map_ = {sizeof(fp_map),
            static_cast<std::uint32_t>(stations_.size()),
            static_cast<std::uint32_t>(lanes_.size()),
            segments_,
            sizeof(fp_station),
            sizeof(fp_lane),
            sizeof(fp_arc),
            stations_.data(),
            lanes_.data(),
            0,
            sizeof(fp_block),
            nullptr};
    return map_;
  }

  const fp_lane& lane_at(std::uint32_t id) const { return lanes_[id]; }
  // FP_NONE if there is none.
  std::uint32_t lane_between(std::uint32_t from, std::uint32_t to) const {
    for (std::uint32_t id = 0; id < lanes_.size(); ++id) {
      if (lanes_[id].from == from && lanes_[id].to == to) return id;
    }
    return FP_NONE;
  }

 private:
  fp_arc straight(std::uint32_t from, std::uint32_t to) const {
    const double dx = stations_[to].x_m - stations_[from].x_m, dy = stations_[to].y_m - stations_[from].y_m;
    const double length_m = std::hypot(dx, dy);
    return {{stations_[from].x_m, stations_[from].y_m, dx / length_m, dy / length_m}, length_m, 0.0};
  }

  void lane(std::uint32_t from, std::uint32_t to, std::vector<fp_arc> arcs) {
    double length_m = 0.0;
    for (const fp_arc& arc : arcs) length_m += arc.length_m;
    arcs_.push_back(std::move(arcs));
    lanes_.push_back({segments_, from, to, length_m, static_cast<std::uint32_t>(arcs_.back().size()),
                      arcs_.back().data(), 0.0, 0.0, 0, nullptr, 0, 0, nullptr});
  }

  std::vector<fp_station> stations_;
  std::deque<std::vector<fp_arc>> arcs_;
  std::vector<fp_lane> lanes_;
  std::deque<fp_permission> permissions_;
  std::vector<std::vector<std::uint32_t>> leaving_;
  std::uint32_t segments_ = 0;
  fp_map map_{};
};

// A fleet of equal AGVs on a map.
struct TestFleet {
  TestFleet(const fp_map& of_map, std::uint32_t count, const fp_agv& agv = kTestAgv) : map(of_map), agvs(count, agv) {}

  fp_briefing briefing(std::uint32_t self, std::uint32_t start) const {
    fp_briefing briefing{};
    briefing.struct_size = sizeof(fp_briefing);
    briefing.self = self;
    briefing.fleet_count = static_cast<std::uint32_t>(agvs.size());
    briefing.agv_stride = sizeof(fp_agv);
    briefing.fleet = agvs.data();
    briefing.map = &map;
    briefing.start_station = start;
    briefing.safety_distance_m = 0.10;
    briefing.radio_range_m = 1000.0;
    briefing.config = config;
    briefing.start_segment = FP_NONE;
    briefing.next_segment = FP_NONE;
    return briefing;
  }

  const fp_map& map;
  std::vector<fp_agv> agvs;
  const char* config = "";
};

}  // namespace fleetproof::agents::testing
