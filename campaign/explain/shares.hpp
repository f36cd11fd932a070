#pragma once

#include <vector>

#include "campaign/explain/claim.hpp"

namespace fleetproof {

inline constexpr std::size_t kRunsPerShare = 59;

// How often the run fails in the same way with other draws: as it is, and with one thing changed at a time. The first
// is the run as it is. `small`: its smallest case, which may fail with the change although the run never does. If the
// time of the host is over, GivenUp is thrown, and `found` has those that were found until then.
void add_shares(CaseHost& host, const FailingCase& failing, const FailingCase& small, const FailurePattern& pattern,
                std::vector<Share>& found);

}  // namespace fleetproof
