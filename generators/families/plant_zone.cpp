#include "generators/families/plant_zone.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

struct Between {
  std::int64_t low, high, step;
};

std::int64_t draw(Draws& draws, const Between& normal, const Between& provoking, bool provoked) {
  const Between& range = provoked ? provoking : normal;
  return draw_between(draws, range.low, range.high, range.step);
}

}  // namespace

PlantKnobs draw_plant_knobs(Draws& draws, const PlantWish& wish) {
  const bool stress = wish.range == Range::Stress;
  // One draw for each, whatever is asked for, so that a plant with one knob turned is like the plant without it.
  const auto turned = [&](Provocation one) {
    const bool drawn = draws.below(2) == 0;
    return wish.provocation == one || (stress && drawn);
  };
  PlantKnobs k;
  k.all_mouths_cross = turned(Provocation::Crossing);
  const bool curves = turned(Provocation::CurveBesideLane), tight = turned(Provocation::TightGap),
             overhang = turned(Provocation::OverhangPass) && !tight;
  k.bottleneck = turned(Provocation::Bottleneck);
  k.four_way = turned(Provocation::FourWay);
  k.side_lanes_everywhere = curves;
  k.lane_gap = overhang ? draw_between(draws, 100, 150, 10) : draw(draws, {300, 600, 50}, {0, 120, 10}, tight);
  k.side_gap = draw(draws, {1200, 1700, 50}, {0, 300, 20}, curves);
  k.corner_radius = draw(draws, {2000, 3000, 50}, {1200, 1600, 50}, overhang);
  k.mouth_radius = draw_between(draws, 1500, 2200, 50);
  k.stop_pitch = draw(draws, {1000, 1500, 50}, {500, 1500, 50}, stress);
  k.aisle_rest = draw_between(draws, 2000, 3600, 100);
  k.corridor = draw_between(draws, 6000, 12000, 500);
  // Every second plant. The corridors say which, so that this takes no draw of its own.
  k.back_in = k.corridor >= 9'000 || wish.provocation == Provocation::BackIn;
  return k;
}

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
    const std::int64_t length = places[i + 1] - places[i], steps = (length + kLongestStep_mm - 1) / kLongestStep_mm;
    for (std::int64_t k = 1; k < steps; ++k) on_lane(lane, side, places[i] + length * k / steps);
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

namespace {

// Millimetres.
constexpr std::int64_t kBeforeStops = 1500;  // and behind them
constexpr std::int64_t kBend = 2500;         // along the lane, to change to the lane beside it
constexpr std::int64_t kBay = 2 * kBend + 2000;
constexpr std::int64_t kSpur = 3000;
constexpr std::int64_t kQueuePitch = 1800;
constexpr Purposes kDepot = Purposes(Purpose::Charging) | Purpose::Parking;

}  // namespace

std::int64_t ZoneShape::middle(const PlantKnobs& k) const {
  const std::int64_t stops = k.mouth_radius + 2 * kBeforeStops + most_stops * k.stop_pitch,
                     mouths = k.corner_radius + 2 * k.mouth_radius + lane_pitch(k) + 1000;
  return std::max(stops, mouths);
}

std::int64_t ZoneShape::height(const PlantKnobs& k) const {
  const std::int64_t stops = (has_bays ? kBay : 0) + k.mouth_radius + 3 * kBeforeStops + most_stops * k.stop_pitch,
                     mouths = k.corner_radius + 2 * k.mouth_radius + lane_pitch(k) + 1000;
  return middle(k) + std::max(stops, mouths);
}

PlantZone::PlantZone(LayoutBuilder& builder, Draws& draws, const PlantKnobs& knobs, const ZoneShape& shape,
                     std::string name, PointMm low)
    : builder_(builder),
      draws_(draws),
      knobs_(knobs),
      shape_(shape),
      name_(std::move(name)),
      low_(low),
      ring_(builder, name_, low,
            {shape.width(knobs), shape.height(knobs), knobs.corner_radius, shape.lane_pitch(knobs),
             shape.has_outer_lane}) {}

