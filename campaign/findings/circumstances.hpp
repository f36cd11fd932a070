#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "campaign/run/case_run.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Figures of two AGVs that came too close: how long one had stood, how long ago it had heard of the other, how often
// it had driven. "Later" is the AGV that set off last. The failure needs none of them. But where agents say nothing of
// their own, they tell faults apart that need the same: who forgets parked AGVs drives into one that has stood for
// long. By name; empty if the failure is not of two AGVs. Requires: the run was made with Deliveries::Kept.
std::map<std::string, double> circumstances_of(const CaseRun& run, const Scenario& scenario);

// What never happened.
inline constexpr double kNever_s = 1e6;

// Of each figure five values, ascending, one from the middle of each fifth of some failures of one world.
inline constexpr std::size_t kCircumstanceValues = 5;
using Circumstances = std::map<std::string, std::vector<double>>;

// Empty: there are too few failures to tell.
Circumstances circumstances_of(std::span<const std::map<std::string, double>> failures);

// The figure that tells failures now from those before, with the medians of both: of two drawn at random, the one of
// now has more of it 19 times in 20, or less. Empty: there is none.
std::string told_apart_by(const Circumstances& before, const Circumstances& now);

// Of one world each, in the same order. Of half a mend, failures are left in some worlds only, and look there as
// before: they are told apart only if they are in every world of which enough is known. Empty: they are not.
std::string told_apart_by(std::span<const Circumstances> before, std::span<const Circumstances> now);

}  // namespace fleetproof
