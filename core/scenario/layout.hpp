// The layout: segments, lanes, stations and storage of the floor.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/strong_id.hpp"
#include "core/base/words.hpp"
#include "core/geometry/curve.hpp"
#include "core/geometry/pose.hpp"
#include "core/motion/motion_profile.hpp"

namespace fleetproof {

// What a block asks of control software: at most one vehicle inside, or all in one direction (openTCS blocks, RMF
// mutexes).
enum class BlockKind : std::uint8_t { OneVehicle = 0, SameDirection = 1 };
constexpr const char* name_of(BlockKind kind) {
  switch (kind) {
    case BlockKind::OneVehicle:
      return "one-vehicle";
    case BlockKind::SameDirection:
      return "same-direction";
  }
  return kNoWord;
}

// Which end of the AGV goes first. Either: the agent chooses.
enum class Travel : std::uint8_t { Forward = 0, Backward = 1, Either = 2 };
constexpr const char* name_of(Travel travel) {
  switch (travel) {
    case Travel::Forward:
      return "forward";
    case Travel::Backward:
      return "backward";
    case Travel::Either:
      return "either";
  }
  return kNoWord;
}

enum class LoadState : std::uint8_t { Any = 0, Empty = 1, Loaded = 2 };
constexpr const char* name_of(LoadState state) {
  switch (state) {
    case LoadState::Any:
      return "any";
    case LoadState::Empty:
      return "empty";
    case LoadState::Loaded:
      return "loaded";
  }
  return kNoWord;
}

// Who may drive a segment.
struct Permission {
  std::string vehicle_type{};  // its name; empty: every type
  LoadState load = LoadState::Any;

  friend bool operator==(const Permission&, const Permission&) = default;
};

// A named set of segments. Agents are told of it. No law checks that they keep it; laws judge distances and loads.
struct SegmentBlock {
  std::string name{};
  BlockKind kind = BlockKind::OneVehicle;
};

// An edge of the logical map. AGVs drive it from `from` to `to`. A bidirectional segment is also driven in the other
// direction.
struct Segment {
  std::string name{};
  StationId from{}, to{};
  bool bidirectional = false;
  // None: straight; 2 for each cubic Bezier, and the joints between (2, 5, 8, ...).
  std::vector<Vec2> control_points_m{};
  // From `from` to `to`, and back. 0: no limit but the vehicle's own.
  double speed_limit_mps = 0.0, back_speed_limit_mps = 0.0;
  double width_m = 0.0;                 // of the drawn floor, for pages alone; 0: not known
  std::vector<std::uint32_t> blocks{};  // to which it belongs, by place in Layout::blocks, ascending
  Travel travel = Travel::Forward, back_travel = Travel::Forward;  // from `from` to `to`, and back
  std::vector<Permission> permissions{};  // an AGV needs one of them, in both directions; none listed: all may drive it

  bool has_properties() const {
    return speed_limit_mps > 0.0 || back_speed_limit_mps > 0.0 || width_m > 0.0 || !blocks.empty();
  }
  // What came later than the properties above, and has a part of its own in digests.
  bool has_rules() const { return travel != Travel::Forward || back_travel != Travel::Forward || !permissions.empty(); }
  // An empty `vehicle_type` has the permissions of every type.
  bool permits(std::string_view vehicle_type, bool loaded) const;
};

// What a station may be used for. A station may have several purposes (Sect. 2.2).
enum class Purpose : std::uint8_t { Routing = 1, Storage = 2, Charging = 4, Parking = 8 };
constexpr const char* name_of(Purpose purpose) {
  switch (purpose) {
    case Purpose::Routing:
      return "routing";
    case Purpose::Storage:
      return "storage";
    case Purpose::Charging:
      return "charging";
    case Purpose::Parking:
      return "parking";
  }
  return kNoWord;
}

class Purposes {
 public:
  constexpr Purposes() = default;
  constexpr Purposes(Purpose p) : bits_(static_cast<std::uint8_t>(p)) {}  // NOLINT: one purpose is a set of one
  static constexpr Purposes from_bits(std::uint8_t bits) { return Purposes(bits, 0); }
  constexpr bool has(Purpose p) const { return (bits_ & static_cast<std::uint8_t>(p)) != 0; }
  constexpr Purposes operator|(Purposes other) const {
    return from_bits(static_cast<std::uint8_t>(bits_ | other.bits_));
  }
  constexpr std::uint8_t bits() const { return bits_; }
  friend constexpr bool operator==(Purposes, Purposes) = default;

