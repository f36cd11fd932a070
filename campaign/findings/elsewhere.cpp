#include "campaign/findings/elsewhere.hpp"

#include <algorithm>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/fitness.hpp"
#include "core/base/random.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kRuns = 100, kPlaces = 400, kTries = 20, kElsewhereKey = 8;
constexpr std::size_t kLooksEach = 3;

// What stands in the way of a fleet that is well, taken away.
Scenario calm(const Scenario& world) {
  Scenario calm = with_deliveries_only(world, {});
  calm.faults.clear();
  calm.obstacles.clear();
  for (AgvSetup& agv : calm.agvs) agv.sensing = {};
  return calm;
}

// Looks along a lane that leaves the station, so that it need not turn first.
bool place(AgvSetup& agv, const LogicalMap& map, std::uint64_t draw) {
  const StationId station{static_cast<std::uint32_t>(draw % map.station_count())};
  const auto& lanes = map.lanes_from(station);
  if (lanes.empty()) return false;
  agv.start = station;
  // Without negative zeros, which files do not keep.
  agv.heading = map.lanes()[lanes[(draw >> 32U) % lanes.size()]].start_heading() + Vec2::Zero();
  return true;
}

}  // namespace

std::optional<Scenario> elsewhere(Scenario scenario, std::uint32_t number) {
  for (std::uint32_t attempt = 0; attempt < kTries; ++attempt) {
    std::uint32_t agv = 0;
    const bool all_stand = std::ranges::all_of(scenario.agvs, [&](AgvSetup& setup) {
      return place(setup, *scenario.map, word64(philox(scenario.seed, {number, attempt, kElsewhereKey, agv++}), 0));
    });
    if (all_stand && is_fair(scenario)) return scenario;
  }
  return std::nullopt;
}

std::uint64_t driven_elsewhere_m(CaseHost& host, const KeptFailure& kept) {
  const auto make = [&](std::size_t i) {
    const auto number = static_cast<std::uint32_t>(i);
    return elsewhere(calm(kept.world_of(number)), number);
  };
  const auto runs = all_runs(host, {kRuns, make});
  std::uint64_t driven_um = 0;
  for (const auto& run : runs) driven_um += run ? run->outcome.counters.distance_um : 0;
  return driven_um / 1'000'000;
}

std::vector<FailingCase> same_failure_elsewhere(CaseHost& host, const KeptFailure& kept, std::size_t most) {
  if (most == 0) return {};
  const auto make = [&](std::size_t i) { return elsewhere(kept.world, static_cast<std::uint32_t>(i)); };
  const auto runs = all_runs(host, {kPlaces, make});
  std::vector<FailingCase> found;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < kPlaces && found.size() < most && looked_at < kLooksEach * most; ++i) {
    const auto failure = runs[i] ? failure_of(*runs[i]) : std::nullopt;
    if (!failure || end_of(*failure) != kept.end) continue;
    ++looked_at;
    auto needs = needs_of(host, *make(i));
    if (needs && !needs->is_rare && is_one_of(kept, *needs)) found.push_back(std::move(needs->reduced));
  }
  return found;
}

}  // namespace fleetproof
