#pragma once

#include <string>

#include "reports/comparison/release_comparison.hpp"

namespace fleetproof {

std::string comparison_text(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule);
std::string comparison_json(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule);

}  // namespace fleetproof
