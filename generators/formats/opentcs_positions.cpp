#include "generators/formats/opentcs_positions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/outside_text.hpp"
#include "core/base/tolerances.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

// A set of positions is refuted if the curves are longer than with the other set by this factor. Larger: curves that
// belong to the plant are drawn with the drawing. At 1.0: a small difference between the sets decides by chance.
constexpr double kMuchLonger = 1.5;
// A half circle is 1.6 times as long as its chord, three quarters of a circle 3.3 times.
constexpr double kDetour = 4.0;
constexpr double kToleratedLength = 0.02;   // share by which a stored length may be wrong
constexpr double kStoredRounding_m = 1e-3;  // editors store whole millimetres, and 1 where there is none

struct CurveExtent {
  double curves_m = 0.0;
  const Segment* spot = nullptr;  // the first segment without length
};

CurveExtent extent_of(const Layout& layout) {
  CurveExtent extent;
  for (const auto& segment : layout.segments) {
    const Vec2 chord_m =
        layout.stations[segment.to.index()].position_m - layout.stations[segment.from.index()].position_m;
    if (segment.control_points_m.empty()) {
      if (extent.spot == nullptr && chord_m.norm() < kShortestSegment_m) extent.spot = &segment;
    } else {
      extent.curves_m += segment_curve(layout, segment).length_m();
    }
  }
  return extent;
}

bool is_on_a_spot(const Layout& layout, const Segment& segment) {
  return segment.control_points_m.empty() &&
         (layout.stations[segment.to.index()].position_m - layout.stations[segment.from.index()].position_m).norm() <
             kShortestSegment_m;
}

bool says_spot(const std::optional<double>& stored_m) { return stored_m && std::abs(*stored_m) < kShortestSegment_m; }

// How many stored lengths are those of the segments.
std::size_t fitting(const Layout& layout, const StoredLengths& stored_m) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < stored_m.size(); ++i) {
    if (stored_m[i] && fits(*stored_m[i], segment_curve(layout, layout.segments[i]).length_m())) ++count;
  }
  return count;
}

// Curves are only built from sound numbers. The check of the layout refuses the others.
bool is_sound(const Layout& layout) {
  return std::ranges::all_of(layout.stations, [](const Station& s) { return on_the_floor(s.position_m); }) &&
         std::ranges::all_of(layout.segments,
                             [](const Segment& s) { return std::ranges::all_of(s.control_points_m, on_the_floor); });
}

bool has_curves(const Layout& layout) {
  return std::ranges::any_of(layout.segments, [](const Segment& s) { return !s.control_points_m.empty(); });
}

// A model without curves: the plant, unless a path has no length there and has one in the drawing.
std::string settle_straight(Layout& layout, Layout& drawing, const StoredLengths& stored_m) {
  const auto* spot = extent_of(layout).spot;
  if (spot == nullptr || extent_of(drawing).spot != nullptr)
    return "no path is curved, so all have their positions of the plant";
  const auto name = [&](StationId end) { return in_quotes(layout.stations[end.index()].name); };
  const auto begin = fmt::format("in the plant, the points {} and {} of path {} are on one spot", name(spot->from),
                                 name(spot->to), in_quotes(spot->name));
  const std::size_t by_plant = fitting(layout, stored_m), by_drawing = fitting(drawing, stored_m);
  const auto fit =
      fmt::format("{} of {} stored lengths fit the plant and {} the drawing", by_plant, stored_m.size(), by_drawing);
  if (by_plant > by_drawing) return begin + ", but " + fit + ", so all have their positions of the plant";
  layout.stations = std::move(drawing.stations);
  return begin + ", and " + fit +
         ", so all have their positions of the drawing; correct these two, or ask for positions of the plant (import "
         "--positions plant, positions = \"plant\" in a campaign)";
}

}  // namespace

bool fits(double stored_m, double length_m) {
  return std::abs(stored_m - length_m) <= kToleratedLength * length_m + kStoredRounding_m;
}

