#include "reports/campaign_page/factor_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/error.hpp"

namespace fleetproof::html {
namespace {

constexpr double kFieldHeight_px = 44.0, kMapLeft_px = 66.0, kMapTop_px = 26.0, kMapBottom_px = 46.0,
                 kMapRight_px = 10.0;
constexpr double kMapLetter_px = 7.9, kLeastField_px = 64.0;

struct Colour {
  double red, green, blue;
};
constexpr std::array<Colour, 5> kRisk{
    {{236, 241, 247}, {246, 239, 222}, {250, 221, 170}, {236, 158, 98}, {136, 26, 30}}};
constexpr std::array<Colour, 2> kThroughput{{{240, 244, 250}, {32, 92, 150}}};
constexpr std::array<Colour, 2> kSafeMode{{{243, 242, 247}, {92, 72, 140}}};

std::span<const Colour> stops(Ramp ramp) {
  switch (ramp) {
    case Ramp::Risk:
      return kRisk;
    case Ramp::Throughput:
      return kThroughput;
    case Ramp::SafeMode:
      return kSafeMode;
  }
  invariant_violated("a ramp has colours");
}

Colour colour_at(Ramp ramp, double shade) {
  const auto colours = stops(ramp);
  const double place = std::clamp(shade, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  const double part = place - static_cast<double>(below);
  const Colour &a = colours[below], &b = colours[below + 1];
  const auto mixed = [part](double from, double to) { return from + (to - from) * part; };
  return {mixed(a.red, b.red), mixed(a.green, b.green), mixed(a.blue, b.blue)};
}

std::string hex(const Colour& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(c.red), static_cast<int>(c.green),
                     static_cast<int>(c.blue));
}

bool is_dark(const Colour& c) { return 0.299 * c.red + 0.587 * c.green + 0.114 * c.blue < 140.0; }

double field_width(const FactorMap& map) {
  std::size_t longest = 0;
  for (const auto& field : map.fields) longest = std::max({longest, field.upper_line.size(), field.lower_line.size()});
  for (const auto& column : map.columns) longest = std::max(longest, column.size());
  return std::max(kLeastField_px, 14.0 + kMapLetter_px * static_cast<double>(longest));
}

Element hatching() {
  Element pattern("pattern", {{"id", "hatch"}, {"width", 8}, {"height", 8}, {"patternUnits", "userSpaceOnUse"}});
  pattern.add(Element("path", {{"d", "M0 8L8 0M-2 2L2 -2M6 10L10 6"}, {"stroke", "#888888"}, {"stroke-width", 1.2}}));
  return pattern;
}

Element middle_text(const std::string& text, double x, double y, const std::string& fill, const char* weight) {
  return text_element("text", text,
                      {{"x", x}, {"y", y}, {"fill", fill}, {"font-weight", weight}, {"text-anchor", "middle"}});
}

void add_field(Element& svg, const MapField& field, Ramp ramp, double x, double y, double width) {
  const auto colour = field.shade ? colour_at(ramp, *field.shade) : Colour{};
  svg.add(Element("rect", {{"x", x},
                           {"y", y},
                           {"width", width - 2.0},
                           {"height", kFieldHeight_px - 2.0},
                           {"fill", field.shade ? hex(colour) : "url(#hatch)"},
                           {"stroke", "#8a929c"},
                           {"stroke-width", 0.5}}));
  if (!field.shade && field.upper_line.empty()) return;
  std::string ink = "currentColor";
  if (field.shade) ink = is_dark(colour) ? "#ffffff" : "#1b1f24";
  const double centre = x + (width - 2.0) / 2.0;
  svg.add(middle_text(field.upper_line, centre, y + (field.lower_line.empty() ? 26.0 : 19.0), ink, "600"));
  if (!field.lower_line.empty()) svg.add(middle_text(field.lower_line, centre, y + 34.0, ink, "400"));
}

// Black within white: it stands out on every field and on every page.
void add_thick_line(Element& svg, double x1, double y1, double x2, double y2) {
  for (const auto& [colour, width] : {std::pair{"#ffffff", 6}, std::pair{"#111111", 3}}) {
    svg.add(Element("line", {{"x1", x1},
                             {"y1", y1},
                             {"x2", x2},
                             {"y2", y2},
                             {"stroke", colour},
                             {"stroke-width", width},
                             {"stroke-linecap", "round"}}));
  }
}

void add_axes(Element& svg, const FactorMap& map, double width, double bottom) {
  for (std::size_t c = 0; c < map.columns.size(); ++c) {
    const double x = kMapLeft_px + (static_cast<double>(c) + 0.5) * width - 1.0;
    svg.add(middle_text(map.columns[c], x, bottom + 16.0, "currentColor", "400"));
  }
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    const double y = bottom - (static_cast<double>(r) + 0.5) * kFieldHeight_px + 4.0;
    svg.add(text_element("text", map.rows[r],
                         {{"x", kMapLeft_px - 8.0}, {"y", y}, {"fill", "currentColor"}, {"text-anchor", "end"}}));
  }
  const double middle = kMapLeft_px + width * static_cast<double>(map.columns.size()) / 2.0;
  svg.add(middle_text(map.column_name, middle, bottom + 36.0, "currentColor", "600"));
  svg.add(text_element("text", map.row_name, {{"x", 0}, {"y", 12}, {"fill", "currentColor"}, {"font-weight", "600"}}));
}

}  // namespace

