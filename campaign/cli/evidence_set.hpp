#pragma once

#include <string>

#include "reports/campaign_page/html_report.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof::cli {

// Writes the evidence of a release as a folder: the results file, the files of programs, the campaign file, the
// layouts, a page that says how to repeat all of it, the page, the report as text, JSON and JUnit, the plan, the
// identity of all software, every run that is not folded, every violation and incident as CSV with a dictionary, the
// replay line of every failing run, the ledger of attempts and the session log, the checks of validity, and SHA256SUMS
// over all of it. The folder appears whole or not at all. Throws InputError if it is there already, EngineError if the
// program computes a known answer wrongly.
void write_evidence_set(const std::string& folder, const ArchiveReader& archive, const HtmlInput& input);

}  // namespace fleetproof::cli