std::vector<std::int64_t> PlantZone::aisle_slots() const {
  std::vector<std::int64_t> slots;
  for (std::int64_t slot = 0; slot < shape_.slots; ++slot) {
    if (slot != shape_.free_slot) slots.push_back(slot);
  }
  return slots;
}

void PlantZone::build(const std::vector<std::uint32_t>& stops) {
  const auto slots = aisle_slots();
  const std::uint32_t certainly = draws_.below(static_cast<std::uint32_t>(slots.size()));
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const bool crosses = draws_.below(3) == 0 || knobs_.all_mouths_cross || i == certainly;
    aisle(slots[i], crosses, stops[2 * i], stops[2 * i + 1]);
  }
  if (knobs_.four_way && shape_.has_outer_lane) cross_aisle();
  spurs();
  if (shape_.has_outer_lane) side_lanes();
}

StationId PlantZone::next(StationId from, PointMm at, Purposes purposes, std::string_view letter) {
  const StationId made = builder_.station(fmt::format("{}.{}{}", name_, letter, ++numbered_), at, purposes);
  builder_.straight(from, made);
  return made;
}

// From the southern mouth to the northern one: stops, the middle, a bay to let others pass, stops.
void PlantZone::aisle(std::int64_t slot, bool crosses, std::uint32_t low_stops, std::uint32_t high_stops) {
  const std::int64_t place = shape_.slot_place(knobs_, slot), x = low_.x + place;
  const auto stops = [&](StationId last, std::int64_t y, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      last = next(last, {x, low_.y + y + i * knobs_.stop_pitch}, i % 2 == 0 ? Purpose::Storage : Purpose::Routing, "a");
    }
    return last;
  };
  const auto mouth = [&](PlantRing::Side side, std::int64_t at) {
    return ring_.mouth(side, at, PlantRing::Facing::Inside, knobs_.mouth_radius, crosses);
  };
  const std::int64_t middle = shape_.middle(knobs_);
  StationId last = stops(mouth(PlantRing::South, place), knobs_.mouth_radius + kBeforeStops, low_stops);
  if (knobs_.four_way && shape_.has_outer_lane)
    middles_.push_back(last = next(last, {x, low_.y + middle}, Purpose::Routing, "x"));
  std::int64_t y = middle + kBeforeStops;
  if (shape_.has_bays) {
    last = bay(last, slot, y);
    y += kBay + kBeforeStops;
  }
  last = stops(last, y, high_stops);
  builder_.straight(last, mouth(PlantRing::North, ring_.length(PlantRing::North) - place));
}

StationId PlantZone::bay(StationId from, std::int64_t slot, std::int64_t begin) {
  const std::int64_t x = low_.x + shape_.slot_place(knobs_, slot), y = low_.y + begin;
  const std::int64_t aside = draws_.below(2) == 0 ? knobs_.lane_pitch() : -knobs_.lane_pitch();
  const StationId low = next(from, {x, y}, Purpose::Routing, "b"),
                  high = next(low, {x, y + kBay}, Purpose::Routing, "b");
  const auto beside = [&](std::int64_t at) {
    return builder_.station(fmt::format("{}.b{}", name_, ++numbered_), {x + aside, at});
  };
  const StationId in = beside(y + kBend), out = beside(y + kBay - kBend);
  builder_.s_bend_along_y(low, in);
  builder_.straight(in, out);
  builder_.s_bend_along_y(out, high);
  return high;
}

// From the western side to the eastern one. It meets every aisle, and the free slot, at a station.
void PlantZone::cross_aisle() {
  const std::int64_t middle = shape_.middle(knobs_);
  const auto mouth = [&](PlantRing::Side side, std::int64_t at) {
    return ring_.mouth(side, at, PlantRing::Facing::Inside, knobs_.mouth_radius, false);
  };
  StationId last = mouth(PlantRing::West, ring_.length(PlantRing::West) - middle);
  std::size_t aisle = 0;
  for (std::int64_t slot = 0; slot < shape_.slots; ++slot) {
    if (slot == shape_.free_slot) {
      last = next(last, {low_.x + shape_.slot_place(knobs_, slot), low_.y + middle}, Purpose::Routing, "x");
    } else {
      builder_.straight(last, middles_[aisle]);
      last = middles_[aisle++];
    }
  }
  builder_.straight(last, mouth(PlantRing::East, middle));
}

