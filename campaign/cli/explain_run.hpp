#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "campaign/cli/case_source.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/explain/explanation.hpp"

namespace fleetproof::cli {

struct ExplainLimits {
  std::optional<std::uint64_t> trials{};  // for the smallest case
  bool with_pages = false;                // a part of the time is left for pages
};

// Why a case fails, as far as the time allows.
Explanation explained(const ExplainLimits& limits, const CaseHost& host, const CaseSource& source, const WorkTime& time,
                      const FailingCase& original, WorkProgress& progress);

// Keeps it beside the results file, if the case is a run of one.
void keep_for_page(const CaseWords& words, const CaseSource& source, const Explanation& explanation);

// Finds out why a run of a campaign failed and keeps that, unless it is kept already. It takes 20 s of CPU time at
// most. A run that cannot be explained costs a note.
void explain_unless_kept(const std::string& archive, std::uint64_t run);

}  // namespace fleetproof::cli
