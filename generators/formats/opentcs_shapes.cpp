#include "generators/formats/opentcs_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/tolerances.hpp"
#include "generators/formats/rounded_way.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

RoundedWay rounded(const Layout& layout, const Segment& segment, std::vector<Vec2> via_m) {
  via_m.insert(via_m.begin(), layout.stations[segment.from.index()].position_m);
  via_m.push_back(layout.stations[segment.to.index()].position_m);
  return round_corners(via_m);
}

std::vector<Vec2> turned_round(std::vector<Vec2> points_m) {
  std::ranges::reverse(points_m);
  return points_m;
}

}  // namespace

void OpenTcsShapes::bend(const DrawnPath& drawn, const Layout& layout, Segment& segment) {
  if (drawn.connection == "BEZIER" || drawn.connection == "BEZIER_3") {
    segment.control_points_m = drawn.control_points_m;
    const double kink_rad = largest_kink_rad(segment);
    if (kink_rad <= kKink_rad || kink_rad > kSmoothedKink_rad) return;
    smooth_joints(segment);
    aligned_.push_back(segment.name);
    largest_kink_rad_ = std::max(largest_kink_rad_, kink_rad);
  } else if (drawn.connection == "POLYPATH" && !drawn.control_points_m.empty()) {
    segment.control_points_m = rounded(layout, segment, drawn.control_points_m).control_points_m;
    polylines_.emplace(segment.name, Polyline{segment.from, drawn.control_points_m});
  } else if (drawn.connection == "DIRECT") {
    if (!drawn.control_points_m.empty()) straightened_["DIRECT with control points"].push_back(segment.name);
  } else {
    straightened_[drawn.connection].push_back(segment.name);
  }
}

void OpenTcsShapes::redraw(Layout& layout) const {
  for (Segment& segment : layout.segments) {
    const auto found = polylines_.find(segment.name);
    if (found == polylines_.end()) continue;
    const auto& [from, via_m] = found->second;
    segment.control_points_m =
        rounded(layout, segment, segment.from == from ? via_m : turned_round(via_m)).control_points_m;
  }
}

std::vector<std::string> OpenTcsShapes::sentences(const Layout& layout) const {
  std::vector<std::string> sentences, names;
  for (const auto& [connection, paths] : straightened_)
    sentences.push_back(fmt::format("{} paths are drawn as {}; here they are straight ({})", paths.size(), connection,
                                    name_list(paths)));
  double off_m = 0.0;
  for (const Segment& segment : layout.segments) {
    const auto found = polylines_.find(segment.name);
    if (found == polylines_.end()) continue;
    names.push_back(segment.name);
    off_m = std::max(off_m, rounded(layout, segment, found->second.via_m).off_m);
  }
  if (!names.empty())
    sentences.push_back(
        fmt::format("{} paths are drawn as POLYPATH ({}); here an arc leads round each corner, and passes by it at "
                    "{:.3f} m at most",
                    names.size(), name_list(names), off_m));
  if (!aligned_.empty())
    sentences.push_back(
        fmt::format("the curves of {} paths meet at an angle ({}) of up to {:.3f} rad; their control "
                    "points were aligned",
                    aligned_.size(), name_list(aligned_), largest_kink_rad_));
  return sentences;
}

}  // namespace fleetproof
