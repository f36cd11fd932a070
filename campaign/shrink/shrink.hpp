#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "campaign/shrink/trials.hpp"

namespace fleetproof {

// How much there is of a scenario. `deliveries`: of single messages; not counted while the radio draws them.
struct CaseSize {
  std::size_t agvs = 0, computers = 0, transports = 0, faults = 0, obstacles = 0, segments = 0, deliveries = 0;
  bool deliveries_are_drawn = true;
  Duration horizon{};
  static CaseSize of(const Scenario& scenario);
  // How hard it is to see through, in adverse messages: each AGV beyond the third is as hard as four. While deliveries
  // are drawn, more than any list of them.
  std::size_t price() const;
  // By the price, then by the number of things, then by the time.
  bool is_smaller_than(const CaseSize& other) const;
};

// The smallest case that was found. `one_minimal`: each single AGV, computer, transport, fault, obstacle, segment and
// message delivery was taken away once, and the failure was another one or none. Otherwise `why_not` says why that is
// not known.
struct ShrinkResult {
  FailingCase best;
  CaseSize before, after;
  std::uint64_t trials = 0;  // that one worker would have made
  bool one_minimal = false;
  bool ended = false;  // by a limit: a longer search may find a smaller case
  std::string why_not;
};

// Hears of each smaller case, with the pass that found it.
using OnSmaller = std::function<void(const FailingCase& smaller, std::string_view pass)>;

// Makes a failing scenario smaller as long as it fails in the same way: fewer AGVs, fewer losses and delays on the
// radio, fewer transports, faults and obstacles, a smaller plant, a shorter run, simpler numbers. The result is the
// same for any number of workers, unless the time of the host ends the work: then it is the smallest case so far.
// Requires: `original` fails as it says, and shows the pattern.
ShrinkResult shrink(CaseHost& host, TrialCache& cache, const FailingCase& original, const FailurePattern& pattern,
                    const TrialLimits& limits, const OnSmaller& on_smaller);

}  // namespace fleetproof
