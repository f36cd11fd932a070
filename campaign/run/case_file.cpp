#include "campaign/run/case_file.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "laws/laws.hpp"

namespace fleetproof {

Scenario read_case_file(const std::string& path) {
  Scenario scenario = read_scenario(path);
  for (std::size_t i = 0; i < scenario.law.leave_out.size(); ++i) {
    const std::string why_not = why_not_left_out(scenario.law.leave_out[i]);
    if (!why_not.empty()) throw InputError(fmt::format("{}: /law/leave_out/{}", path, i), why_not);
  }
  return scenario;
}

}  // namespace fleetproof
