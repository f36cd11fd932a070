#include "generators/formats/opentcs_positions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

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

std::string settle_positions(Layout& layout, const std::map<std::string, Vec2>& drawn_m, Positions wish) {
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
  const CurveExtent plant = extent_of(layout), drawn = extent_of(drawing);
  if (!has_curves(layout)) {
    if (plant.spot == nullptr || drawn.spot != nullptr)
      return begin + "no path is curved, so all have their positions of the plant";
    const auto name = [&](StationId end) { return in_quotes(layout.stations[end.index()].name); };
    const auto reason = fmt::format(
        "in the plant, the points {} and {} of path {} are on one spot, so all have their positions of the "
        "drawing; correct these two, or ask for positions of the plant (import --positions plant, "
        "positions = \"plant\" in a campaign)",
        name(plant.spot->from), name(plant.spot->to), in_quotes(plant.spot->name));
    layout.stations = std::move(drawing.stations);
    return begin + reason;
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
