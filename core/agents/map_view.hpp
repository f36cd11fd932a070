#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/shapes.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// Headings that are closer than this need no turn on the spot. The floor that the body sweeps between them is within
// the tolerance of every hull.
inline bool same_heading(Vec a, Vec b) { return dot(a, b) > kCosineOfSameHeading; }
inline bool opposite_heading(Vec a, Vec b) { return dot(a, b) < -0.9; }  // about

// The name of a station, if it is short: copied without a call, because AGVs name stations in every message.
struct ShortName {
  static constexpr std::uint8_t kIsLong = 0xff;
  std::array<char, 15> text{};
  std::uint8_t size = 0;
};

// The logical map by index, with the headings at the ends of its lanes. Requires: the map outlives it, and the facts.
class MapView {
 public:
  explicit MapView(const fp_map& map);
  // Uses the tables that the AGVs of a run share.
  explicit MapView(const fp_facts& facts);
  MapView(const MapView&) = delete;
  MapView& operator=(const MapView&) = delete;

  // From which others can derive what follows from the map; null: there are none.
  const fp_facts* facts() const { return facts_; }

  std::uint32_t station_count() const { return map_.station_count; }
  std::uint32_t lane_count() const { return map_.lane_count; }
  const fp_station& station(std::uint32_t id) const { return *fp_station_at(&map_, id); }
  const fp_lane& lane(std::uint32_t id) const { return *fp_lane_at(&map_, id); }
  const fp_arc& arc(const fp_lane& lane, std::uint32_t i) const { return *fp_arc_at(&map_, &lane, i); }

  bool has_chargers() const;
  const ShortName& short_name(std::uint32_t station_id) const {
    if (short_names_.empty()) find_short_names();
    return short_names_[station_id];
  }
  Vec position_m(std::uint32_t station_id) const { return {station(station_id).x_m, station(station_id).y_m}; }
  std::span<const std::uint32_t> lanes_from(std::uint32_t station_id) const {
    return {station(station_id).lanes, station(station_id).lane_count};
  }
  std::span<const std::uint32_t> lanes_to(std::uint32_t station_id) const;
  // Of the AGV's nose.
  Vec start_heading(std::uint32_t lane_id) const { return start_headings_[lane_id]; }
  Vec end_heading(std::uint32_t lane_id) const { return end_headings_[lane_id]; }
  bool is_backward(std::uint32_t lane_id) const { return rules_known_ && lane(lane_id).backward != 0; }
  // As the AGV's actions name this lane.
  std::uint32_t action_segment(std::uint32_t lane_id) const {
    return is_backward(lane_id) ? lane(lane_id).segment | FP_BACKWARD : lane(lane_id).segment;
  }
  // Whether the segment of this lane also has a lane in the other direction.
  bool two_way(std::uint32_t lane_id) const { return two_way_[lane(lane_id).segment] != 0; }

  // Whether the host tells limits and rules: since minor 2 of the header. Before, everything is allowed.
  bool tells_rules() const { return rules_known_; }
  bool permits(std::uint32_t lane_id, std::uint32_t vehicle_type, bool loaded) const;
  bool may_turn(std::uint32_t station_id) const { return !rules_known_ || station(station_id).turning_forbidden == 0; }
  bool asks_for_a_heading(std::uint32_t station_id) const {
    return rules_known_ && (station(station_id).heading_x != 0.0 || station(station_id).heading_y != 0.0);
  }
  bool may_stay(std::uint32_t station_id, Vec heading) const;

 private:
  std::vector<std::byte> work_out() const;
  void read(std::span<const std::byte> tables);
  void find_short_names() const;

  const fp_map& map_;
  const fp_facts* facts_ = nullptr;
  bool rules_known_;
  std::vector<std::byte> own_;                                // the tables, if they are not shared
  std::span<const Vec> start_headings_, end_headings_;        // by lane
  std::span<const std::uint8_t> two_way_;                     // by segment
  std::span<const std::uint32_t> arriving_, arriving_begin_;  // lanes, ordered by the station at which they end
  mutable std::vector<ShortName> own_short_names_;            // if they are not shared
  mutable std::span<const ShortName> short_names_;            // by station; empty until somebody asks
};

std::string_view station_name(const MapView& map, std::uint32_t station_id);

// The straight line from the beginning of a lane to its end.
fp_arc chord_of(const MapView& map, std::uint32_t lane_id);

}  // namespace fleetproof::agents
