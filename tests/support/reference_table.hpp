#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace fleetproof::test {

// One row of a table in tests/vectors, by the names of its columns.
class ReferenceRow {
 public:
  ReferenceRow(const std::vector<std::string>& columns, const std::string& line) : line_(line) {
    const auto fields = split(line, ',');
    for (std::size_t i = 0; i < columns.size(); ++i) fields_[columns[i]] = fields.at(i);
  }
  bool knows(const std::string& column) const { return fields_.contains(column); }
  bool has(const std::string& column) const { return !fields_.at(column).empty(); }
  const std::string& text(const std::string& column) const { return fields_.at(column); }
  double operator[](const std::string& column) const { return std::stod(fields_.at(column)); }
  std::uint64_t count(const std::string& column) const { return std::stoull(fields_.at(column)); }
  std::vector<double> list(const std::string& column) const {
    std::vector<double> values;
    for (const std::string& value : split(fields_.at(column), '|')) values.push_back(std::stod(value));
    return values;
  }
  const std::string& line() const { return line_; }

  static std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream in(text + separator);
    for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
    return parts;
  }

 private:
  std::string line_;
  std::map<std::string, std::string> fields_;
};

inline std::vector<ReferenceRow> reference_rows(const std::string& name) {
  const std::string file = std::string(FLEETPROOF_SOURCE_DIR) + "/tests/vectors/" + name + ".csv";
  std::ifstream in(file);
  std::string line;
  EXPECT_TRUE(std::getline(in, line)) << file;
  const auto columns = ReferenceRow::split(line, ',');
  std::vector<ReferenceRow> rows;
  while (std::getline(in, line)) rows.emplace_back(columns, line);
  EXPECT_FALSE(rows.empty()) << file;
  return rows;
}

inline void expect_close(double actual, double expected, const std::string& where, double relative = 1e-10) {
  EXPECT_LE(std::abs(actual - expected), relative * std::abs(expected))
      << actual << " for " << expected << " in " << where;
}
inline void expect_close(double actual, const ReferenceRow& row, const std::string& column) {
  expect_close(actual, row[column], column + " of " + row.line());
}

}  // namespace fleetproof::test
