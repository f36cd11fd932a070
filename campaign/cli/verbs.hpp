#pragma once

#include <cstdint>
#include <string>

#include "campaign/cli/command_line.hpp"

// Each verb has one file with its options and its action.
namespace fleetproof::cli {

Action prepare_run(Options& options);
Action prepare_merge(Options& options);
Action prepare_missing(Options& options);
Action prepare_submit(Options& options);
Action prepare_report(Options& options);
Action prepare_replay(Options& options);
Action prepare_explain(Options& options);
Action prepare_findings(Options& options);
Action prepare_retest(Options& options);
Action prepare_shrink(Options& options);
Action prepare_simulate(Options& options);
Action prepare_generate(Options& options);
Action prepare_import(Options& options);
Action prepare_check(Options& options);
Action prepare_verify(Options& options);
Action prepare_plan(Options& options);
Action prepare_evidence(Options& options);
Action prepare_compare(Options& options);
Action prepare_sensitivity(Options& options);
Action prepare_new(Options& options);
Action prepare_list(Options& options);

// Writes the page of a run, as `replay DB RUN --html FILE` does, and prints nothing. Throws what that command reports.
void write_case_page(const std::string& archive_path, std::uint64_t run, const std::string& path);

}  // namespace fleetproof::cli
