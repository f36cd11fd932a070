#pragma once

#include <string>

#include "reports/attempts/attempt_history.hpp"
#include "reports/evidence/evidence.hpp"
#include "reports/page/page.hpp"

namespace fleetproof {

// How the evidence came about: the other attempts for the same release, when the plan was fixed, whether the data obey
// it, and how often somebody looked.
Section attempt_section(const AttemptHistory& history, const CampaignRecord& campaign, const Evidence& evidence);

// One sentence for the head of the page of a claim; empty for a search.
std::string attempts_headline(const AttemptHistory& history, const Evidence& evidence);

}  // namespace fleetproof
