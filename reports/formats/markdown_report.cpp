#include "reports/formats/markdown_report.hpp"

#include <fmt/format.h>

#include "reports/sections/page_builder.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostMarkdownRows = 60;

// Text in Markdown. Names come from outside. They must not start a tag, link, column, code, formula or emphasis. "<= 2
// s" stays as it is.
std::string escaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool compares = c == '<' && (i + 1 == text.size() || text[i + 1] == '=' || text[i + 1] == ' ');
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<' && !compares) {
      out += "&lt;";
    } else {
      if (std::string_view("\\`*_|[]~$").find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

std::string code_block(const std::string& command, const std::string& indent) {
  return command.empty() ? "" : fmt::format("\n{0}```sh\n{0}{1}\n{0}```\n", indent, command);
}

void append(std::string& out, const Table& table) {
  for (const auto& column : table.columns) out += "| " + escaped(column.head) + " ";
  out += "|\n";
  for (const auto& column : table.columns) out += column.right_aligned ? "|---:" : "|---";
  out += "|\n";
  for (const auto& row : table.rows) {
    for (const auto& cell : row) out += "| " + escaped(cell) + " ";
    out += "|\n";
  }
  out += "\n";
}

void append(std::string& out, const std::vector<Remark>& remarks) {
  for (const auto& remark : remarks) out += "- " + escaped(remark.text) + "\n" + code_block(remark.command, "  ");
  out += "\n";
}

}  // namespace

std::string render_markdown(const ReportInput& input) {
  const auto page = build_page(input, kMostMarkdownRows);
  std::string out = "# " + escaped(page.title) + "\n\n";
  for (const auto& headline : page.headlines) {
    out += fmt::format("**{}**: {}\n\n", headline.word, escaped(headline.text));
    append(out, headline.details);
  }
  for (const auto& section : page.sections) {
    out += "## " + escaped(section.title) + "\n\n";
    if (!section.table.columns.empty()) append(out, section.table);
    append(out, section.remarks);
  }
  return out;
}

}  // namespace fleetproof
