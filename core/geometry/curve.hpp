#pragma once

#include <span>
#include <variant>
#include <vector>

#include "core/geometry/arc.hpp"
#include "core/geometry/bend.hpp"

namespace fleetproof {

// A part of a track: a line or an arc, or a part of a Bezier curve.
class CurvePart {
 public:
  CurvePart(const Arc& arc);    // NOLINT: an arc is a part
  CurvePart(const Bend& bend);  // NOLINT: a bend is a part

  double length_m() const { return length_m_; }
  const MostBending& most() const { return most_; }
  bool is_straight() const { return most_.per_m == 0.0; }
  Pose pose_at(double s_m) const;
  Bending bending_at(double s_m) const;
  CurvePart reversed() const;
  CurvePart moved(const Vec2& by_m) const;

 private:
  double length_m_ = 0.0;
  MostBending most_;
  std::variant<Arc, Bend> shape_;
};

// A track on the floor by arc length: parts joined without kinks (heading continuous to kKink_rad). Lines, arcs and
// Bezier curves are what they are, up to kAlongCurve_m: nothing is replaced by something simpler. A vehicle follows it
// nose first, or tail first: then the headings of its poses, which are those of the nose, point against the travel.
class Curve {
 public:
  Curve() = default;
  explicit Curve(std::vector<CurvePart> parts);

  static Curve straight(const Vec2& from_m, const Vec2& to_m);
  static Curve chain(std::span<const Arc> arcs);
  // A cubic Bezier curve. A straight one becomes a line, one without length an arc without length. Within a
  // millimetre of a point where it stands still (a cusp, a control point on an end), arcs stay within a micrometre and
  // half a milliradian of it.
  static Curve bezier(const Vec2& p0_m, const Vec2& p1_m, const Vec2& p2_m, const Vec2& p3_m);
  // Curves driven one after the other, nose first.
  static Curve joined(std::span<const Curve> curves);

  double length_m() const { return ends_m_.empty() ? 0.0 : ends_m_.back(); }
  Pose pose_at(double s_m) const;  // s clamped to [0, length]
  // Of two parts that meet at `s_m`, the later one counts.
  Bending bending_at(double s_m) const { return bending_in(part_at(s_m), s_m); }
  Bending bending_in(std::size_t part, double s_m) const;
  std::size_t part_at(double s_m) const;
  // Arc lengths at which one part ends and the next begins; the last is the whole length.
  std::span<const double> ends_m() const { return ends_m_; }
  std::span<const CurvePart> parts() const { return parts_; }
  bool is_straight() const { return parts_.size() == 1 && parts_[0].is_straight(); }
  bool is_tail_first() const { return tail_first_; }

  // The same track driven the other way, with the same end of the vehicle first.
  Curve reversed() const;
  // The same track driven the same way, tail first.
  Curve tail_first() const;
  Curve moved(const Vec2& by_m) const;

 private:
  double begin_m(std::size_t part) const { return part == 0 ? 0.0 : ends_m_[part - 1]; }

  std::vector<CurvePart> parts_;
  std::vector<double> ends_m_;
  bool tail_first_ = false;
};

}  // namespace fleetproof
