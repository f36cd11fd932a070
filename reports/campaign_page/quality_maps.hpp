#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/campaign_page/campaign_figures.hpp"
#include "reports/campaign_page/envelope_map.hpp"
#include "reports/campaign_page/factor_map.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::html {

// The maps of one agent over loss and delay, at the same values of all other factors.
struct QualityMaps {
  std::string title;  // "agent sound; outages of 0.5 s"
  FactorMap risk, throughput, safe_mode;
  std::optional<EnvelopeMap> envelope;
};

// Agents whose gates decide come first. In a search the shade of a risk is whether any run failed: its counts are not a
// sample. Conditions beyond the first 1000 are left out.
std::vector<QualityMaps> quality_maps(const ReportInput& input, const CampaignFigures& figures);

// The agents of the campaign, those whose gates decide first.
std::vector<std::string> agents_in_order(const Evidence& evidence);

}  // namespace fleetproof::html
