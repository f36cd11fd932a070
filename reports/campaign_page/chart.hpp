#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/markup/markup.hpp"

namespace fleetproof::html {

// Bars over equal steps. The heights are logarithmic, so that a single run stays visible beside a million; each bar has
// its count.
struct Bar {
  std::string label;  // below the bar; may be empty
  std::uint64_t count = 0;
  bool marked = false;  // another colour and an outline
};
struct BarChart {
  std::string label, x_name;
  std::vector<Bar> bars;
  std::optional<std::size_t> line_before;  // a dashed line before this bar
  std::string line_name;
};
Element draw(const BarChart& chart);

// Lines through points, each with its own colour and dashes, up to twelve of them, and with its number at its end.
// Two curves that coincide are drawn as alternating dashes. The axis of x is logarithmic. Requires: all values are
// finite, all x are above 0, and so are all y of a logarithmic axis.
struct ChartLine {
  std::string name;
  std::vector<std::pair<double, double>> points;
};
struct CurveChart {
  std::string label, x_name, y_name;
  std::vector<ChartLine> curves;
  bool y_logarithmic = false, steps = false;
  std::vector<std::pair<double, std::string>> levels;  // horizontal lines with a name
};
Element draw(const CurveChart& chart);
// A piece of the line of a curve after its number, for a legend.
Element draw_sample(std::size_t curve);

}  // namespace fleetproof::html
