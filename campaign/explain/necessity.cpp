#include "campaign/explain/necessity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>
#include <set>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/fitness.hpp"
#include "campaign/shrink/shrink.hpp"
#include "campaign/shrink/surgery.hpp"
#include "core/base/shown_time.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "core/scenario/order_table.hpp"

namespace fleetproof {
namespace {

constexpr Duration kTimeGrain = std::chrono::milliseconds(10);

// While the radio draws, so many of the messages before the failure are asked for, and so many are told.
constexpr std::size_t kMostAsked = 60, kMostTold = 4;

Scenario with_delivery(const Scenario& scenario, const GivenDelivery& delivery) {
  Scenario changed = scenario;
  const auto given = std::ranges::find_if(changed.deliveries,
                                          [&](const GivenDelivery& other) { return is_same_message(other, delivery); });
  if (given == changed.deliveries.end()) {
    changed.deliveries.push_back(delivery);
  } else {
    *given = delivery;
  }
  return changed;
}

GivenDelivery arriving_after(GivenDelivery delivery, Duration delay) {
  delivery.lost = delivery.copied = false;
  delivery.delay = delay;
  delivery.copy_delay = Duration::zero();
  return delivery;
}

// By halving.
std::optional<LatestArrival> latest_that_saves(CaseHost& host, const FailingCase& failing,
                                               const FailurePattern& pattern, const GivenDelivery& delivery) {
  const auto saves = [&](Duration delay) {
    return avoids(host(with_delivery(failing.scenario, arriving_after(delivery, delay))), failing, pattern);
  };
  Duration low{}, high = delivery.lost ? failing.failure.at - kStart - delivery.sent : delivery.delay;
  if (high <= kTimeGrain || saves(high)) return std::nullopt;
  while (high - low > kTimeGrain) {
    const Duration middle = low + (high - low) / 2;
    (saves(middle) ? low : high) = middle;
  }
  return LatestArrival{low, high};
}

Scenario at_once(const Scenario& scenario, const MessageDelivery& message) {
  return with_delivery(scenario, arriving_after(message.delivery, Duration::zero()));
}

MessageNeed need_of(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
                    const MessageDelivery& message) {
  const GivenDelivery& delivery = message.delivery;
  MessageNeed need;
  need.message = message;
  Scenario arrived = at_once(failing.scenario, message);
  const CaseRun run = host(arrived);
  need.is_needed = avoids(run, failing, pattern);
  need.claims.push_back({fmt::format("{} arrived at once", message_text(failing.scenario, message)),
                         std::move(arrived),
                         expectation_of(run),
                         need.is_needed,
                         {}});
  if (need.is_needed) need.latest = latest_that_saves(host, failing, pattern, delivery);
  if (!need.latest) return need;
  for (const Duration late : {need.latest->in_time, need.latest->too_late}) {
    Scenario later = with_delivery(failing.scenario, arriving_after(delivery, late));
    ExpectedOutcome outcome = expectation_of(host(later));
    need.claims.push_back({fmt::format("{} arrived at {:.3f} s", message_text(failing.scenario, message),
                                       shown_seconds(delivery.sent + late)),
                           std::move(later), std::move(outcome)});
  }
  return need;
}

// A loss or delay that the radio draws: of the last such messages between its two bodies, those that it needs. Any
// other run has other messages later, so of those that are needed the last are told.
void add_drawn(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
               const std::vector<MessageDelivery>& messages, std::vector<MessageNeed>& needs) {
  const auto is_of_it = [&](EntityId body) {
    return !failing.failure.a.valid() || body == failing.failure.a || body == failing.failure.b;
  };
  std::vector<MessageDelivery> asked;
  std::ranges::copy_if(messages, std::back_inserter(asked), [&](const MessageDelivery& m) {
    return m.is_adverse() && kStart + m.delivery.sent < failing.failure.at && is_of_it(m.delivery.sender) &&
           is_of_it(m.delivery.receiver) && std::ranges::none_of(needs, [&](const MessageNeed& need) {
             return is_same_message(need.message.delivery, m.delivery);
           });
  });
  if (asked.size() > kMostAsked) asked.erase(asked.begin(), asked.end() - kMostAsked);
  const auto runs =
      all_runs(host, {asked.size(), [&](std::size_t i) { return std::optional(at_once(failing.scenario, asked[i])); }});
  std::vector<MessageDelivery> needed;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (avoids(*runs[i], failing, pattern)) needed.push_back(asked[i]);
  }
  if (needed.size() > kMostTold) needed.erase(needed.begin(), needed.end() - kMostTold);
  for (const MessageDelivery& message : needed) needs.push_back(need_of(host, failing, pattern, message));
}

struct Without {
  std::string what;
  std::function<Scenario(const Scenario&)> edit;
  bool tells_why = false;
};

// What is no thing, but can be left out like one.
void add_properties(const Scenario& scenario, std::vector<Without>& things) {
  const std::vector<Without> properties = {{"the change of bodies and speeds with a load",
                                            [](const Scenario& s) {
                                              Scenario less = s;
                                              for (VehicleType& type : less.vehicle_types) type.loaded = {};
                                              return less;
                                            },
                                            true},
                                           {"wrong clocks and positions",
                                            [](const Scenario& s) {
                                              Scenario less = s;
                                              for (AgvSetup& agv : less.agvs) agv.sensing = {};
                                              return less;
                                            }},
                                           {"low batteries", [](const Scenario& s) {
                                              Scenario less = s;
                                              for (AgvSetup& agv : less.agvs) agv.battery = 1.0;
                                              return less;
                                            }}};
  const std::uint64_t digest = scenario_digest(scenario);
  std::ranges::copy_if(properties, std::back_inserter(things),
                       [&](const Without& property) { return scenario_digest(property.edit(scenario)) != digest; });
}

Scenario with_straight_lane(const Scenario& scenario, std::size_t segment) {
  Layout layout = scenario.map->layout();
  layout.segments[segment].control_points_m.clear();
  Scenario straight = scenario;
  straight.map = std::make_shared<const LogicalMap>(layout);
  return straight;
}

// Of the lanes on which the bodies of the failure were. Straight lanes have none.
void add_bends(CaseHost& host, const FailingCase& failing, std::vector<Without>& things) {
  const CaseRun run = host(failing.scenario, Deliveries::Kept);
  const LogicalMap& map = *failing.scenario.map;
  const auto& segments = map.layout().segments;
  std::set<std::size_t> driven;
  for (const EntityId body : {failing.failure.a, failing.failure.b}) {
    const Departure* last = nullptr;
    for (const Departure& departure : run.itinerary.departures) {
      if (departure.agv == body && departure.at <= failing.failure.at) last = &departure;
    }
    if (last == nullptr || last->arrives < failing.failure.at) continue;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const auto joins = [&](StationId a, StationId b) { return segments[i].from == a && segments[i].to == b; };
      const bool is_this = joins(last->from, last->to) || joins(last->to, last->from);
      if (is_this && !segments[i].control_points_m.empty()) driven.insert(i);
    }
  }
  for (const std::size_t i : driven)
    things.push_back({fmt::format("the bend of the lane between {} and {}", map.station(segments[i].from).name,
                                  map.station(segments[i].to).name),
                      [=](const Scenario& s) { return with_straight_lane(s, i); }, true});
}

