#include "reports/campaign_page/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fleetproof::html {
namespace {

constexpr double kHeight_px = 210.0, kTop_px = 24.0, kBottom_px = 44.0, kLeft_px = 64.0;
constexpr double kBar_px = 8.5, kPlotWidth_px = 450.0;
constexpr double kPlotBottom_px = kTop_px + kHeight_px;

struct LineLook {
  const char *colour, *dashes;
};
// The first six differ in lightness, too, for eyes that tell few colours apart. No two lines have the same dashes, for
// a print in grey.
constexpr std::array<LineLook, 12> kLooks{{{"#0072b2", "1 0"},
                                           {"#d55e00", "8 3"},
                                           {"currentColor", "2 3"},
                                           {"#cc79a7", "10 3 2 3"},
                                           {"#b98600", "16 4"},
                                           {"#4aa3d8", "4 4"},
                                           {"#5b6ee1", "10 3 2 3 2 3"},
                                           {"#c2403a", "16 3 5 3"},
                                           {"#808890", "2 7"},
                                           {"#9b4f96", "5 2 5 7"},
                                           {"#8a7444", "2 2 2 7"},
                                           {"#5aa9a0", "16 3 2 3 2 3 2 3"}}};
constexpr double kLine_px = 2.2, kTurn_px = 12.0;
constexpr double kDigit_px = 7.0, kLineOfText_px = 12.0, kSame_px = 1.0;

Element canvas(const std::string& label, double width) {
  return Element("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                         {"role", "img"},
                         {"aria-label", label},
                         {"class", "chart"},
                         {"width", width},
                         {"height", kPlotBottom_px + kBottom_px},
                         {"viewBox", fmt::format("0 0 {} {}", width, kPlotBottom_px + kBottom_px)},
                         {"font-family", "system-ui, sans-serif"},
                         {"font-size", 12}});
}

Element note(const std::string& text, double x, double y, const char* anchor, const char* weight = "400") {
  return text_element("text", text,
                      {{"x", x}, {"y", y}, {"fill", "currentColor"}, {"text-anchor", anchor}, {"font-weight", weight}});
}

Element thin_line(double x1, double y1, double x2, double y2, const char* opacity) {
  return Element(
      "line",
      {{"x1", x1}, {"y1", y1}, {"x2", x2}, {"y2", y2}, {"stroke", "currentColor"}, {"stroke-opacity", opacity}});
}

std::string power_text(int exponent) {
  if (exponent >= -4 && exponent <= 4) return fmt::format("{:g}", std::pow(10.0, exponent));
  return fmt::format("1e{}", exponent);
}

constexpr double kRoom = 0.2;  // decades below the lowest line

// An axis from `low` to `high`, both logarithms to base ten if it is logarithmic.
struct Axis {
  double low = 0.0, high = 1.0;
  bool logarithmic = true;
  double place(double value) const { return ((logarithmic ? std::log10(value) : value) - low) / (high - low); }
};

Axis axis_of(const CurveChart& chart, bool of_y) {
  Axis axis{0.0, 1.0, of_y ? chart.y_logarithmic : true};
  bool first = true;
  const auto take = [&](double value) {
    const double at = axis.logarithmic ? std::log10(value) : value;
    if (!std::isfinite(at)) return;  // an axis without an end has no marks
    axis.low = first ? at : std::min(axis.low, at);
    axis.high = first ? at : std::max(axis.high, at);
    first = false;
  };
  for (const auto& curve : chart.curves) {
    for (const auto& [x, y] : curve.points) take(of_y ? y : x);
  }
  if (of_y) {
    for (const auto& level : chart.levels) take(level.first);
  }
  // What lies on the lower end would be taken for the axis.
  const double lowest = axis.low;
  axis.low = axis.logarithmic ? std::floor(lowest) : 0.0;
  if (of_y && axis.logarithmic && lowest - axis.low < kRoom) axis.low -= kRoom;
  axis.high = axis.logarithmic ? std::ceil(axis.high) : axis.high * 1.1;
  if (axis.high <= axis.low) axis.high = axis.low + 1.0;
  return axis;
}