Element draw(const FactorMap& map) {
  ensure(map.fields.size() == map.columns.size() * map.rows.size(), "a map has a field for each pair");
  const double width = field_width(map), columns = static_cast<double>(map.columns.size());
  const double bottom = kMapTop_px + kFieldHeight_px * static_cast<double>(map.rows.size());
  const double full_width = kMapLeft_px + columns * width + kMapRight_px;
  Element svg("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                      {"role", "img"},
                      {"aria-label", map.label},
                      {"class", "map"},
                      {"width", full_width},
                      {"height", bottom + kMapBottom_px},
                      {"font-family", "system-ui, sans-serif"},
                      {"font-size", 12}});
  svg.add(hatching());
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
      add_field(svg, map.fields[r * map.columns.size() + c], map.ramp, kMapLeft_px + static_cast<double>(c) * width,
                bottom - static_cast<double>(r + 1) * kFieldHeight_px, width);
    }
  }
  add_axes(svg, map, width, bottom);
  const double x = kMapLeft_px + static_cast<double>(map.columns_in_contract) * width - 1.0;
  const double y = bottom - static_cast<double>(map.rows_in_contract) * kFieldHeight_px - 1.0;
  add_thick_line(svg, x, kMapTop_px - 4.0, x, bottom);
  add_thick_line(svg, kMapLeft_px, y, full_width - kMapRight_px + 4.0, y);
  return svg;
}

Element draw_ramp(Ramp ramp, const std::string& palest, const std::string& darkest) {
  constexpr int kSteps = 24;
  constexpr double kStep_px = 6.0;
  Element svg("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                      {"role", "img"},
                      {"aria-label", "colours from " + palest + " to " + darkest},
                      {"width", 340},
                      {"height", 20},
                      {"font-family", "system-ui, sans-serif"},
                      {"font-size", 12}});
  svg.add(text_element("text", palest, {{"x", 90}, {"y", 14}, {"fill", "currentColor"}, {"text-anchor", "end"}}));
  for (int i = 0; i < kSteps; ++i) {
    svg.add(Element("rect", {{"x", 98.0 + kStep_px * i},
                             {"y", 4},
                             {"width", kStep_px + 0.5},
                             {"height", 12},
                             {"fill", hex(colour_at(ramp, i / (kSteps - 1.0)))}}));
  }
  svg.add(text_element("text", darkest, {{"x", 106.0 + kStep_px * kSteps}, {"y", 14}, {"fill", "currentColor"}}));
  return svg;
}

}  // namespace fleetproof::html
