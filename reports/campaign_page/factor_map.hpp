#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reports/markup/markup.hpp"

namespace fleetproof::html {

enum class Ramp { Risk, Throughput, SafeMode };  // the colours of a map; none of them is green

// One field of a map. Without a shade there is no evidence: the field is hatched, whatever its text is.
struct MapField {
  std::string upper_line, lower_line;
  std::optional<double> shade;  // from 0 (palest) to 1 (darkest)
};

// A map of fields over two factors, with the first row at the bottom. Requires: fields.size() == columns x rows, row by
// row.
struct FactorMap {
  std::string label;  // what the map shows, for readers who do not see it
  std::string column_name, row_name;
  std::vector<std::string> columns, rows;
  std::vector<MapField> fields;
  std::size_t columns_in_contract = 0, rows_in_contract = 0;  // the thick lines stand behind them
  Ramp ramp = Ramp::Risk;
};
Element draw(const FactorMap& map);

// The colours from 0 to 1 with a text at each end.
Element draw_ramp(Ramp ramp, const std::string& palest, const std::string& darkest);

}  // namespace fleetproof::html
