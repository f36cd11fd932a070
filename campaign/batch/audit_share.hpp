#pragma once

#include <cstdint>

#include "campaign/plan/plan.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Which runs of a campaign are audited: of each agent its first run, and one drawn run of every 1 / share. A pure
// function of the plan's seed and the run, so that the same runs are audited however the campaign is stopped, resumed
// or shared out.
class AuditShare {
 public:
  explicit AuditShare(const CampaignPlan& plan);

  // A run that hung is not audited: it would hang once more, for the whole limit.
  bool contains(const RunRecord& run) const;

 private:
  std::uint64_t seed_, agents_;
  std::uint64_t block_;  // one run of so many runs of an agent; 0: none
};

}  // namespace fleetproof