 private:
  constexpr Purposes(std::uint8_t bits, int) : bits_(bits) {}
  std::uint8_t bits_ = 0;
};

// A node of the logical map: a place on the track where an AGV can stop and change direction.
struct Station {
  std::string name;
  Vec2 position_m = Vec2::Zero();
  Purposes purposes = Purpose::Routing;
  bool turning = true;            // AGVs may turn on the spot here
  std::optional<Vec2> heading{};  // of an AGV that picks, drops, parks or charges here; none: any

  bool has_rules() const { return !turning || heading.has_value(); }
};

// The logical map of a warehouse (Sect. 2.2), as plain data: the content of a layout file and nothing derived.
struct Layout {
  std::string name;
  Vec2 floor_low_m = Vec2::Zero(), floor_high_m = Vec2::Zero();
  std::vector<Station> stations;
  std::vector<Segment> segments;
  std::vector<SegmentBlock> blocks{};
};

// One way to drive a segment: in one direction, with one end of the AGV first.
struct Lane {
  SegmentId segment;
  StationId from, to;
  Curve curve;            // tail first if the AGV drives backward
  std::vector<Arc> arcs;  // near the curve, to kBezierByArcs_m and kHeadingByArcs_rad: what control software is given
  double speed_limit_mps = 0.0;  // 0: no limit but the vehicle's own

  bool is_backward() const { return curve.is_tail_first(); }
  // Of the AGV's nose, at either end.
  Vec2 start_heading() const { return curve.pose_at(0.0).heading; }
  Vec2 end_heading() const { return curve.pose_at(curve.length_m()).heading; }
  // The same limits, with the top speed cut to the speed limit of the lane. `of_vehicle`: VehicleType::drive_with.
  MotionLimits limits(MotionLimits of_vehicle) const;
};

// A layout with what follows from it: the curves of its segments, and the lanes that leave each station. It is built
// once; all runs on the layout share it and do not change it.
class LogicalMap {
 public:
  explicit LogicalMap(const Layout& layout);

  const Layout& layout() const { return layout_; }
  std::uint64_t digest() const { return digest_; }  // of the layout's canonical bytes: canonical_bytes.hpp
  std::size_t station_count() const { return layout_.stations.size(); }
  std::size_t segment_count() const { return layout_.segments.size(); }
  const Station& station(StationId id) const { return layout_.stations[id.index()]; }
  const Segment& segment(SegmentId id) const { return layout_.segments[id.index()]; }

  // The lane on `segment` that leaves `from`; null if the segment cannot be driven from there. If it can be driven with
  // either end first, this is the way forward.
  const Lane* lane(SegmentId segment, StationId from) const;
  const Lane* backward_lane(SegmentId segment, StationId from) const;
  const std::vector<Lane>& lanes() const { return lanes_; }
  // The lanes that leave a station, as indices into lanes().
  const std::vector<std::uint32_t>& lanes_from(StationId station) const { return lanes_from_[station.index()]; }

 private:
  void add_lanes(const Lane& forward, Travel travel);

  Layout layout_;
  std::uint64_t digest_ = 0;
  std::vector<Lane> lanes_;                             // by segment; there, then back; each forward, then backward
  std::vector<std::vector<std::uint32_t>> lanes_from_;  // by station
};

// The curve of a segment in its forward direction, and arcs near it.
Curve segment_curve(const Layout& layout, const Segment& segment);
std::vector<Arc> segment_arcs(const Layout& layout, const Segment& segment);

}  // namespace fleetproof
