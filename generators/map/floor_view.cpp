#include "generators/map/floor_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

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

}  // namespace fleetproof
