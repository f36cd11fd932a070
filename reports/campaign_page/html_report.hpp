#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "reports/campaign_page/campaign_figures.hpp"
#include "reports/markup/film_strip.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// A report with all that the page shows beside it.
struct HtmlInput {
  ReportInput report;
  html::CampaignFigures figures;
  std::map<std::uint64_t, html::FilmStrip> strips{};  // of failing runs, if the caller has simulated them again
  std::set<std::uint64_t> cases{};                    // failing runs with a page of their own beside this one
};

// The page of a failing run: "case-7.html".
std::string case_page_name(std::uint64_t run_index);

// Reads all runs of the archive, once. Throws as read_report_input does.
HtmlInput read_html_input(const ArchiveReader& archive, std::string archive_path);

// One page that needs no other file and no network. It is also well-formed XML.
std::string render_html(const HtmlInput& input);

}  // namespace fleetproof
