#include "campaign/shrink/other_luck.hpp"

#include <utility>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kLuckTopic = 1;

// `of_agents`: the streams of the agents change, too.
Scenario redrawn(Scenario scenario, std::uint32_t number, bool of_agents) {
  const std::uint64_t seed = word64(philox(scenario.seed, {number, 0, kLuckTopic, 0}), 0);
  std::vector<StreamSeed> seeds;
  for (const Stream stream : kRunStreams) {
    const bool is_luck = stream == Stream::Radio || (of_agents && stream == Stream::Agent);
    const std::uint64_t own = is_luck ? seed : scenario.seed_of(stream);
    if (own != scenario.seed) seeds.push_back({stream, own});
  }
  scenario.stream_seeds = std::move(seeds);
  return scenario;
}

}  // namespace

Scenario with_other_luck(Scenario scenario, std::uint32_t number) { return redrawn(std::move(scenario), number, true); }

Scenario with_other_radio(Scenario scenario, std::uint32_t number) {
  return redrawn(std::move(scenario), number, false);
}

}  // namespace fleetproof
