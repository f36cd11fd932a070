#include "campaign/workers/case_text.hpp"

#include "generators/formats/layout_file.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kSource = "an order to a worker";

}  // namespace

CaseText CaseWriter::write(const Scenario& scenario) {
  CaseText text{scenario.map->digest(), {}, text_without_layout(scenario)};
  const std::lock_guard lock(mutex_);
  text.layout = layouts_.find(text.layout_digest, [&] { return to_text(scenario.map->layout()); });
  return text;
}

Scenario CaseReader::read(const CaseText& text) {
  const auto& map = maps_.find(text.layout_digest,
                               [&] { return std::make_shared<const LogicalMap>(parse_layout(text.layout, kSource)); });
  return parse_scenario_on(map, text.scenario, kSource);
}

}  // namespace fleetproof
