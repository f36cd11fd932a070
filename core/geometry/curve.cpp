#include "core/geometry/curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/arc.hpp"

namespace fleetproof {
namespace {

void add_arcs(const Cubic& cubic, double from, double to, std::vector<CurvePart>& parts) {
  constexpr ArcTolerance kTolerance{1e-6, 5e-4};
  for (Arc& arc : biarc_chain(cubic.control_points_m(from, to), kTolerance)) {
    arc.start.position_m += cubic.origin_m;
    if (arc.length_m > 0.0) parts.emplace_back(arc);
  }
}

// Each part is about as long as it can be. Where the shortest is too long, arcs take its place.
std::vector<CurvePart> bezier_parts(const Cubic& cubic) {
  constexpr double kShortest = 0x1p-9, kShorter = 0.7;
  std::vector<CurvePart> parts;
  double from = 0.0, step = 1.0;
  while (from < 1.0) {
    const double to = from + 1.1 * step >= 1.0 ? 1.0 : from + step;
    if (const auto bend = Bend::of(cubic, from, to)) {
      parts.emplace_back(*bend);
      from = to;
      step /= kShorter;
    } else if (to - from > kShortest) {
      step = kShorter * (to - from);
    } else {
      add_arcs(cubic, from, to, parts);
      from = to;
    }
  }
  return parts;
}

}  // namespace

CurvePart::CurvePart(const Arc& arc)
    : length_m_(arc.length_m), most_{std::abs(arc.curvature_per_m), 0.0, 0.0}, shape_(arc) {}

CurvePart::CurvePart(const Bend& bend) : length_m_(bend.length_m()), most_(bend.most()), shape_(bend) {}

Pose CurvePart::pose_at(double s_m) const {
  if (const Arc* arc = std::get_if<Arc>(&shape_)) return arc->pose_at(s_m);
  return std::get<Bend>(shape_).pose_at(s_m);
}

Bending CurvePart::bending_at(double s_m) const {
  if (const Arc* arc = std::get_if<Arc>(&shape_)) return {arc->curvature_per_m, 0.0};
  return std::get<Bend>(shape_).bending_at(s_m);
}

CurvePart CurvePart::reversed() const {
  if (const Arc* arc = std::get_if<Arc>(&shape_)) return arc->reversed();
  return std::get<Bend>(shape_).reversed();
}

CurvePart CurvePart::moved(const Vec2& by_m) const {
  if (const Arc* arc = std::get_if<Arc>(&shape_))
    return Arc{{arc->start.position_m + by_m, arc->start.heading}, arc->length_m, arc->curvature_per_m};
  return std::get<Bend>(shape_).moved(by_m);
}

Curve::Curve(std::vector<CurvePart> parts) : parts_(std::move(parts)) {
  double length_m = 0.0;
  for (const CurvePart& part : parts_) ends_m_.push_back(length_m += part.length_m());
}

Curve Curve::chain(std::span<const Arc> arcs) { return Curve(std::vector<CurvePart>(arcs.begin(), arcs.end())); }

Curve Curve::straight(const Vec2& from_m, const Vec2& to_m) {
  const Vec2 way = to_m - from_m;
  const double length_m = way.norm();
  return Curve({Arc{{from_m, length_m > 0.0 ? Vec2(way / length_m) : Vec2(Vec2::UnitX())}, length_m, 0.0}});
}

Curve Curve::bezier(const Vec2& p0_m, const Vec2& p1_m, const Vec2& p2_m, const Vec2& p3_m) {
  const std::array<Vec2, 4> control_points_m{p0_m, p1_m, p2_m, p3_m};
  if (is_straight_bezier(control_points_m)) return straight(p0_m, p3_m);
  std::vector<CurvePart> parts = bezier_parts(Cubic::bezier(control_points_m));
  return parts.empty() ? straight(p0_m, p3_m) : Curve(std::move(parts));
}

Curve Curve::joined(std::span<const Curve> curves) {
  std::vector<CurvePart> parts;
  for (const Curve& curve : curves) parts.insert(parts.end(), curve.parts_.begin(), curve.parts_.end());
  return Curve(std::move(parts));
}

Pose Curve::pose_at(double s_m) const {
  if (parts_.empty()) return {};
  const double s = std::clamp(s_m, 0.0, length_m());
  const std::size_t part = parts_.size() == 1 ? 0 : part_at(s);
  Pose pose = parts_[part].pose_at(s - begin_m(part));
  if (tail_first_) pose.heading = -pose.heading;
  return pose;
}

Bending Curve::bending_in(std::size_t part, double s_m) const {
  return parts_[part].bending_at(std::clamp(s_m - begin_m(part), 0.0, parts_[part].length_m()));
}

std::size_t Curve::part_at(double s_m) const {
  const auto next = std::upper_bound(ends_m_.begin(), ends_m_.end() - 1, s_m);
  return static_cast<std::size_t>(next - ends_m_.begin());
}

Curve Curve::reversed() const {
  std::vector<CurvePart> parts;
  for (auto part = parts_.rbegin(); part != parts_.rend(); ++part) parts.push_back(part->reversed());
  Curve back(std::move(parts));
  back.tail_first_ = tail_first_;
  return back;
}

Curve Curve::tail_first() const {
  Curve same = *this;
  same.tail_first_ = true;
  return same;
}

Curve Curve::moved(const Vec2& by_m) const {
  std::vector<CurvePart> parts;
  for (const CurvePart& part : parts_) parts.push_back(part.moved(by_m));
  Curve there(std::move(parts));
  there.tail_first_ = tail_first_;
  return there;
}

}  // namespace fleetproof
