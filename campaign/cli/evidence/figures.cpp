#include "campaign/cli/evidence/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fleetproof::cli {
void Figures::add(const std::string& name, double value) {
  if (std::isfinite(value)) {
    figures_.push_back({name, fmt::format("{:.10g}", value), fmt::format("{:.17g}", value)});
  } else {
    figures_.push_back(
        {name, std::isnan(value) ? "undefined" : fmt::format("{}infinite", value < 0 ? "-" : ""), "null"});
  }
}

void Figures::add(const std::string& name, std::uint64_t value) {
  figures_.push_back({name, fmt::format("{}", value), fmt::format("{}", value)});
}

void Figures::add(const std::string& name, bool value) {
  figures_.push_back({name, value ? "yes" : "no", value ? "true" : "false"});
}

void Figures::add(const std::string& name, const std::optional<std::uint64_t>& value) {
  value ? add(name, *value) : figures_.push_back({name, "none", "null"});
}

void Figures::add(const std::string& name, const std::optional<double>& value) {
  value ? add(name, *value) : figures_.push_back({name, "undefined", "null"});
}

std::string Figures::text() const {
  std::size_t width = 0;
  for (const Figure& figure : figures_) width = std::max(width, figure.name.size());
  std::string text;
  for (const Figure& figure : figures_) text += fmt::format("{:<{}}  {}\n", figure.name, width, figure.text);
  for (const Figures& row : rows_) {
    std::string line;
    for (const Figure& figure : row.figures_)
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", figure.name, figure.text);
    text += line + "\n";
  }
  return text;
}

std::string Figures::json_members(const std::string& indent) const {
  std::string text;
  const auto separate = [&] { text += text.empty() ? indent : ",\n" + indent; };
  for (const Figure& figure : figures_) {
    separate();
    text += fmt::format("\"{}\": {}", figure.name, figure.json);
  }
  if (rows_.empty()) return text;
  separate();
  text += "\"rows\": [";
  for (std::size_t i = 0; i < rows_.size(); ++i)
    text += fmt::format("{}\n{}  {{\n{}\n{}  }}", i == 0 ? "" : ",", indent, rows_[i].json_members(indent + "    "),
                        indent);
  return text + "\n" + indent + "]";
}

}  // namespace fleetproof::cli
