#include "reports/replay_page/clearance_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fleetproof::web {
namespace {

using html::Element;
using html::text_element;

constexpr double kChartWidth_px = 760, kChartHeight_px = 210, kChartLeft_px = 52, kChartRight_px = 16,
                 kChartTop_px = 14, kChartBottom_px = 34;
constexpr std::int64_t kMostShown_um = 2'000'000, kLead_us = 1'000'000;

double in_seconds(std::int64_t us) { return static_cast<double>(us) / 1e6; }

struct Scale {
  std::int64_t from_us = 0, to_us = 1, top_um = 1;

  double x(std::int64_t at_us) const {
    return kChartLeft_px + (kChartWidth_px - kChartLeft_px - kChartRight_px) * static_cast<double>(at_us - from_us) /
                               static_cast<double>(to_us - from_us);
  }
  double y(std::int64_t clearance_um) const {
    const double share = static_cast<double>(std::min(clearance_um, top_um)) / static_cast<double>(top_um);
    return kChartHeight_px - kChartBottom_px - (kChartHeight_px - kChartBottom_px - kChartTop_px) * share;
  }
};

// From a second before the curve comes into the chart.
Scale scale_of(const Film& film, const ClearanceCurve& curve) {
  Scale scale{curve.points.front().at_us, curve.points.back().at_us, 2 * film.safety_distance_um};
  for (const ClearancePoint& p : curve.points) scale.top_um = std::max(scale.top_um, p.clearance_um);
  const auto least = std::ranges::min_element(curve.points, {}, &ClearancePoint::clearance_um)->clearance_um;
  scale.top_um = std::min(scale.top_um, std::max({kMostShown_um, 2 * film.safety_distance_um, 2 * least}));
  const auto first = std::ranges::find_if(curve.points, [&](const auto& p) { return p.clearance_um <= scale.top_um; });
  if (first != curve.points.end()) scale.from_us = std::max(scale.from_us, first->at_us - kLead_us);
  scale.to_us = std::max(scale.to_us, scale.from_us + 1);
  return scale;
}

// The least step of 1, 2 or 5 times a power of ten with at most `most` of them in `span`.
double step_of(double span, int most) {
  double power = 1e-3;
  while (true) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (span / (power * factor) <= most) return power * factor;
    }
    power *= 10.0;
  }
}

Element note(const std::string& text, double x, double y, const char* anchor) {
  return text_element("text", text,
                      {{"x", x}, {"y", y}, {"text-anchor", anchor}, {"font-size", 11}, {"fill", "currentColor"}});
}

Element line(const std::string& path, const char* colour, double width, const char* dashes, const char* opacity) {
  return Element("path", {{"d", path},
                          {"fill", "none"},
                          {"stroke", colour},
                          {"stroke-width", width},
                          {"stroke-dasharray", dashes},
                          {"stroke-opacity", opacity}});
}

void add_axes(Element& svg, const Scale& scale) {
  const double from_s = in_seconds(scale.from_us), to_s = in_seconds(scale.to_us), step_s = step_of(to_s - from_s, 10);
  for (int i = 0; i <= 10; ++i) {
    const double at_s = (static_cast<int>(from_s / step_s) + i) * step_s;
    if (at_s < from_s - 1e-9 || at_s > to_s + 1e-9) continue;
    const double x = scale.x(static_cast<std::int64_t>(at_s * 1e6));
    svg.add(line(fmt::format("M{:.1f} {}V{}", x, kChartTop_px, kChartHeight_px - kChartBottom_px), "currentColor", 1,
                 "none", "0.1"));
    svg.add(note(fmt::format("{:g} s", at_s), x, kChartHeight_px - kChartBottom_px + 15.0, "middle"));
  }
  const double top_m = in_seconds(scale.top_um), step_m = step_of(top_m, 5);
  for (int i = 0; i * step_m <= top_m + 1e-9; ++i) {
    const double y = scale.y(static_cast<std::int64_t>(i * step_m * 1e6));
    svg.add(line(fmt::format("M{} {:.1f}H{}", kChartLeft_px, y, kChartWidth_px - kChartRight_px), "currentColor", 1,
                 "none", "0.1"));
    svg.add(note(fmt::format("{:g} m", i * step_m), kChartLeft_px - 6.0, y + 4.0, "end"));
  }
}

