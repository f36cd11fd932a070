#include "generators/families/layout_builder.hpp"

#include <algorithm>

#include "generators/map/layout_check.hpp"

namespace fleetproof {
namespace {

Vec2 metres(PointMm p) { return {static_cast<double>(p.x) / 1000.0, static_cast<double>(p.y) / 1000.0}; }

}  // namespace

std::int64_t draw_between(Draws& draws, std::int64_t low, std::int64_t high, std::int64_t step) {
  return low + step * static_cast<std::int64_t>(draws.below(static_cast<std::uint32_t>((high - low) / step + 1)));
}

std::vector<std::uint32_t> draw_some(Draws& draws, std::size_t count, std::size_t wanted) {
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(i);
  const std::size_t chosen = std::min(wanted, count);
  for (std::size_t i = 0; i < chosen; ++i)
    std::swap(numbers[i], numbers[i + draws.below(static_cast<std::uint32_t>(count - i))]);
  numbers.resize(chosen);
  return numbers;
}

StationId LayoutBuilder::station(std::string name, PointMm at, Purposes purposes) {
  layout_.stations.push_back({std::move(name), metres(at), purposes});
  positions_.push_back(at);
  return StationId{layout_.stations.size() - 1};
}

void LayoutBuilder::straight(StationId from, StationId to, Way way) { segment(from, to, way, {}); }

void LayoutBuilder::s_bend(StationId from, StationId to, Way way) {
  const PointMm a = position(from), b = position(to);
  const std::int64_t middle = (a.x + b.x) / 2;
  segment(from, to, way, {{middle, a.y}, {middle, b.y}});
}

void LayoutBuilder::s_bend_along_y(StationId from, StationId to, Way way) {
  const PointMm a = position(from), b = position(to);
  const std::int64_t middle = (a.y + b.y) / 2;
  segment(from, to, way, {{a.x, middle}, {b.x, middle}});
}

void LayoutBuilder::quarter_bend(StationId from, PointMm corner, StationId to, Way way) {
  constexpr std::int64_t kPerMille = 552;  // of the way to the corner: 4/3 (sqrt 2 - 1)
  const auto towards_corner = [&](PointMm end) {
    return PointMm{end.x + (corner.x - end.x) * kPerMille / 1000, end.y + (corner.y - end.y) * kPerMille / 1000};
  };
  segment(from, to, way, {towards_corner(position(from)), towards_corner(position(to))});
}

void LayoutBuilder::travel(Travel there, Travel back) {
  layout_.segments.back().travel = there;
  layout_.segments.back().back_travel = back;
}

void LayoutBuilder::segment(StationId from, StationId to, Way way, std::vector<PointMm> control_points) {
  if (way == Way::Backward) {
    std::swap(from, to);
    std::ranges::reverse(control_points);
  }
  Segment made;
  made.name = layout_.stations[from.index()].name + "-" + layout_.stations[to.index()].name;
  made.from = from;
  made.to = to;
  made.bidirectional = way == Way::Both;
  for (const auto& point : control_points) made.control_points_m.push_back(metres(point));
  layout_.segments.push_back(std::move(made));
}

Layout LayoutBuilder::take() {
  fit_floor(layout_, kFloorMargin_m);
  return std::move(layout_);
}

}  // namespace fleetproof
