#include "campaign/shrink/later_start.hpp"

#include <algorithm>

#include "campaign/shrink/number_edits.hpp"
#include "campaign/shrink/surgery.hpp"
#include "core/scenario/order_table.hpp"

namespace fleetproof {
namespace {

// A file knows one zero only, and agents may send a heading as it is.
Vec2 as_in_a_file(const Vec2& heading) { return heading + Vec2::Zero(); }

void start_at(AgvSetup& agv, StationId station, const Vec2& heading) {
  agv.start = station;
  agv.heading = as_in_a_file(heading);
}

// An AGV that has arrived looks where it sets out to next: it need not turn first.
void place(AgvSetup& setup, AgvId agv, const Itinerary& itinerary, SimTime t, Between between) {
  for (const Departure& departure : itinerary.departures) {
    if (departure.agv != agv) continue;
    if (departure.at > t) {
      if (setup.start == departure.from) setup.heading = as_in_a_file(departure.heading);
      return;
    }
    const bool behind = departure.arrives > t && between == Between::Behind;
    start_at(setup, behind ? departure.from : departure.to, behind ? departure.heading : departure.heading_there);
  }
}

// Without transports that were delivered or withdrawn by then.
Scenario without_delivered(const Scenario& scenario, const Itinerary& itinerary, SimTime t) {
  const OrderTable orders(scenario);
  return with_transports(scenario, [&](std::size_t i) {
    if (kStart + orders.order(TransportId{i}).withdrawn <= t) return false;
    return std::ranges::none_of(
        itinerary.done, [&](const DoneTransport& one) { return one.at <= t && one.transport == TransportId{i}; });
  });
}

// What was over has no effect; what was under way lasts as long as was left.
void shorten_faults(Scenario& scenario, Duration from) {
  std::erase_if(scenario.faults,
                [from](const Fault& fault) { return !fault.transport && fault.at + fault.lasts <= from; });
  for (Fault& fault : scenario.faults) {
    if (!fault.transport && fault.at < from) fault.lasts -= from - fault.at;
  }
}

}  // namespace

Scenario with_later_start(const Scenario& scenario, const Itinerary& itinerary, Duration from, Between between) {
  const SimTime t = kStart + from;
  Scenario later = without_delivered(scenario, itinerary, t);
  for (std::size_t i = 0; i < later.agvs.size(); ++i) place(later.agvs[i], AgvId{i}, itinerary, t, between);
  shorten_faults(later, from);
  std::erase_if(later.obstacles, [from](const ObstacleSetup& obstacle) { return obstacle.leaves <= from; });
  std::erase_if(later.deliveries, [from](const GivenDelivery& delivery) { return delivery.sent < from; });
  auto& adverse = later.radio.adverse;
  adverse.adverse_from_s = std::max(0.0, adverse.adverse_from_s - to_seconds(from));
  if (adverse.adverse_until_s > 0.0)  // 0 would be no end
    adverse.adverse_until_s = std::max(1e-3, adverse.adverse_until_s - to_seconds(from));
  later.horizon -= from;
  return earlier_by(later, from);
}

}  // namespace fleetproof
