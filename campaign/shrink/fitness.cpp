#include "campaign/shrink/fitness.hpp"

#include <algorithm>

#include "generators/scenario_file/validator.hpp"

namespace fleetproof {

bool is_fair(const Scenario& scenario) {
  if (!unusable_problems(scenario).empty()) return false;
  std::vector<std::string> types;
  for (const VehicleType& type : scenario.vehicle_types) types.push_back(type.name);
  const Problems problems = world_problems(scenario, Reachability(*scenario.map, types));
  // A plant cut to what a failure needs may have stations from which no way leads back.
  return std::ranges::all_of(problems, [](const Problem& problem) { return problem.kind == ProblemKind::WeakCore; });
}

}  // namespace fleetproof
