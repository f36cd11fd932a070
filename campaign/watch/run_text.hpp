#pragma once

#include <string>
#include <string_view>

#include "core/outcome/outcome.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"
#include "laws/comparison.hpp"

namespace fleetproof {

// The name as it is in the scenario, with every character. The caller passes it through printable() before it prints
// it. Of a fallen load: `load_of` and the AGV that dropped it.
std::string body_name(const Scenario& scenario, EntityId id, std::string_view load_of = "load dropped by ");
// The same, printable.
std::string shown_name(const Scenario& scenario, EntityId id);

// Where the accusations of a published rule differ from those of safety-distance.
std::string differences_text(const Scenario& scenario, const std::vector<Difference>& differences,
                             std::string_view published);
std::string incident_text(const Scenario& scenario, const Incident& incident);
// "met: head-on 3, agent: negotiation 17", or nothing.
std::string met_text(const Outcome& outcome);
// One run as text for a person. Lengths have 1 cm. Violations have 1 ms and 1 mm, because centimetres would hide small
// differences. Published laws leave the clearance of bodies that they do not accuse unmeasured.
std::string outcome_text(const Scenario& scenario, const Outcome& outcome, bool clearance_measured = true);

}  // namespace fleetproof
