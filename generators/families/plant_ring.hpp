#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "generators/families/layout_builder.hpp"

namespace fleetproof {

// Lengths in millimetres. The size is that of the inner lane, as if its corners were sharp.
struct RingShape {
  std::int64_t width = 0, height = 0, corner_radius = 0, lane_pitch = 0;
  bool has_outer_lane = true;
};

// The main aisle round a zone: an inner lane that runs clockwise and an outer one that runs counter-clockwise, so that
// traffic keeps to the right. Sides are counted counter-clockwise from the south; a place on a side is its distance
// from the corner where the side begins, in that direction.
class PlantRing {
 public:
  enum Side : std::uint8_t { South, East, North, West };
  enum class Facing : std::uint8_t { Inside, Outside };

  // `low` is the corner of South and West. Requires: the builder outlives the ring.
  PlantRing(LayoutBuilder& builder, std::string name, PointMm low, const RingShape& shape);

  std::int64_t length(Side side) const { return side % 2 == 0 ? shape_.width : shape_.height; }
  // A point beside the inner lane; `outwards` is negative within the ring.
  PointMm point(Side side, std::int64_t place, std::int64_t outwards) const;
  std::int64_t outer_line() const { return shape_.has_outer_lane ? shape_.lane_pitch : 0; }

  // The station on the lane that is nearer to the outside; made if it is not there.
  StationId outermost(Side side, std::int64_t place) { return on_lane(outermost_lane(), side, place); }

  // A station in front of which curves lead from the nearer lane in and out, and with `crosses` from the other lane as
  // well: these cross the nearer lane at places without a station.
  StationId mouth(Side side, std::int64_t place, Facing facing, std::int64_t radius, bool crosses);

  // Connects the stations of both lanes, with more of them where a stretch is long. Call it once, after everything that
  // adds stations.
  void connect();

 private:
  enum Lane : std::uint8_t { Inner, Outer };
  Lane outermost_lane() const { return shape_.has_outer_lane ? Outer : Inner; }
  std::int64_t outwards(Lane lane) const { return lane == Outer ? shape_.lane_pitch : 0; }
  StationId on_lane(Lane lane, Side side, std::int64_t place);
  void join(Lane lane, Side side, std::int64_t place, std::int64_t reach, StationId mouth);
  void connect(Lane lane);
  void divide(Lane lane, Side side);

  LayoutBuilder& builder_;
  std::string name_;
  PointMm low_;
  RingShape shape_;
  std::array<std::array<std::map<std::int64_t, StationId>, 4>, 2> stations_;  // by lane, side and place
};

}  // namespace fleetproof
