#pragma once

#include "reports/campaign_page/campaign_figures.hpp"
#include "reports/markup/markup.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::html {

// The parts of the page that consist of drawings.
Element map_part(const ReportInput& input, const CampaignFigures& figures);
Element clearance_part(const ReportInput& input, const CampaignFigures& figures);
Element effort_part(const ReportInput& input, const CampaignFigures& figures);

}  // namespace fleetproof::html
