#pragma once

#include <string>

#include "campaign/plan/plan.hpp"

namespace fleetproof {

// The plan as one canonical JSON text, and back: parse_plan(plan_text(p)) describes the same runs, bit for bit, and
// requires the same evidence.
std::string plan_text(const CampaignPlan& plan);
// A plan for single scenarios has no cells.
enum class PlanCells : bool { Required, MayBeNone };
// Throws EngineError: only archives and other processes of this program hold such texts.
CampaignPlan parse_plan(const std::string& text, PlanCells cells = PlanCells::Required);

}  // namespace fleetproof
