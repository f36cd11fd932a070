#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fleetproof {

// The content of a page for people, without a format. Every format prints the same words.

// A sentence, and a command that shows more about it, if there is one.
struct Remark {
  std::string text;
  std::string command;
};

// A line at the top of the page. `word` is the verdict, or a warning.
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

// What a section is about, for formats with an order of their own.
enum class SectionTopic : std::uint8_t {
  Gates,
  Plan,
  Groups,
  Conditions,
  Comparison,
  Coverage,
  Sensitivity,
  Audit,
  WeakPoints,
  Failures,
  Attempts,
  Provenance,
  Method
};

// A title, a table (if it has columns), and remarks.
struct Section {
  std::string title;
  Table table;
  std::vector<Remark> remarks;
  SectionTopic topic = SectionTopic::Gates;
};

struct Page {
  std::string title;
  std::vector<Headline> headlines;
  std::vector<Section> sections;
};

}  // namespace fleetproof
