#include "generators/formats/opentcs_positions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

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

struct CurveExtent {
  double curves_m = 0.0;
  bool has_spots = false;  // a segment without length
};

CurveExtent extent_of(const Layout& layout) {
  CurveExtent extent;
  for (const auto& segment : layout.segments) {
    const Vec2 chord_m =
        layout.stations[segment.to.index()].position_m - layout.stations[segment.from.index()].position_m;
    if (segment.control_points_m.empty()) {
      extent.has_spots |= chord_m.norm() < kShortestSegment_m;
    } else {
      extent.curves_m += segment_curve(layout, segment).length_m();
    }
  }
  return extent;
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

}  // namespace

std::string settle_positions(Layout& layout, const std::map<std::string, Vec2>& drawn_m) {
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
  if (undrawn > 0)
    return begin + fmt::format("{} points are not drawn, so all have their positions of the plant{}", undrawn,
                               has_curves(layout)
                                   ? "; curves keep the control points of the drawing, which may not fit: "
                                     "draw these points"
                                   : "");
  if (!is_sound(drawing)) return begin + "the drawing is too large, so all have their positions of the plant";
  const CurveExtent plant = extent_of(layout), drawn = extent_of(drawing);
  if (!has_curves(layout)) {
    if (!plant.has_spots || drawn.has_spots)
      return begin + "no path is curved, so all have their positions of the plant";
    layout.stations = std::move(drawing.stations);
    return begin + "in the plant, two points of a path are on one spot, so all have their positions of the drawing";
  }
  const bool keep = drawn.curves_m > kMuchLonger * plant.curves_m;
  if (!keep) layout.stations = std::move(drawing.stations);
  return begin + fmt::format(
                     "the curves have {:.1f} m with the positions of the drawing and {:.1f} m with those of the "
                     "plant, so all have their positions of the {}",
                     drawn.curves_m, plant.curves_m, keep ? "plant" : "drawing");
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