std::vector<Without> things_of(const Scenario& scenario) {
  std::vector<Without> things;
  const auto but = [](std::size_t i) { return [i](std::size_t other) { return other != i; }; };
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i)
    things.push_back({scenario.agvs[i].name, [=](const Scenario& s) { return with_agvs(s, but(i)); }});
  for (std::size_t i = 0; i < scenario.computers.size(); ++i)
    things.push_back({scenario.computers[i].name, [=](const Scenario& s) { return with_computers(s, but(i)); }});
  const OrderTable orders(scenario);
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const TransportId transport{i};
    const TransportOrder& order = orders.order(transport);
    const std::string whose =
        orders.is_open(transport) ? "the open order" : "the order of " + scenario.name_of(orders.agv_of(transport));
    things.push_back({fmt::format("{} from {} to {}", whose, scenario.map->station(order.from).name,
                                  scenario.map->station(order.to).name),
                      [=](const Scenario& s) { return with_transports(s, but(i)); }});
  }
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const Fault& fault = scenario.faults[i];
    things.push_back({fmt::format("the {} of {} at {:.3f} s", text_of(fault), name_of_body(scenario, fault.agv),
                                  shown_seconds(fault.at)),
                      [=](const Scenario& s) {
                        Scenario less = s;
                        less.faults = kept(s.faults, but(i));
                        return less;
                      },
                      true});
  }
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i) {
    things.push_back({"the obstacle " + scenario.obstacles[i].name, [=](const Scenario& s) {
                        Scenario less = s;
                        less.obstacles = kept(s.obstacles, but(i));
                        return less;
                      }});
  }
  add_properties(scenario, things);
  return things;
}

}  // namespace

void add_message_needs(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
                       std::vector<MessageNeed>& found) {
  const auto messages = host(failing.scenario, Deliveries::Kept).deliveries;
  for (const GivenDelivery& delivery : failing.scenario.deliveries) {
    const auto sent = std::ranges::find_if(
        messages, [&](const MessageDelivery& message) { return is_same_message(message.delivery, delivery); });
    if (sent != messages.end()) found.push_back(need_of(host, failing, pattern, *sent));  // or it changed nothing
  }
  if (CaseSize::of(failing.scenario).deliveries_are_drawn) add_drawn(host, failing, pattern, messages, found);
}

std::vector<Claim> without_each_thing(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern) {
  auto things = things_of(failing.scenario);
  add_bends(host, failing, things);
  const auto make = [&](std::size_t i) -> std::optional<Scenario> {
    Scenario less = things[i].edit(failing.scenario);
    return is_fair(less) ? std::optional(std::move(less)) : std::nullopt;
  };
  const auto runs = all_runs(host, {things.size(), make});
  std::vector<Claim> claims;
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (!runs[i]) continue;
    const bool avoided = avoids(*runs[i], failing, pattern);
    const char* how = pattern.match(*runs[i]) ? "fails in the same way"
                      : avoided               ? "does not fail so"
                                              : "fails a little otherwise";
    claims.push_back({fmt::format("{} without {}", how, things[i].what), *make(i), expectation_of(*runs[i]), avoided,
                      runs[i]->all_words, things[i].tells_why});
  }
  return claims;
}

}  // namespace fleetproof
