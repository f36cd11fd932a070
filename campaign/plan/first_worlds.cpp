#include "campaign/plan/first_worlds.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "campaign/plan/scenario_source.hpp"
#include "core/base/outside_text.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kMostWorlds = 16;
// At most so many in all worlds of a layout, beyond the first.
constexpr std::uint64_t kStationsDrawn = 2000;

struct Crowding {
  std::uint64_t worlds = 0, without_room = 0;
  std::uint32_t fits = 0;  // in each world without room
};

// `index`: a run in the first world.
Crowding crowding(const CampaignPlan& plan, const ScenarioSource& scenarios, std::uint64_t index,
                  std::size_t stations) {
  Crowding found;
  found.worlds = std::min(worlds_to_draw(kMostWorlds, stations), plan.replicates);
  for (std::uint64_t replicate = 1; replicate < found.worlds; ++replicate) {
    try {
      RejectionCounts ignored;
      (void)scenarios.world(replicate * plan.cell_count() + index, ignored);
    } catch (const NoRoom& crowded) {
      found.fits = found.without_room == 0 ? crowded.fits : std::min(found.fits, crowded.fits);
      ++found.without_room;
    }
  }
  return found;
}

}  // namespace

std::uint64_t worlds_to_draw(std::uint64_t most, std::size_t stations) {
  return std::clamp<std::uint64_t>(kStationsDrawn / std::max<std::uint64_t>(stations, 1), 1, most);
}

std::vector<std::string> build_first_worlds(const CampaignPlan& plan) {
  const ScenarioSource scenarios(plan);
  std::vector<std::string> sentences;
  for (std::uint64_t index = 0; index < plan.cell_count(); index += plan.cells_per_world()) {
    const Scenario world = scenarios.scenario(index);
    const std::size_t stations = world.map->station_count(), agvs = world.agvs.size();
    const std::string name = scenarios.place(index).cell.layout, layout = in_quotes(name);
    const bool is_drawn = std::ranges::find(plan.layouts, name, &LayoutFactor::name)->map == nullptr;
    const auto small = is_drawn ? too_small(family_range(name), static_cast<std::uint32_t>(agvs)) : "";
    if (!small.empty()) sentences.push_back(layout + ": " + small);
    if (const Crowding found = crowding(plan, scenarios, index, stations); found.without_room > 0)
      sentences.push_back(
          fmt::format("{}: no room for {} AGVs in {} of the first {} worlds{}; the runs there end "
                      "without a result",
                      layout, agvs, found.without_room, found.worlds,
                      found.fits > 0 ? fmt::format(", but for {}", found.fits) : ""));
    if (2 * agvs > stations)
      sentences.push_back(
          fmt::format("{}: {} AGVs on {} stations; with more than one for two stations, {} here, a "
                      "fleet may stand still",
                      layout, agvs, stations, stations / 2));
  }
  return sentences;
}

}  // namespace fleetproof
