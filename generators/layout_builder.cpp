#include "generators/layout_builder.hpp"

#include "generators/layout_check.hpp"

namespace fleetproof {
namespace {

Vec2 metres(PointMm p) { return {static_cast<double>(p.x) / 1000.0, static_cast<double>(p.y) / 1000.0}; }

}  // namespace

std::int64_t draw_between(Draws& draws, std::int64_t low, std::int64_t high, std::int64_t step) {
  return low + step * static_cast<std::int64_t>(draws.below(static_cast<std::uint32_t>((high - low) / step + 1)));
}

StationId LayoutBuilder::station(std::string name, PointMm at, Purposes purposes) {
  layout_.stations.push_back({std::move(name), metres(at), purposes});
  positions_.push_back(at);
  return StationId{layout_.stations.size() - 1};
}

void LayoutBuilder::straight(StationId from, StationId to, Way way) { segment(from, to, way, false); }
void LayoutBuilder::s_bend(StationId from, StationId to, Way way) { segment(from, to, way, true); }

void LayoutBuilder::segment(StationId from, StationId to, Way way, bool bend) {
  if (way == Way::Backward) std::swap(from, to);
  Segment made;
  made.name = layout_.stations[from.index()].name + "-" + layout_.stations[to.index()].name;
  made.from = from;
  made.to = to;
  made.bidirectional = way == Way::Both;
  if (bend) {
    const PointMm a = position(from), b = position(to), middle{(a.x + b.x) / 2, 0};
    made.control_points_m = {metres({middle.x, a.y}), metres({middle.x, b.y})};
  }
  layout_.segments.push_back(std::move(made));
}

Layout LayoutBuilder::take() {
  fit_floor(layout_, 3.0);
  return std::move(layout_);
}

}  // namespace fleetproof