std::string settle_positions(Layout& layout, const std::map<std::string, Vec2>& drawn_m, const StoredLengths& stored_m,
                             Positions wish) {
  if (!is_sound(layout)) return "";
  Layout drawing = layout;
  std::set<std::ptrdiff_t> on_a_path;
  for (const Segment& segment : layout.segments) {
    for (const StationId end : {segment.from, segment.to}) on_a_path.insert(static_cast<std::ptrdiff_t>(end.index()));
  }
  double farthest_m = 0.0;
  std::size_t elsewhere = 0, undrawn = 0, apart = 0;  // apart: on no path, and not drawn
  for (auto& station : drawing.stations) {
    const auto found = drawn_m.find(station.name);
    if (found == drawn_m.end()) {
      ++(on_a_path.contains(&station - drawing.stations.data()) ? undrawn : apart);
      continue;
    }
    const double off_m = (found->second - station.position_m).norm();
    farthest_m = std::max(farthest_m, off_m);
    elsewhere += off_m > kSameTrack_m ? 1 : 0;
    station.position_m = found->second;
  }
  if (elsewhere == 0) return "";
  const auto begin =
      fmt::format("{} of {} points stand elsewhere in the drawing than in the plant, by up to {:.2f} m; {}", elsewhere,
                  layout.stations.size(), farthest_m,
                  apart == 0 ? "" : fmt::format("{} points on no path are not drawn and keep the plant's; ", apart));
  const std::string undrawn_text = undrawn == 0 ? "" : fmt::format("{} points are not drawn; ", undrawn);
  if (wish == Positions::Plant) return begin + "all have their positions of the plant, as was asked for";
  if (wish == Positions::Drawing) {
    layout.stations = std::move(drawing.stations);
    return begin + undrawn_text + "all that are drawn have their positions of the drawing, as was asked for";
  }
  if (undrawn > 0)
    return begin + fmt::format("{} points are not drawn, so all have their positions of the plant{}", undrawn,
                               has_curves(layout)
                                   ? "; curves keep the control points of the drawing, which may not fit: "
                                     "draw these points"
                                   : "");
  if (!is_sound(drawing)) return begin + "the drawing is too large, so all have their positions of the plant";
  if (!has_curves(layout)) return begin + settle_straight(layout, drawing, stored_m);
  const CurveExtent plant = extent_of(layout), drawn = extent_of(drawing);
  const bool keep = drawn.curves_m > kMuchLonger * plant.curves_m;
  if (!keep) layout.stations = std::move(drawing.stations);
  return begin + fmt::format(
                     "the curves have {:.1f} m with the positions of the drawing and {:.1f} m with those of the "
                     "plant, so all have their positions of the {}",
                     drawn.curves_m, plant.curves_m, keep ? "plant" : "drawing");
}

std::optional<std::size_t> spot_with_length(const Layout& layout, const StoredLengths& stored_m) {
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    if (is_on_a_spot(layout, layout.segments[i]) && !says_spot(stored_m[i])) return i;
  }
  return std::nullopt;
}

JoinedSpots join_spots(Layout& layout, const StoredLengths& stored_m) {
  std::vector<std::size_t> first(layout.stations.size());  // of the stations that are one
  std::iota(first.begin(), first.end(), std::size_t{0});
  JoinedSpots joined;
  std::vector<std::string> pairs;
  std::set<std::size_t> undecided;  // stations that ask for several headings
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    const Segment& segment = layout.segments[i];
    if (!is_on_a_spot(layout, segment) || !says_spot(stored_m[i])) {
      joined.segments.push_back(i);
      continue;
    }
    const auto [kept, gone] = std::minmax(first[segment.from.index()], first[segment.to.index()]);
    if (kept == gone) continue;
    pairs.push_back(fmt::format("{} and {}", layout.stations[kept].name, layout.stations[gone].name));
    Station &station = layout.stations[kept], &other = layout.stations[gone];
    station.purposes = station.purposes | other.purposes;
    if (station.heading && other.heading && station.heading != other.heading) undecided.insert(kept);
    if (!station.heading) station.heading = other.heading;
    std::ranges::replace(first, gone, kept);
  }
  std::vector<Station> stations;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const bool is_first = first[i] == i;
    joined.station.push_back(is_first ? StationId{stations.size()} : joined.station[first[i]]);
    if (!is_first) continue;
    joined.stations.push_back(i);
    stations.push_back(std::move(layout.stations[i]));
    if (undecided.contains(i)) stations.back().heading.reset();
  }
  layout.stations = std::move(stations);
  std::vector<Segment> segments;
  for (const auto i : joined.segments) {
    Segment& segment = segments.emplace_back(std::move(layout.segments[i]));
    segment.from = joined.station[segment.from.index()];
    segment.to = joined.station[segment.to.index()];
  }
  layout.segments = std::move(segments);
  if (!pairs.empty())
    joined.sentence = fmt::format(
        "{} pairs of points are on one spot and joined by a path without length ({}); each pair is one station with "
        "the name of the first{}",
        pairs.size(), name_list(pairs, pairs.size()),
        undecided.empty() ? "" : "; where they ask for several orientations, an AGV stands as it arrives");
  return joined;
}

std::string detours_of(const Layout& layout) {
  if (!is_sound(layout)) return "";
  std::vector<std::string> names;
  for (const auto& segment : layout.segments) {
    if (segment.control_points_m.empty()) continue;
    const Vec2 chord_m =
        layout.stations[segment.to.index()].position_m - layout.stations[segment.from.index()].position_m;
    if (segment_curve(layout, segment).length_m() > kDetour * chord_m.norm()) names.push_back(segment.name);
  }
  if (names.empty()) return "";
  return fmt::format(
      "{} curves are more than {:g} times as long as the way between their points ({}); check their "
      "control points and the scale of the drawing",
      names.size(), kDetour, name_list(names));
}

}  // namespace fleetproof