void add_frame(Element& svg, const CurveChart& chart, const Axis& x, const Axis& y) {
  for (int i = static_cast<int>(x.low); i <= static_cast<int>(x.high); ++i) {
    const double at = kLeft_px + kPlotWidth_px * (i - x.low) / (x.high - x.low);
    svg.add(thin_line(at, kTop_px, at, kPlotBottom_px, "0.15"))
        .add(note(power_text(i), at, kPlotBottom_px + 16.0, "middle"));
  }
  const double span = y.high - y.low, step = y.logarithmic ? 1.0 : std::max(1.0, std::ceil(span / 6.0));
  for (double value = std::ceil(y.low); value <= y.high + 1e-9; value += step) {
    const double at = kPlotBottom_px - kHeight_px * (value - y.low) / span;
    svg.add(thin_line(kLeft_px, at, kLeft_px + kPlotWidth_px, at, "0.15"));
    svg.add(note(y.logarithmic ? power_text(static_cast<int>(value)) : fmt::format("{:g}", value), kLeft_px - 8.0,
                 at + 4.0, "end"));
  }
  svg.add(note(chart.x_name, kLeft_px + kPlotWidth_px / 2.0, kPlotBottom_px + 36.0, "middle", "600"));
  svg.add(note(chart.y_name, 0.0, 12.0, "start", "600"));
}

std::string path_of(const ChartLine& curve, const Axis& x, const Axis& y, bool steps) {
  std::string path;
  for (const auto& [at, value] : curve.points) {
    const double px = kLeft_px + kPlotWidth_px * x.place(at), py = kPlotBottom_px - kHeight_px * y.place(value);
    if (!path.empty() && steps) path += fmt::format("H{:.1f}", px);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
  }
  return path;
}

// Where the curves end, in pixels, with the numbers of those that end there.
struct LineEnd {
  double x, y;
  std::string numbers;
};

// From the top to the bottom.
std::vector<LineEnd> ends_of(const CurveChart& chart, const Axis& x, const Axis& y) {
  std::vector<LineEnd> ends;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    if (chart.curves[i].points.empty()) continue;
    const auto& [at, value] = chart.curves[i].points.back();
    const LineEnd end{kLeft_px + kPlotWidth_px * x.place(at), kPlotBottom_px - kHeight_px * y.place(value),
                      std::to_string(i + 1)};
    const auto same = std::ranges::find_if(ends, [&](const LineEnd& known) {
      return std::abs(known.x - end.x) < kSame_px && std::abs(known.y - end.y) < kSame_px;
    });
    if (same == ends.end()) {
      ends.push_back(end);
    } else {
      same->numbers += ", " + end.numbers;
    }
  }
  std::ranges::stable_sort(ends, {}, &LineEnd::y);
  return ends;
}

double right_of(const LineEnd& end) { return end.x + 10.0 + kDigit_px * static_cast<double>(end.numbers.size()); }

// The numbers stand beside the ends, below each other where the ends are close.
void add_numbers(Element& svg, const std::vector<LineEnd>& ends) {
  double next_y = 0.0;
  for (const LineEnd& end : ends) {
    const double y = std::max(end.y + 4.0, next_y);
    svg.add(note(end.numbers, end.x + 8.0, y, "start", "600"));
    next_y = y + kLineOfText_px;
  }
}

// The dashes of a curve: its own, or its turn if other curves lie on it from end to end.
std::pair<std::string, double> dashes_of(const CurveChart& chart, std::size_t index) {
  std::size_t equal = 0, before = 0;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    if (chart.curves[i].points != chart.curves[index].points) continue;
    ++equal;
    before += i < index ? 1 : 0;
  }
  if (equal == 1) return {kLooks[index % kLooks.size()].dashes, 0.0};
  return {fmt::format("{} {}", kTurn_px, kTurn_px * static_cast<double>(equal - 1)),
          -kTurn_px * static_cast<double>(before)};
}

}  // namespace

