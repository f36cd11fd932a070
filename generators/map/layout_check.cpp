#include "generators/map/layout_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/tolerances.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/geometry/rotation.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

class Check {
 public:
  explicit Check(const Layout& layout) : layout_(layout) {}

  Problems run() {
    if (layout_.stations.empty()) add(ProblemKind::BadGeometry, "/stations", "a layout needs at least one station");
    names("stations", layout_.stations);
    names("segments", layout_.segments);
    names("blocks", layout_.blocks);
    for (std::size_t i = 0; i < layout_.stations.size(); ++i) {
      const Vec2 position_m = layout_.stations[i].position_m;
      if (!on_the_floor(position_m)) bad_number(fmt::format("/stations/{}/position_m", i), position_m);
      if (const auto& heading = layout_.stations[i].heading;
          heading && !(std::abs(heading->squaredNorm() - 1.0) <= kUnitVectorToTheLastDigits))
        add(ProblemKind::NumberOutOfRange, fmt::format("/stations/{}/heading", i), "a heading is a unit vector [x, y]");
    }
    floor();
    // A curve is only built from sound numbers.
    if (!problems_.empty()) return std::move(problems_);
    for (std::size_t i = 0; i < layout_.segments.size(); ++i) segment(i);
    return std::move(problems_);
  }

 private:
  void add(ProblemKind kind, std::string pointer, std::string sentence) {
    problems_.push_back({kind, std::move(pointer), std::move(sentence)});
  }

  void bad_number(std::string pointer, const Vec2& position_m) {
    add(ProblemKind::NumberOutOfRange, std::move(pointer),
        fmt::format("coordinates lie within {} m of the origin; [{}, {}] m does not: correct it", kLargestCoordinate_m,
                    position_m.x(), position_m.y()));
  }

  void floor() {
    const auto low = layout_.floor_low_m, high = layout_.floor_high_m;
    if (!on_the_floor(low)) bad_number("/floor_low_m", low);
    if (!on_the_floor(high)) bad_number("/floor_high_m", high);
    if (low.x() > high.x() || low.y() > high.y()) {
      add(ProblemKind::NumberOutOfRange, "/floor_high_m", "the floor's high corner must not be below its low corner");
    }
    if (!is_plain_utf8(layout_.name)) add(ProblemKind::BadName, "/name", "a name is UTF-8 without control characters");
  }

  template <class Named>
  void names(std::string_view what, const std::vector<Named>& all) {
    std::set<std::string_view> seen;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto pointer = [&] { return fmt::format("/{}/{}/name", what, i); };
      if (const char* fault = fault_of_name(all[i].name)) add(ProblemKind::BadName, pointer(), fault);
      if (!seen.insert(all[i].name).second) {
        add(ProblemKind::BadName, pointer(),
            fmt::format("two {} are named {}; rename one", what, in_quotes(all[i].name)));
      }
    }
  }

  void segment(std::size_t i) {
    const auto& s = layout_.segments[i];
    const auto pointer = fmt::format("/segments/{}", i);
    if (s.from.index() >= layout_.stations.size())
      return add(ProblemKind::UnknownReference, pointer + "/from", "there is no such station");
    if (s.to.index() >= layout_.stations.size())
      return add(ProblemKind::UnknownReference, pointer + "/to", "there is no such station");
    if (s.from == s.to)
      return add(ProblemKind::BadGeometry, pointer, "a segment leads from one station to another one");
    const auto& c = s.control_points_m;
    const auto off = std::ranges::find_if_not(c, on_the_floor);
    if (off != c.end()) return bad_number(pointer + "/control_points_m", *off);
    if (!c.empty() && c.size() % 3 != 2) {
      return add(ProblemKind::BadGeometry, pointer + "/control_points_m",
                 fmt::format("{} control points; a curve has 2, 5, 8, ...", c.size()));
    }
    properties(s, pointer);
    if (const auto fault = fault_of_curve(segment_curve(layout_, s)); !fault.empty())
      add(ProblemKind::BadGeometry, pointer, fault);
  }

  void properties(const Segment& s, const std::string& pointer) {
    const auto limit = [&](const char* key, double value, double low, double high, const char* sentence) {
      if (value != 0.0 && !(value >= low && value <= high))
        add(ProblemKind::NumberOutOfRange, pointer + "/" + key, sentence);
    };
    constexpr const char* kSpeedRange = "a speed limit is 0 (none), or 0.001 to 100 m/s";
    limit("speed_limit_mps", s.speed_limit_mps, kSlowest, kFastest, kSpeedRange);
    limit("back_speed_limit_mps", s.back_speed_limit_mps, kSlowest, kFastest, kSpeedRange);
    limit("width_m", s.width_m, 0.0, kWidestFloor_m, "a width is 0 (not known) to 100 m");
    if (s.back_speed_limit_mps > 0.0 && !s.bidirectional)
      add(ProblemKind::BadGeometry, pointer + "/back_speed_limit_mps", "this segment is driven one way alone");
    if (s.back_travel != Travel::Forward && !s.bidirectional)
      add(ProblemKind::BadGeometry, pointer + "/back_travel", "this segment is driven one way alone");
    for (std::size_t i = 0; i < s.permissions.size(); ++i) {
      const std::string& type = s.permissions[i].vehicle_type;
      const char* fault = type.empty() ? nullptr : fault_of_name(type);
      if (fault != nullptr) add(ProblemKind::BadName, fmt::format("{}/permissions/{}/vehicle_type", pointer, i), fault);
    }
    for (const std::uint32_t block : s.blocks) {
      if (block >= layout_.blocks.size())
        add(ProblemKind::UnknownReference, pointer + "/blocks", "there is no such block");
    }
  }

  const Layout& layout_;
  Problems problems_;
};

}  // namespace

