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
  std::optional<Comparison> comparison;  // absent: the baseline has no agent to compare with
};

// One comparison for each agent of `archive` that is under test: with the agent of the same name, or with the only one
// under test in the baseline.
std::vector<BaselineComparison> compare_with_baseline(const ArchiveReader& archive, const std::string& archive_path,
                                                      const ArchiveReader& baseline, const std::string& baseline_path);

// What changed since the baseline, by agent and end point; the runs that newly fail, each with its replay line.
// Requires: there is a comparison.
Section comparison_section(const std::vector<BaselineComparison>& baseline, const std::string& archive_path);

}  // namespace fleetproof
