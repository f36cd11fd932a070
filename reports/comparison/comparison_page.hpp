#pragma once

#include <string>

#include "reports/comparison/release_comparison.hpp"

namespace fleetproof {

// Which worlds were compared, or why that says nothing. No full stop.
std::string worlds_text(const Comparison& comparison);

std::string comparison_text(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule);
std::string comparison_json(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule);

}  // namespace fleetproof
