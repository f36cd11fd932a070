#include "campaign/plan/plan.hpp"

#include <algorithm>

#include "campaign/plan/factor_fields.hpp"

namespace fleetproof {
namespace {

// The lower and the upper bounds of a cell.
struct Corners {
  FactorValues lowest, highest;
};

// All combinations of the factors, in the order of their nesting.
std::vector<Corners> combinations(const CampaignPlan& plan) {
  auto slowest_first = kFactors;
  std::ranges::sort(slowest_first, {}, &FactorInfo::nesting);
  std::vector<Corners> all(1);
  for (const FactorInfo& factor : slowest_first) {
    std::vector<Corners> finer;
    for (const Corners& outer : all) {
      for (const FactorSpan span : plan.spans(factor.id)) {
        Corners& corners = finer.emplace_back(outer);
        corners.lowest[factor.id] = span.from;
        corners.highest[factor.id] = span.to;
      }
    }
    all = std::move(finer);
  }
  return all;
}

}  // namespace

std::vector<FactorSpan> CampaignPlan::spans(Factor factor) const {
  return factors[factor].empty() ? std::vector<FactorSpan>{factor_value(*this, factor)} : factors[factor];
}

std::vector<CellRecord> CampaignPlan::cells() const {
  const auto corners = combinations(*this);
  std::vector<CellRecord> all;
  for (const LayoutFactor& layout : layouts) {
    for (const std::uint32_t fleet : fleet_sizes) {
      for (const auto& [lowest, highest] : corners) {
        for (const AgentFactor& agent : agents)
          all.push_back({static_cast<std::uint32_t>(all.size()), agent.name, layout.name, fleet, lowest, highest});
      }
    }
  }
  return all;
}

std::vector<std::string> CampaignPlan::agent_names() const {
  std::vector<std::string> names;
  for (const AgentFactor& agent : agents) names.push_back(agent.name);
  return names;
}

std::uint64_t CampaignPlan::cell_count() const { return layouts.size() * fleet_sizes.size() * cells_per_world(); }

std::uint64_t CampaignPlan::cells_per_world() const {
  std::uint64_t cells = agents.size();
  for (const FactorInfo& factor : kFactors) cells *= spans(factor.id).size();
  return cells;
}

bool CampaignPlan::is_drawn() const {
  return std::ranges::any_of(factors.values, [](const std::vector<FactorSpan>& spans) {
    return std::ranges::any_of(spans, &FactorSpan::is_drawn);
  });
}

std::vector<std::string> CampaignPlan::probes_to_meet() const {
  if (required_probes) return *required_probes;
  if (kind == CampaignKind::Search) return {};
  return {"encounter", "negotiation?"};
}

}  // namespace fleetproof
