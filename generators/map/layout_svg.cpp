#include "generators/map/layout_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/base/markup_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/round_step.hpp"

namespace fleetproof {
namespace {

constexpr double kWidth_px = 960.0, kMargin_px = 48.0, kHead_px = 44.0, kAxis_px = 36.0;
constexpr double kMostHeight_px = 4000.0;  // of the floor
constexpr double kLargestScale = 40.0;     // pixels per metre
constexpr double kNumberEvery_px = 36.0;

template <class... Args>
void add(std::string& text, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
  text += '\n';
}

}  // namespace

FloorView::FloorView(const Vec2& low_m, const Vec2& high_m, double foot_px)
    : low_m_(low_m), high_m_(high_m), foot_px_(foot_px) {
  const double wide_m = high_m.x() - low_m.x(), tall_m = high_m.y() - low_m.y();
  scale_ = std::min(
      {kLargestScale, (kWidth_px - 2.0 * kMargin_px) / std::max(1.0, wide_m), kMostHeight_px / std::max(1.0, tall_m)});
  left_px_ = 0.5 * (kWidth_px - wide_m * scale_);
}

Vec2 FloorView::pixel(const Vec2& p_m) const {
  return {left_px_ + (p_m.x() - low_m_.x()) * scale_, kHead_px + (high_m_.y() - p_m.y()) * scale_};
}

double FloorView::width_px() const { return kWidth_px; }
double FloorView::margin_px() const { return kMargin_px; }
double FloorView::foot_top_px() const { return kHead_px + std::max(1.0, high_m_.y() - low_m_.y()) * scale_ + kAxis_px; }

std::string FloorView::axes() const {
  const double step_m = round_step(kNumberEvery_px / scale_);
  const Vec2 top_left = pixel({low_m_.x(), high_m_.y()}), bottom_right = pixel({high_m_.x(), low_m_.y()});
  constexpr const char* kGroup = R"(<g stroke="#e4e4e0" font-size="11" fill="#555555">)";
  std::string text;
  add(text, "{}", kGroup);
  // "+ 0.0": there is no number "-0".
  for (double k = std::ceil(low_m_.x() / step_m); k * step_m <= high_m_.x(); ++k) {
    const double x = pixel({k * step_m, 0.0}).x();
    add(text, R"(<path d="M{:.2f} {:.2f}V{:.2f}"/>)", x, top_left.y(), bottom_right.y());
    add(text, R"(<text x="{:.2f}" y="{:.1f}" text-anchor="middle" stroke="none">{:.0f}</text>)", x,
        bottom_right.y() + 15.0, k * step_m + 0.0);
  }
  add(text, R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end" stroke="none">x in m</text>)", bottom_right.x(),
      bottom_right.y() + 30.0);
  add(text, "</g>\n{}", kGroup);
  for (double k = std::ceil(low_m_.y() / step_m); k * step_m <= high_m_.y(); ++k) {
    const double y = pixel({0.0, k * step_m}).y();
    add(text, R"(<path d="M{:.2f} {:.2f}H{:.2f}"/>)", top_left.x(), y, bottom_right.x());
    add(text, R"(<text x="{:.1f}" y="{:.2f}" text-anchor="end" stroke="none">{:.0f}</text>)", top_left.x() - 6.0,
        y + 4.0, k * step_m + 0.0);
  }
  add(text, R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end" stroke="none">y in m</text>)", top_left.x() - 6.0 + 36.0,
      top_left.y() - 6.0);
  text += "</g>";
  return text;
}

namespace {

constexpr double kFoot_px = 56.0;
constexpr double kArrowEvery_m = 12.0;
constexpr std::size_t kFewStations = 150;  // up to here every name is written

struct Look {
  Purpose purpose;
  const char* name;
  const char* colour;
};

// A station with several purposes shows the first purpose of this list. Colour-blind people can distinguish the
// colours, and shapes carry the same information.
constexpr Look kLooks[] = {{Purpose::Charging, "charging", "#e69f00"},
                           {Purpose::Parking, "parking", "#0072b2"},
                           {Purpose::Storage, "storage", "#009e73"},
                           {Purpose::Routing, "routing", "#777777"}};

const Look& look_of(const Station& station) {
  for (const auto& look : kLooks) {
    if (station.purposes.has(look.purpose)) return look;
  }
  return kLooks[3];
}

std::string shown(std::string_view name) { return escaped_for_markup(printable(name)); }

// The place of a name.
struct Written {
  Vec2 low_px, high_px;

