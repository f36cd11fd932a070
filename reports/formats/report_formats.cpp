#include "reports/formats/report_formats.hpp"

#include <array>

#include "reports/formats/json_report.hpp"
#include "reports/formats/junit_report.hpp"
#include "reports/formats/markdown_report.hpp"
#include "reports/formats/text_report.hpp"

namespace fleetproof {
namespace {

constexpr std::array<Entry<RenderReport>, 5> kFormats{{
    {"text", "for a terminal: verdicts first, then tables", render_text},
    {"summary", "for a terminal: the verdicts alone", render_summary},
    {"markdown", "for a CI summary: the same page, with shorter tables", render_markdown},
    {"junit", "for CI: one test case for each gate and finding", render_junit},
    {"json", "for programs: every cell and every figure in full", render_json},
}};

}  // namespace

std::span<const Entry<RenderReport>> report_formats() { return kFormats; }

}  // namespace fleetproof
