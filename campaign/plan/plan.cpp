#include "campaign/plan/plan.hpp"

#include <algorithm>

namespace fleetproof {

std::vector<CellRecord> CampaignPlan::cells() const {
  std::vector<CellRecord> all;
  for (const LayoutFactor& layout : layouts) {
    for (const std::uint32_t fleet : fleet_sizes) {
      for (const FactorSpan one_loss : loss) {
        for (const FactorSpan outage : mean_outage_s) {
          for (const FactorSpan delay : delay_s) {
            for (const std::string& agent : agents) {
              all.push_back({static_cast<std::uint32_t>(all.size()), agent, layout.name, fleet, one_loss.from,
                             delay.from, outage.from, one_loss.to, delay.to, outage.to});
            }
          }
        }
      }
    }
  }
  return all;
}

std::uint64_t CampaignPlan::cell_count() const { return layouts.size() * fleet_sizes.size() * cells_per_world(); }

std::uint64_t CampaignPlan::cells_per_world() const {
  return loss.size() * mean_outage_s.size() * delay_s.size() * agents.size();
}

bool CampaignPlan::is_drawn() const {
  const auto drawn = [](const std::vector<FactorSpan>& factor) {
    return std::ranges::any_of(factor, &FactorSpan::is_drawn);
  };
  return drawn(loss) || drawn(delay_s) || drawn(mean_outage_s);
}

std::vector<std::string> CampaignPlan::probes_to_meet() const {
  if (required_probes) return *required_probes;
  if (kind == CampaignKind::Search) return {};
  return {"encounter", "negotiation?"};
}

}  // namespace fleetproof
