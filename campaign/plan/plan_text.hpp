#pragma once

#include <string>

#include "campaign/plan/plan.hpp"

namespace fleetproof {

// The plan as one canonical JSON text, and back: parse_plan(plan_text(p)) describes the same runs, bit for bit, and
// requires the same evidence.
std::string plan_text(const CampaignPlan& plan);
CampaignPlan parse_plan(const std::string& text);  // throws EngineError: only the archive holds such texts

}  // namespace fleetproof
