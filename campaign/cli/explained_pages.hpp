#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "campaign/cli/case_source.hpp"
#include "campaign/explain/explanation.hpp"
#include "reports/replay_page/explained.hpp"
#include "storage/records.hpp"

namespace fleetproof::cli {

// Which run an explanation is of: its campaign, its number, what its software did, and which of its failures.
std::string explained_name(const CampaignRecord& campaign, std::uint64_t run, const Outcome& outcome,
                           const std::string& failure);

// As pages have it. `of`: as explained_name; empty: of a scenario file.
web::ExplainedRun explained_run(const Explanation& explanation, const std::string& of);

// What `explain` found of a run is kept beside its results file, for its page.
std::string explained_path(const std::string& archive_path, std::uint64_t run, const std::string& failure);
void keep_explained(const std::string& path, const web::ExplainedRun& run);
// Empty if there is none, or if it is of another run; the reason is talked about.
web::ExplainedRun kept_explained(const std::string& path, const std::string& of);

// What in the shapes of the two bodies broke the distance in the smallest case (shape_sentences). Simulates it again.
std::vector<std::string> shapes_of(const FailingCase& failing, const CaseAgent& agent, const AgentPrograms& programs);

// Before the work: makes the folder. Throws InputError if its pages cannot be written.
void require_page_folder(const std::string& folder);

// Writes a page of the run, index.html, one of its smallest case, and one of each run that shows a sentence, beside the
// smallest case. Once the time is over, the runs that are left get none. Throws InputError.
void write_pages(const std::string& folder, const CaseSource& source, const AgentPrograms& programs,
                 const Explanation& explanation, const std::function<bool()>& is_over);

}  // namespace fleetproof::cli
