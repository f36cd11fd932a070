#include "core/scenario/layout.hpp"

#include "core/base/error.hpp"
#include "core/scenario/canonical_bytes.hpp"

namespace fleetproof {

Curve segment_curve(const Layout& layout, const Segment& segment) {
  const Vec2 from = layout.stations[segment.from.index()].position_m,
             to = layout.stations[segment.to.index()].position_m;
  const auto& c = segment.control_points_m;
  if (c.empty()) return Curve::straight(from, to);
  ensure(c.size() % 3 == 2, "a segment has 2, 5, 8, ... control points");
  std::vector<Curve> parts;
  Vec2 begin = from;
  for (std::size_t i = 0; i + 1 < c.size(); i += 3) {
    const Vec2 end = i + 2 < c.size() ? c[i + 2] : to;
    parts.push_back(Curve::bezier(begin, c[i], c[i + 1], end));
    begin = end;
  }
  return parts.size() == 1 ? parts[0] : Curve::joined(parts);
}

LogicalMap::LogicalMap(const Layout& layout)
    : layout_(layout), digest_(layout_digest(layout)), lanes_from_(layout.stations.size()) {
  for (std::size_t i = 0; i < layout_.segments.size(); ++i) {
    const auto& segment = layout_.segments[i];
    Curve forward = segment_curve(layout_, segment);
    if (segment.bidirectional) {
      Curve backward = forward.reversed();
      lanes_.push_back({SegmentId{i}, segment.from, segment.to, std::move(forward)});
      lanes_.push_back({SegmentId{i}, segment.to, segment.from, std::move(backward)});
    } else {
      lanes_.push_back({SegmentId{i}, segment.from, segment.to, std::move(forward)});
    }
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    lanes_from_[lanes_[i].from.index()].push_back(static_cast<std::uint32_t>(i));
}

const Lane* LogicalMap::lane(SegmentId segment, StationId from) const {
  for (const auto i : lanes_from_[from.index()]) {
    if (lanes_[i].segment == segment) return &lanes_[i];
  }
  return nullptr;
}

}  // namespace fleetproof
