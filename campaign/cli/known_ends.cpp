#include "campaign/cli/known_ends.hpp"

#include "campaign/shrink/case_host.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {

std::vector<KnownEnd> known_ends(const Scenario& scenario, const std::string& program, const std::string& config,
                                 const CampaignPlan& plan, const AgentPrograms& known) {
  CaseHost host({program, config, plan.laws_left_out, plan.limits}, known, 1);
  if (auto ends = host.ends_in(scenario)) return *std::move(ends);
  throw InputError(program,
                   "this agent does not crash or hang at the same call twice, so the run cannot be watched; with "
                   "--in-process it runs in this process, whatever it does to it");
}

}  // namespace fleetproof::cli