  bool covers(const Written& o) const {
    return low_px.x() < o.high_px.x() && o.low_px.x() < high_px.x() && low_px.y() < o.high_px.y() &&
           o.low_px.y() < high_px.y();
  }
};

class Picture {
 public:
  Picture(const Layout& layout, const FloorView& view) : layout_(layout), view_(view), scale_(view.scale()) {}

  std::string draw(const OnFloor& on_floor) {
    add(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" )"
        R"(viewBox="0 0 {0:.0f} {1:.0f}" font-family="sans-serif">)",
        view_.width_px(), view_.height_px());
    const auto title = on_floor.title.empty() ? title_of_layout() : shown(on_floor.title);
    add("<title>{}</title>", title);
    add(R"(<rect width="{:.0f}" height="{:.0f}" fill="#ffffff"/>)", view_.width_px(), view_.height_px());
    add(R"(<text x="{:.0f}" y="22" font-size="16" fill="#222222">{}</text>)", view_.margin_px(), title);
    const Vec2 corner = pixel({layout_.floor_low_m.x(), layout_.floor_high_m.y()});
    const Vec2 size_px = scale_ * (layout_.floor_high_m - layout_.floor_low_m);
    add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="#f7f7f5" stroke="#cccccc"/>)", corner.x(),
        corner.y(), size_px.x(), size_px.y());
    text_ += view_.axes() + "\n" + on_floor.under_the_map;
    for (const auto& segment : layout_.segments) wide_floor(segment);
    for (const auto& segment : layout_.segments) lane(segment);
    for (const auto& segment : layout_.segments) {
      if (!segment.bidirectional) arrows(segment);
    }
    for (const auto& station : layout_.stations) {
      add("<g><title>{}</title>", shown(station.name));
      mark(look_of(station).purpose, pixel(station.position_m), radius_px());
      add("</g>");
    }
    text_ += on_floor.on_the_map;
    for (const auto& station : layout_.stations) label(station);
    scale_bar();
    legend();
    add("</svg>");
    return std::move(text_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  std::string title_of_layout() const {
    return fmt::format("{}: {} stations, {} segment{}", shown(layout_.name), layout_.stations.size(),
                       layout_.segments.size(), layout_.segments.size() == 1 ? "" : "s");
  }

  Vec2 pixel(const Vec2& p_m) const { return view_.pixel(p_m); }

  double radius_px() const { return std::clamp(0.28 * scale_, 4.0, 8.0); }

  std::string track(const Segment& segment) const {
    const Vec2 a = pixel(layout_.stations[segment.from.index()].position_m),
               b = pixel(layout_.stations[segment.to.index()].position_m);
    std::string path = fmt::format("M{:.1f} {:.1f}", a.x(), a.y());
    const auto& points = segment.control_points_m;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2 p = pixel(points[i]);
      path += fmt::format("{}{:.1f} {:.1f}", i % 3 == 0 ? "C" : " ", p.x(), p.y());
    }
    return path + fmt::format("{}{:.1f} {:.1f}", points.empty() ? "L" : " ", b.x(), b.y());
  }

  void wide_floor(const Segment& segment) {
    if (segment.width_m == 0.0) return;
    add(R"(<path d="{}" fill="none" stroke="#e3e6ea" stroke-width="{:.1f}" stroke-linecap="round"/>)", track(segment),
        segment.width_m * scale_);
  }

  void lane(const Segment& segment) {
    add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="{:.1f}"/>)", track(segment),
        segment.bidirectional ? "#9a9a9a" : "#c2410c", std::clamp(0.08 * scale_, 1.0, 2.5));
  }

  // Arrow heads stand a little beyond half-way, because crossing lanes usually cross at half-way. Long segments have
  // more of them. No arrow head is so near to a station that the mark of the station hides it.
  void arrows(const Segment& segment) {
    const Curve curve = segment_curve(layout_, segment);
    const double size_px = std::min(1.1 * radius_px(), 8.0);
    const int count = std::max(1, static_cast<int>(curve.length_m() / kArrowEvery_m));
    for (int i = 0; i < count; ++i) {
      const Pose pose = curve.pose_at(curve.length_m() * (i + 0.6) / count);
      const Vec2 ahead(pose.heading.x() * size_px, -pose.heading.y() * size_px),
          aside(-0.7 * ahead.y(), 0.7 * ahead.x());
      const Vec2 tip = pixel(pose.position_m) + ahead, left = tip - 2.0 * ahead + aside,
                 right = tip - 2.0 * ahead - aside;
      add(R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z" fill="#c2410c"/>)", tip.x(), tip.y(), left.x(),
          left.y(), right.x(), right.y());
    }
  }