// What is above the chart is left out, so the line begins and ends at its upper edge.
std::string path_of(const ClearanceCurve& curve, const Scale& scale) {
  std::string path;
  const auto is_above = [&](std::size_t i) {
    return i >= curve.points.size() || curve.points[i].clearance_um > scale.top_um;
  };
  bool goes_on = false;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const ClearancePoint& p = curve.points[i];
    const bool is_shown = !is_above(i) || (i > 0 && !is_above(i - 1)) || !is_above(i + 1);
    if (is_shown)
      path += fmt::format("{}{:.1f} {:.1f}", goes_on ? "L" : "M", scale.x(p.at_us), scale.y(p.clearance_um));
    goes_on = is_shown;
  }
  return path;
}

// The episodes below the safety distance as fields from top to bottom.
void add_broken(Element& svg, const Film& film, const ClearanceCurve& curve, const Scale& scale) {
  for (const TooClose& v : film.violations) {
    if (v.a != curve.a || v.b != curve.b || v.first_us >= scale.to_us) continue;
    const double left = scale.x(std::max(v.first_us, scale.from_us)), right = scale.x(std::min(v.last_us, scale.to_us));
    svg.add(Element("rect", {{"x", left},
                             {"y", kChartTop_px},
                             {"width", std::max(1.5, right - left)},
                             {"height", kChartHeight_px - kChartBottom_px - kChartTop_px},
                             {"fill", "#c4562f"},
                             {"fill-opacity", "0.16"}}));
  }
}

}  // namespace

Element draw_clearance(const Film& film, std::size_t index) {
  const ClearanceCurve& curve = film.clearances[index];
  const Scale scale = scale_of(film, curve);
  const std::string names = film.bodies[curve.a].name + " and " + film.bodies[curve.b].name;
  const auto least = std::ranges::min_element(curve.points, {}, &ClearancePoint::clearance_um);
  const std::string words =
      fmt::format("{}: smallest clearance {:.3f} m at {:.3f} s", names,
                  in_seconds(std::max<std::int64_t>(0, least->clearance_um - least->clearance_um % 1000)),
                  in_seconds(least->at_us - least->at_us % 1000));
  Element svg("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                      {"role", "img"},
                      {"aria-label", words},
                      {"viewBox", fmt::format("0 0 {} {}", kChartWidth_px, kChartHeight_px)},
                      {"width", kChartWidth_px},
                      {"height", kChartHeight_px},
                      {"font-family", "system-ui, sans-serif"}});
  add_axes(svg, scale);
  add_broken(svg, film, curve, scale);
  const double limit = scale.y(film.safety_distance_um);
  svg.add(line(fmt::format("M{} {:.1f}H{}", kChartLeft_px, limit, kChartWidth_px - kChartRight_px), "#c4562f", 1.5,
               "6 4", "1"));
  svg.add(line(path_of(curve, scale), "#3f7fbf", 2, "none", "1"));
  svg.add(Element("circle", {{"cx", scale.x(least->at_us)},
                             {"cy", scale.y(std::max<std::int64_t>(0, least->clearance_um))},
                             {"r", 4},
                             {"fill", "#c4562f"}}));
  svg.add(Element("line", {{"class", "now"},
                           {"x1", -9},
                           {"x2", -9},
                           {"y1", kChartTop_px},
                           {"y2", kChartHeight_px - kChartBottom_px},
                           {"stroke", "currentColor"},
                           {"stroke-width", 1.5}}));
  Element figure("figure", {{"class", "clearance"},
                            {"data-curve", fmt::format("{}", index)},
                            {"data-from-us", fmt::format("{}", scale.from_us)},
                            {"data-to-us", fmt::format("{}", scale.to_us)},
                            {"data-left-px", kChartLeft_px},
                            {"data-right-px", kChartWidth_px - kChartRight_px}});
  return figure.add(text_element("figcaption", words)).add(svg);
}

}  // namespace fleetproof::web
