#include "generators/families/plant_ring.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace fleetproof {
namespace {

constexpr std::int64_t kLongestStep_mm = 12'000;

}  // namespace

PlantRing::PlantRing(LayoutBuilder& builder, std::string name, PointMm low, const RingShape& shape)
    : builder_(builder), name_(std::move(name)), low_(low), shape_(shape) {}

PointMm PlantRing::point(Side side, std::int64_t place, std::int64_t outwards) const {
  const std::int64_t w = shape_.width, h = shape_.height;
  switch (side) {
    case South:
      return {low_.x + place, low_.y - outwards};
    case East:
      return {low_.x + w + outwards, low_.y + place};
    case North:
      return {low_.x + w - place, low_.y + h + outwards};
    case West:
      return {low_.x - outwards, low_.y + h - place};
  }
  return low_;
}

StationId PlantRing::on_lane(Lane lane, Side side, std::int64_t place) {
  auto& stations = stations_[lane][side];
  const auto found = stations.find(place);
  if (found != stations.end()) return found->second;
  auto name = fmt::format("{}.{}{}{}", name_, "senw"[side], lane == Inner ? "i" : "o", place / 10);
  return stations[place] = builder_.station(std::move(name), point(side, place, outwards(lane)));
}

StationId PlantRing::mouth(Side side, std::int64_t place, Facing facing, std::int64_t radius, bool crosses) {
  const bool inside = facing == Facing::Inside;
  const Lane near = inside ? Inner : outermost_lane();
  const std::int64_t at = inside ? -radius : outwards(near) + radius;
  const StationId made = builder_.station(fmt::format("{}.{}{}{}", name_, "senw"[side], inside ? "m" : "g", place / 10),
                                          point(side, place, at));
  join(near, side, place, radius, made);
  if (crosses && shape_.has_outer_lane) join(inside ? Outer : Inner, side, place, radius + shape_.lane_pitch, made);
  return made;
}

void PlantRing::join(Lane lane, Side side, std::int64_t place, std::int64_t reach, StationId mouth) {
  const std::int64_t ahead = lane == Outer ? reach : -reach;
  const PointMm corner = point(side, place, outwards(lane));
  builder_.quarter_bend(on_lane(lane, side, place - ahead), corner, mouth, Way::Forward);
  builder_.quarter_bend(mouth, corner, on_lane(lane, side, place + ahead), Way::Forward);
}

void PlantRing::connect() {
  connect(Inner);
  if (shape_.has_outer_lane) connect(Outer);
}

void PlantRing::divide(Lane lane, Side side) {
  std::vector<std::int64_t> places;
  for (const auto& [place, station] : stations_[lane][side]) places.push_back(place);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const std::int64_t stretch = places[i + 1] - places[i], steps = (stretch + kLongestStep_mm - 1) / kLongestStep_mm;
    for (std::int64_t k = 1; k < steps; ++k) on_lane(lane, side, places[i] + stretch * k / steps);
  }
}

void PlantRing::connect(Lane lane) {
  const Way way = lane == Outer ? Way::Forward : Way::Backward;
  const std::int64_t radius = shape_.corner_radius;
  for (const Side side : {South, East, North, West}) {
    on_lane(lane, side, radius);
    on_lane(lane, side, length(side) - radius);
    divide(lane, side);
    const auto& stations = stations_[lane][side];
    for (auto next = std::next(stations.begin()); next != stations.end(); ++next)
      builder_.straight(std::prev(next)->second, next->second, way);
  }
  for (const Side side : {South, East, North, West}) {
    const auto after = static_cast<Side>((side + 1) % 4);
    const std::int64_t out = outwards(lane);
    const PointMm here = point(side, length(side), out), there = point(after, 0, out);
    const PointMm corner = side % 2 == 0 ? PointMm{there.x, here.y} : PointMm{here.x, there.y};
    builder_.quarter_bend(stations_[lane][side].rbegin()->second, corner, stations_[lane][after].begin()->second, way);
  }
}

}  // namespace fleetproof