// A dead end outwards.
void PlantZone::spur(StationId from, PointMm end, Purposes purposes, std::string_view letter) {
  next(from, end, purposes, letter);
  if (knobs_.back_in) builder_.travel(Travel::Backward, Travel::Forward);
}

void PlantZone::spur_of_ring(PlantRing::Side side, std::int64_t place, Purposes purposes, std::string_view letter) {
  spur(ring_.outermost(side, place), ring_.point(side, place, ring_.outer_line() + kSpur), purposes, letter);
}

// A dock opposite every aisle. A zone with one lane has no charger row, but a charger.
void PlantZone::spurs() {
  for (const auto slot : aisle_slots())
    spur_of_ring(PlantRing::South, shape_.slot_place(knobs_, slot), Purpose::Storage, "dock");
  if (!shape_.has_outer_lane) {
    const auto place = shape_.slot_place(knobs_, 0);
    spur_of_ring(PlantRing::North, ring_.length(PlantRing::North) - place, kDepot, "charge");
  }
}

// The northern side has a gap beside each slot. Side lanes leave the outer lane in one gap and return in a later one.
void PlantZone::side_lanes() {
  const std::int64_t slots = shape_.slots, street = shape_.free_slot < 0 ? slots : slots - 1 - shape_.free_slot;
  const std::int64_t charger_gaps = slots >= 2 && street != 0 && street != 1 ? 2 : 1, first = street == 0 ? 1 : 0;
  side_lane(first, charger_gaps, true);
  for (std::int64_t gap = first + charger_gaps; gap < slots; ++gap) {
    const bool drawn = draws_.below(2) == 0;
    if (gap != street && (drawn || knobs_.side_lanes_everywhere)) side_lane(gap, 1, false);
  }
}

// One way, along the outer lane. A charger row begins with places to queue.
void PlantZone::side_lane(std::int64_t first_gap, std::int64_t gaps, bool charges) {
  const auto place_of = [&](std::int64_t gap) {
    return shape_.slot_place(knobs_, gap) - shape_.slot_pitch(knobs_) / 2;
  };
  const std::int64_t begin = place_of(first_gap), end = place_of(first_gap + gaps),
                     pitch = charges ? kQueuePitch : knobs_.stop_pitch, line = ring_.outer_line() + knobs_.side_pitch();
  const std::int64_t count = std::min<std::int64_t>((end - begin - 2 * kBend) / pitch + 1, 8),
                     queue = charges ? std::max<std::int64_t>(count / 2, 1) : 0;
  StationId last = ring_.outermost(PlantRing::North, begin);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t place = begin + kBend + i * pitch;
    const Purposes purposes = !charges ? Purpose::Storage : i < queue ? Purpose::Parking : Purpose::Routing;
    const StationId stop = builder_.station(fmt::format("{}.{}{}", name_, charges ? "q" : "f", ++numbered_),
                                            ring_.point(PlantRing::North, place, line), purposes);
    if (i == 0) {
      builder_.s_bend(last, stop, Way::Forward);
    } else {
      builder_.straight(last, stop, Way::Forward);
    }
    if (charges && i >= queue)
      spur(stop, ring_.point(PlantRing::North, place, line + kSpur), Purpose::Charging, "charge");
    last = stop;
  }
  builder_.s_bend(last, ring_.outermost(PlantRing::North, end), Way::Forward);
}

StationId PlantZone::corridor(PlantRing::Side side, std::int64_t aside, bool crosses) {
  const std::int64_t slot_place = shape_.slot_place(knobs_, std::max<std::int64_t>(shape_.free_slot, 0)),
                     middle = shape_.middle(knobs_);
  const std::int64_t place = side == PlantRing::South   ? slot_place
                             : side == PlantRing::North ? ring_.length(side) - slot_place
                             : side == PlantRing::East  ? middle + aside
                                                        : ring_.length(side) - middle - aside;
  return ring_.mouth(side, place, PlantRing::Facing::Outside, knobs_.mouth_radius, crosses);
}

}  // namespace fleetproof
