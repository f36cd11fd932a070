#include "generators/map/plant_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/outside_text.hpp"
#include "core/geometry/rectangle.hpp"
#include "generators/map/layout_check.hpp"

namespace fleetproof {
namespace {

constexpr double kShift_m = 100.0;        // shifts are multiples of this
constexpr double kMuchTooLong_m = 100.0;  // half of all segments are longer: AGVs of other sites stop every few metres
constexpr double kMuchTooShort_m = 0.1;   // half of all segments are shorter
constexpr double kMuchTooLarge_m = 5000.0;  // the plant is longer
constexpr double kMuchTooSmall_m = 1.5;     // the plant is shorter than an AGV
constexpr double kMuchTooFast_mps = 10.0;   // AGVs drive up to 3 m/s

Box box_of(const Layout& layout) {
  Box box;
  for (const auto& station : layout.stations) box.add(station.position_m);
  for (const auto& segment : layout.segments) {
    for (const auto& point : segment.control_points_m) box.add(point);
  }
  return box;
}

// To a centimetre.
std::string rounded_m(double value_m) { return fmt::format("{:g} m", std::round(value_m * 100.0) / 100.0); }

}  // namespace

PlantSize size_of(const Layout& layout) {
  PlantSize size;
  if (layout.stations.empty() || layout.segments.empty()) return size;
  const Box box = box_of(layout);
  size.extent_m = box.high_m - box.low_m;
  std::vector<double> lengths_m;
  for (const auto& segment : layout.segments) lengths_m.push_back(segment_curve(layout, segment).length_m());
  std::ranges::sort(lengths_m);
  size.shortest_m = lengths_m.front();
  size.longest_m = lengths_m.back();
  size.median_m = lengths_m[(lengths_m.size() - 1) / 2];
  for (const double length_m : lengths_m) size.all_m += length_m;
  return size;
}

std::string size_text(const PlantSize& size) {
  return fmt::format("{} x {}; segments of {} to {}, half of them up to {}, {} in all", rounded_m(size.extent_m.x()),
                     rounded_m(size.extent_m.y()), rounded_m(size.shortest_m), rounded_m(size.longest_m),
                     rounded_m(size.median_m), rounded_m(size.all_m));
}

std::string size_question(const PlantSize& size) {
  const double extent_m = size.extent_m.maxCoeff();
  const bool large = size.median_m > kMuchTooLong_m || extent_m > kMuchTooLarge_m;
  const bool small = size.median_m < kMuchTooShort_m || extent_m < kMuchTooSmall_m;
  if (!large && !small) return "";
  return fmt::format(
      "the plant is {} x {}, and half of its segments are {} {}: is the file in {}? Here its numbers are read in the "
      "unit of the format; correct them if so",
      rounded_m(size.extent_m.x()), rounded_m(size.extent_m.y()), large ? "longer than" : "shorter than",
      rounded_m(size.median_m),
      large ? "centimetres or millimetres" : "metres where millimetres or centimetres belong");
}

std::string speed_question(const Layout& layout) {
  const auto limit_mps = [](const Segment& s) { return std::max(s.speed_limit_mps, s.back_speed_limit_mps); };
  const auto fastest = std::ranges::max_element(layout.segments, {}, limit_mps);
  if (fastest == layout.segments.end() || limit_mps(*fastest) <= kMuchTooFast_mps) return "";
  return fmt::format(
      "{} segments have a speed limit above {:g} m/s, the highest of {:g} m/s at {}: is that in km/h or "
      "m/min? Here it is read in the unit of the format; correct it if so",
      std::ranges::count_if(layout.segments, [&](const Segment& s) { return limit_mps(s) > kMuchTooFast_mps; }),
      kMuchTooFast_mps, limit_mps(*fastest), in_quotes(fastest->name));
}

void shift_far_plant(Layout& layout, std::string_view source, std::vector<std::string>& warnings) {
  const auto is_near = [](const Segment& segment) {
    return std::ranges::all_of(segment.control_points_m, on_the_floor);
  };
  if (std::ranges::all_of(layout.stations, on_the_floor, &Station::position_m) &&
      std::ranges::all_of(layout.segments, is_near))
    return;
  const Box box = box_of(layout);
  if (!box.low_m.allFinite() || !((box.high_m - box.low_m).maxCoeff() <= kLargestCoordinate_m)) return;
  const Vec2 shift_m = (box.low_m / kShift_m).array().floor() * kShift_m;
  for (auto& station : layout.stations) station.position_m -= shift_m;
  for (auto& segment : layout.segments) {
    for (auto& point : segment.control_points_m) point -= shift_m;
  }
  warnings.push_back(fmt::format(
      "{}: coordinates reach ({:.0f}, {:.0f}) m, as UTM coordinates do; all are shifted by ({:.0f}, {:.0f}) m, which "
      "changes no distance",
      source, box.high_m.x(), box.high_m.y(), 0.0 - shift_m.x(), 0.0 - shift_m.y()));
}

}  // namespace fleetproof