Element draw(const BarChart& chart) {
  const double width = kLeft_px + kBar_px * static_cast<double>(chart.bars.size()) + 24.0;
  Element svg = canvas(chart.label, width);
  std::uint64_t most = 1;
  for (const Bar& bar : chart.bars) most = std::max(most, bar.count);
  const double decades = std::max(1.0, std::ceil(std::log10(static_cast<double>(most) + 1.0)));
  const auto top_of = [&](double count) {
    return kPlotBottom_px - kHeight_px * (0.06 + 0.94 * std::log10(count) / decades);
  };
  const double right = kLeft_px + kBar_px * static_cast<double>(chart.bars.size());
  for (int i = 0; i <= static_cast<int>(decades); ++i) {
    const double y = top_of(std::pow(10.0, i));
    svg.add(thin_line(kLeft_px, y, right, y, "0.15")).add(note(power_text(i), kLeft_px - 8.0, y + 4.0, "end"));
  }
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    const Bar& bar = chart.bars[i];
    const double x = kLeft_px + kBar_px * static_cast<double>(i);
    if (bar.count > 0) {
      const double y = top_of(static_cast<double>(bar.count));
      Element rect("rect", {{"x", x + 0.5},
                            {"y", y},
                            {"width", kBar_px - 1.5},
                            {"height", kPlotBottom_px - y},
                            {"fill", bar.marked ? "#c4562f" : "#5b86b3"}});
      svg.add(rect.add(text_element("title", fmt::format("{} runs", bar.count))));
    }
    if (!bar.label.empty()) svg.add(note(bar.label, x + kBar_px / 2.0, kPlotBottom_px + 16.0, "middle"));
  }
  svg.add(thin_line(kLeft_px, kPlotBottom_px, right, kPlotBottom_px, "0.6"));
  if (chart.line_before) {
    const double x = kLeft_px + kBar_px * static_cast<double>(*chart.line_before);
    svg.add(Element("line", {{"x1", x},
                             {"y1", kTop_px - 8.0},
                             {"x2", x},
                             {"y2", kPlotBottom_px},
                             {"stroke", "currentColor"},
                             {"stroke-width", 2},
                             {"stroke-dasharray", "5 3"}}));
    svg.add(note(chart.line_name, x + 6.0, kTop_px - 2.0, "start"));
  }
  svg.add(note(chart.x_name, kLeft_px + (right - kLeft_px) / 2.0, kPlotBottom_px + 36.0, "middle", "600"));
  return svg.add(note("runs", 0.0, 12.0, "start", "600"));
}

Element draw(const CurveChart& chart) {
  const Axis x = axis_of(chart, false), y = axis_of(chart, true);
  const auto ends = ends_of(chart, x, y);
  double right = kLeft_px + kPlotWidth_px + 24.0;
  for (const LineEnd& end : ends) right = std::max(right, right_of(end));
  Element svg = canvas(chart.label, right);
  add_frame(svg, chart, x, y);
  for (const auto& [value, name] : chart.levels) {
    const double at = kPlotBottom_px - kHeight_px * y.place(value);
    svg.add(thin_line(kLeft_px, at, kLeft_px + kPlotWidth_px, at, "0.8"))
        .add(note(name, kLeft_px + 6.0, at - 4.0, "start"));
  }
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    const auto [dashes, offset] = dashes_of(chart, i);
    svg.add(Element("path", {{"d", path_of(chart.curves[i], x, y, chart.steps)},
                             {"fill", "none"},
                             {"stroke", kLooks[i % kLooks.size()].colour},
                             {"stroke-width", kLine_px},
                             {"stroke-dasharray", dashes},
                             {"stroke-dashoffset", offset}}));
  }
  for (const LineEnd& end : ends)
    svg.add(Element("circle", {{"cx", end.x}, {"cy", end.y}, {"r", 3.0}, {"fill", "currentColor"}}));
  add_numbers(svg, ends);
  return svg;
}

Element draw_sample(std::size_t curve) {
  const auto& look = kLooks[curve % kLooks.size()];
  Element svg("svg",
              {{"xmlns", "http://www.w3.org/2000/svg"}, {"width", 76}, {"height", 14}, {"role", "presentation"}});
  svg.add(text_element("text", std::to_string(curve + 1),
                       {{"x", 16}, {"y", 12}, {"text-anchor", "end"}, {"fill", "currentColor"}, {"font-size", 12}}));
  return svg.add(Element("line", {{"x1", 22},
                                  {"y1", 8},
                                  {"x2", 74},
                                  {"y2", 8},
                                  {"stroke", look.colour},
                                  {"stroke-width", kLine_px},
                                  {"stroke-dasharray", look.dashes}}));
}

}  // namespace fleetproof::html
