#include "reports/formats/text_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "reports/sections/page_builder.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kWidth = 118;  // of sentences
constexpr std::size_t kWidestTable = 140;
constexpr std::size_t kGap = 2;
constexpr std::size_t kMostTextRows = 500;

// In characters, not bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

// "%", "s" and "m" stay on the line of their figure.
bool is_unit(const std::string& text, std::size_t at) {
  const auto letter = [&](std::size_t i) {
    return i < text.size() && ((text[i] >= 'a' && text[i] <= 'z') || (text[i] >= 'A' && text[i] <= 'Z'));
  };
  return at < text.size() && std::string_view("%sm").find(text[at]) != std::string_view::npos && !letter(at + 1);
}

// Words in lines of at most kWidth; the first line starts with `first`, the others with as many blanks as `indent`
// says.
std::string wrapped(const std::string& text, const std::string& first, std::size_t indent) {
  std::string out, line = first;
  std::size_t start = 0;
  while (start < text.size()) {
    auto end = std::min(text.find(' ', start), text.size());
    while (end < text.size() && is_unit(text, end + 1)) end = std::min(text.find(' ', end + 1), text.size());
    const auto word = text.substr(start, end - start);
    if (width_of(line) + 1 + width_of(word) > kWidth && width_of(line) > indent) {
      out += line + "\n";
      line = std::string(indent, ' ');
    }
    line += (line.empty() || line.ends_with(' ') ? "" : " ") + word;
    start = end + 1;
  }
  return out + line + "\n";
}

void print(std::string& out, const Remark& remark, const std::string& first, std::size_t indent) {
  out += wrapped(remark.text, first, indent);
  if (!remark.command.empty()) out += std::string(indent, ' ') + "-> " + remark.command + "\n";
}

std::string aligned(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, width_of(text)), ' ');
  return right ? blanks + text : text + blanks;
}

std::vector<std::size_t> column_widths(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    auto width = width_of(table.columns[c].head);
    for (const auto& row : table.rows) width = std::max(width, width_of(row[c]));
    widths.push_back(width);
  }
  return widths;
}

// A table that is too wide gives up its first column: the name then stands on a line of its own above its rows.
void print(std::string& out, const Table& table) {
  const auto widths = column_widths(table);
  std::size_t all = 0;
  for (const auto width : widths) all += kGap + width;
  const bool grouped = all > kWidestTable;
  const auto print_row = [&](const auto& text_of) {
    std::string line;
    for (std::size_t c = grouped ? 1 : 0; c < table.columns.size(); ++c)
      line += std::string(kGap, ' ') + aligned(text_of(c), widths[c], table.columns[c].right_aligned);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  };
  print_row([&](std::size_t c) { return table.columns[c].head; });
  std::string group;
  for (const auto& row : table.rows) {
    if (grouped && row[0] != group) out += " " + row[0] + "\n";
    group = row[0];
    print_row([&](std::size_t c) { return row[c]; });
  }
}

std::string top_of(const Page& page) {
  std::string out = page.title + "\n\n";
  for (const auto& headline : page.headlines) {
    out += wrapped(headline.text, headline.word + " |", 4);
    for (const auto& detail : headline.details) print(out, detail, "    -", 6);
    out += "\n";
  }
  return out;
}

}  // namespace

// The head of the page, and the table that stands first.
std::string render_summary(const ReportInput& input) {
  const auto page = build_page(input, kMostTextRows);
  std::string out = top_of(page);
  if (const Table& gates = page.sections.front().table; !gates.columns.empty()) print(out, gates);
  return out + "\n";
}

std::string render_text(const ReportInput& input) {
  const auto page = build_page(input, kMostTextRows);
  std::string out = top_of(page);
  for (const auto& section : page.sections) {
    out += section.title + "\n" + std::string(width_of(section.title), '-') + "\n";
    if (!section.table.columns.empty()) print(out, section.table);
    for (const auto& remark : section.remarks) print(out, remark, "  *", 4);
    out += "\n";
  }
  return out;
}

}  // namespace fleetproof
