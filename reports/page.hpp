#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reports/report.hpp"

namespace fleetproof {

// What a page for people says, before it gets a format: the same words in every format.

// A sentence, and the command that shows what it speaks of, if there is one.
struct Remark {
  std::string text;
  std::string command;
};

// What stands above everything else; `word` is the verdict, or a warning.
struct Headline {
  std::string word, text;
  std::vector<Remark> details;
};

struct Column {
  std::string head;
  bool right_aligned = true;
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;
};

// Title, table (if it has columns), then the remarks.
struct Section {
  std::string title;
  Table table;
  std::vector<Remark> remarks;
};

struct Page {
  std::string title;
  std::vector<Headline> headlines;
  std::vector<Section> sections;
};

// No table gets more than `most_rows` rows; what is left out is the least interesting, and is counted.
Page build_page(const ReportInput& input, std::size_t most_rows);

}  // namespace fleetproof
