#include "campaign/shrink/other_draws.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

enum Topic : std::uint32_t { kDrawsTopic = 1, kLaterTopic = 2 };
constexpr std::uint32_t kOfNoAgv = ~0U;

Scenario redrawn(Scenario scenario, std::uint32_t number, std::initializer_list<Stream> streams) {
  const std::uint64_t seed = word64(philox(scenario.seed, {number, 0, kDrawsTopic, 0}), 0);
  std::vector<StreamSeed> seeds;
  for (const Stream stream : kRunStreams) {
    const std::uint64_t own = std::ranges::count(streams, stream) > 0 ? seed : scenario.seed_of(stream);
    if (own != scenario.seed) seeds.push_back({stream, own});
  }
  scenario.stream_seeds = std::move(seeds);
  return scenario;
}

void shift(std::vector<TransportOrder>& orders, Duration by) {
  for (TransportOrder& order : orders) {
    order.release += by;
    if (order.withdrawn != kLongestDuration) order.withdrawn += by;
  }
}

}  // namespace

Scenario with_other_draws(Scenario scenario, std::uint32_t number) {
  return redrawn(std::move(scenario), number, {Stream::Radio, Stream::Agent});
}

Scenario with_other_radio(Scenario scenario, std::uint32_t number) {
  return redrawn(std::move(scenario), number, {Stream::Radio});
}

// An AGV keeps its shift when others are taken out of the fleet. The open transports have one of their own.
Scenario with_other_timeline(Scenario scenario, std::uint32_t number, Duration later) {
  std::vector<Duration> shifts;
  const auto drawn = [&](std::uint32_t of) {
    return seconds(to_seconds(later) * unit_interval(word64(philox(scenario.seed, {number, of, kLaterTopic, 0}), 0)));
  };
  for (std::uint32_t i = 0; i < scenario.agvs.size(); ++i) {
    shifts.push_back(drawn(scenario.agvs[i].draws_as.value_or(i)));
    shift(scenario.agvs[i].transports, shifts[i]);
  }
  shift(scenario.open_orders, drawn(kOfNoAgv));
  for (Fault& fault : scenario.faults) {
    if (!fault.transport && scenario.is_agv(fault.agv)) fault.at += shifts[fault.agv.index()];
  }
  return redrawn(std::move(scenario), number, {Stream::Motion, Stream::Radio, Stream::Agent});
}

}  // namespace fleetproof