  // Charging a triangle, parking a square, storage a diamond, routing a dot.
  void mark(Purpose purpose, const Vec2& at, double r) {
    const double x = at.x(), y = at.y();
    const char* colour = std::ranges::find(kLooks, purpose, &Look::purpose)->colour;
    const auto shape = [&](const char* path) { add(R"(<path d="{}" fill="{}" stroke="#ffffff"/>)", path, colour); };
    switch (purpose) {
      case Purpose::Charging:
        shape(fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", x, y - 1.3 * r, x + 1.2 * r, y + 0.9 * r,
                          x - 1.2 * r, y + 0.9 * r)
                  .c_str());
        break;
      case Purpose::Parking:
        shape(fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}Z", x - r, y - r, 2.0 * r, 2.0 * r, -2.0 * r).c_str());
        break;
      case Purpose::Storage:
        shape(fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", x, y - 1.3 * r, x + 1.3 * r, y,
                          x, y + 1.3 * r, x - 1.3 * r, y)
                  .c_str());
        break;
      case Purpose::Routing:
        add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}" fill="{}" stroke="#ffffff"/>)", x, y, 0.6 * r, colour);
        break;
    }
  }

  // Names stand to the upper right. On crowded maps, all names, or the names that would cover others, are tooltips
  // only.
  void label(const Station& station) {
    const Vec2 at = pixel(station.position_m);
    const double size_px = std::clamp(0.5 * scale_, 8.0, 11.0), r = radius_px();
    if (scale_ < 6.0) return;
    if (layout_.stations.size() > kFewStations) {
      const Vec2 low(at.x() + r, at.y() - r - size_px),
          high(low.x() + 0.6 * size_px * static_cast<double>(station.name.size()), at.y() - r);
      const Written written{low, high};
      if (std::ranges::any_of(written_, [&](const Written& other) { return written.covers(other); })) return;
      written_.push_back(written);
    }
    add(R"(<text x="{:.1f}" y="{:.1f}" font-size="{:.1f}" fill="#444444">{}</text>)", at.x() + r, at.y() - r, size_px,
        shown(station.name));
  }

  // A twelfth to a fifth of the width, unless the floor is small.
  void scale_bar() {
    const double length_m = round_step(view_.width_px() / 12.0 / scale_);
    const double x = view_.margin_px(), y = foot_px() + 32.0, end = x + length_m * scale_;
    add(R"(<path d="M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}V{1:.1f}" fill="none" stroke="#222222" stroke-width="1.5"/>)", x,
        y - 6.0, y, end);
    add(R"(<text x="{:.1f}" y="{:.1f}" font-size="12" fill="#222222">{:g} m</text>)", end + 6.0, y + 2.0, length_m);
  }

  void legend() {
    const double y = foot_px() + 28.0;
    double x = view_.width_px() - 540.0;
    for (const auto& look : kLooks) {
      mark(look.purpose, {x, y}, 7.0);
      add(R"(<text x="{:.1f}" y="{:.1f}" font-size="12" fill="#222222">{}</text>)", x + 14.0, y + 4.0, look.name);
      x += 90.0;
    }
    add(R"(<path d="M{0:.1f} {1:.1f}H{2:.1f}" stroke="#c2410c" stroke-width="2"/>)", x, y, x + 20.0);
    add(R"(<path d="M{0:.1f} {1:.1f}L{2:.1f} {3:.1f}L{2:.1f} {4:.1f}Z" fill="#c2410c"/>)", x + 20.0, y, x + 10.0,
        y - 5.0, y + 5.0);
    add(R"(<text x="{:.1f}" y="{:.1f}" font-size="12" fill="#222222">one-way</text>)", x + 26.0, y + 4.0);
    x += 90.0;
    add(R"(<path d="M{0:.1f} {1:.1f}H{2:.1f}" stroke="#9a9a9a" stroke-width="2"/>)", x, y, x + 20.0);
    add(R"(<text x="{:.1f}" y="{:.1f}" font-size="12" fill="#222222">two-way</text>)", x + 26.0, y + 4.0);
  }

  double foot_px() const { return view_.foot_top_px(); }

  const Layout& layout_;
  const FloorView& view_;
  std::vector<Written> written_;
  double scale_;
  std::string text_;
};

}  // namespace

FloorView view_of(const Layout& layout, double words_px) {
  return {layout.floor_low_m, layout.floor_high_m, kFoot_px + words_px};
}

double words_top_px(const FloorView& view) { return view.foot_top_px() + kFoot_px; }

std::string layout_svg(const Layout& layout) { return floor_svg(layout, view_of(layout), {}); }

std::string floor_svg(const Layout& layout, const FloorView& view, const OnFloor& on_floor) {
  return Picture(layout, view).draw(on_floor);
}

}  // namespace fleetproof
