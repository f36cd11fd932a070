#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/comparison/release_comparison.hpp"
#include "reports/page/page.hpp"

namespace fleetproof {

// How one agent of a campaign compares with a campaign before.
struct BaselineComparison {
  std::string agent, baseline_path;
  ComparisonRule rule;
  std::vector<Headline> baseline_head{};  // of the baseline's report; that of the other one stands on the page
  std::optional<Comparison> comparison;   // absent: the baseline has no agent to compare with
};

// A results file, and what stands at the head of its report beside the verdict.
struct ReleaseFile {
  const ArchiveReader& archive;
  std::string path;
  std::vector<Headline> head;
};

// One comparison for each agent of `now` that is under test: with the agent of the same name, or with the only one
// under test in the baseline.
std::vector<BaselineComparison> compare_with_baseline(const ReleaseFile& now, const ReleaseFile& baseline);

// What changed since the baseline, by agent and end point; the runs that newly fail, each with its replay line.
// Requires: there is a comparison.
Section comparison_section(const std::vector<BaselineComparison>& baseline, const std::string& archive_path);

}  // namespace fleetproof