Problems problems_of(const Layout& layout) { return Check(layout).run(); }

bool on_the_floor(const Vec2& p) {
  return std::abs(p.x()) <= kLargestCoordinate_m && std::abs(p.y()) <= kLargestCoordinate_m;
}

// For a Bezier curve with cusps or loops, a trial construction is simpler than a check of the numbers.
std::string fault_of_curve(const Curve& curve) {
  if (!(curve.length_m() >= kShortestSegment_m)) return "it has no length; move its stations apart or leave it out";
  const auto parts = curve.parts();
  double sharply_rad = 0.0;  // turned without a break more sharply than kSharpestBend_m
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool sharp = !(parts[i].most().per_m <= 1.0 / kSharpestBend_m);
    sharply_rad = sharp ? sharply_rad + parts[i].most().per_m * parts[i].length_m() : 0.0;
    if (!(sharply_rad <= kSharpBendTurns_rad)) {
      return "it bends more sharply than a radius of 5 cm; move its control points apart, or put a station there";
    }
    if (i == 0) continue;
    const double kink =
        std::abs(angle_between(parts[i - 1].pose_at(parts[i - 1].length_m()).heading, parts[i].pose_at(0.0).heading));
    if (kink > kKink_rad) {
      return fmt::format(
          "it has a kink of {:.3g} rad; align the control points beside the joint, or put a station there", kink);
    }
  }
  return "";
}

const char* fault_of_name(std::string_view name) {
  if (name.empty()) return "the name is empty";
  if (name.size() > 200) return "the name is longer than 200 bytes";
  if (!is_plain_utf8(name)) return "a name is UTF-8 without control characters";
  return nullptr;
}

double largest_kink_rad(const Segment& segment) {
  const auto& c = segment.control_points_m;
  double largest = 0.0;
  for (std::size_t joint = 2; joint + 1 < c.size(); joint += 3) {
    const Vec2 in = c[joint] - c[joint - 1], out = c[joint + 1] - c[joint];
    if (in.norm() < kNoHandle_m || out.norm() < kNoHandle_m) continue;
    largest = std::max(largest, std::abs(angle_between(in.normalized(), out.normalized())));
  }
  return largest;
}

void smooth_joints(Segment& segment) {
  auto& c = segment.control_points_m;
  for (std::size_t joint = 2; joint + 1 < c.size(); joint += 3) {
    const Vec2 in = c[joint] - c[joint - 1], out = c[joint + 1] - c[joint];
    const Vec2 both = in.normalized() + out.normalized();
    if (in.norm() < kNoHandle_m || out.norm() < kNoHandle_m || both.norm() < kNoHandle_m) continue;
    const Vec2 tangent = both.normalized();
    c[joint - 1] = c[joint] - tangent * in.norm();
    c[joint + 1] = c[joint] + tangent * out.norm();
  }
}

void fit_floor(Layout& layout, double margin_m) {
  Box box;
  for (const auto& station : layout.stations) box.add(station.position_m);
  for (const auto& segment : layout.segments) {
    for (const auto& point : segment.control_points_m) box.add(point);
  }
  if (layout.stations.empty()) box.add(Vec2(Vec2::Zero()));
  box = box.grown(margin_m);
  const Vec2 farthest_m = Vec2::Constant(kLargestCoordinate_m);
  layout.floor_low_m = box.low_m.cwiseMax(-farthest_m);
  layout.floor_high_m = box.high_m.cwiseMin(farthest_m);
}

bool has_fitted_floor(const Layout& layout) {
  Layout fitted = layout;
  fit_floor(fitted, kFloorMargin_m);
  return fitted.floor_low_m == layout.floor_low_m && fitted.floor_high_m == layout.floor_high_m;
}

}  // namespace fleetproof
