#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "storage/archive_reader.hpp"

namespace fleetproof {

// A column of an exported table: its unit ("none" for words and counts of things), and what it holds.
struct CsvColumn {
  std::string name, unit, meaning;
};

// One row of a run: the run itself, or one of its parts.
struct CsvRow {
  const RunRecord& run;
  const CellRecord& cell;
  std::size_t ordinal = 0;  // of the part
};

// A table of the campaign as CSV (RFC 4180): a heading, then rows in order of run index.
struct CsvTable {
  std::string file, holds;  // "runs.csv", and what a row is
  std::string view;         // of the archive, whose columns have the same names and meanings
  std::vector<CsvColumn> columns;
  std::function<std::size_t(const RunRecord&)> rows_of;  // how many rows a run has
  std::function<std::vector<std::string>(const CsvRow&)> values;
};

// runs.csv, violations.csv, incidents.csv.
const std::vector<CsvTable>& csv_tables();

// A field in quotes where it needs them. A text that a spreadsheet would take for a formula gets an apostrophe.
std::string csv_field(const std::string& text);

void write_heading(std::ostream& out, const CsvTable& table);
void write_rows(std::ostream& out, const CsvTable& table, const RunRecord& run, const CellRecord& cell);
// The data dictionary: one row for each column of each table.
std::string csv_dictionary();

}  // namespace fleetproof
