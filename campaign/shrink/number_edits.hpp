#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A simpler value for something of a scenario. The scenario may have it already.
struct NumberEdit {
  std::string_view what;  // "battery"
  std::function<void(Scenario&)> apply;
};

// All simpler values that are tried, one by one: what is switched off, what is as it is without being named, and
// round numbers. Requires: they are applied to `scenario`, or to one with as many of everything.
std::vector<NumberEdit> number_edits(const Scenario& scenario);

// All instants of the scenario so much earlier. None gets earlier than the start of the run.
Scenario earlier_by(const Scenario& scenario, Duration by);
// The earliest instant of the scenario that is not its beginning: an order, a fault, an obstacle, a call, a given
// delivery.
Duration earliest_instant(const Scenario& scenario);

}  // namespace fleetproof
