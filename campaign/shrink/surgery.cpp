#include "campaign/shrink/surgery.hpp"

#include <algorithm>
#include <optional>

#include "core/scenario/draw_numbers.hpp"
#include "core/scenario/order_table.hpp"
#include "generators/map/layout_check.hpp"

namespace fleetproof {
namespace {

// Old places to new ones, for a list of which some items stay.
class Places {
 public:
  Places(std::size_t count, const Keeps& keeps) {
    for (std::size_t i = 0; i < count; ++i) {
      new_.push_back(keeps(i) ? std::optional(left_++) : std::nullopt);
    }
  }
  bool has(std::size_t old) const { return new_[old].has_value(); }
  std::uint32_t operator[](std::size_t old) const { return *new_[old]; }
  template <class Id>
  void renumber(Id& id) const {
    id = Id{(*this)[id.index()]};
  }

 private:
  std::vector<std::optional<std::uint32_t>> new_;
  std::uint32_t left_ = 0;
};

// What refers to participants that are gone goes, and the rest gets their new ids.
void forget_others(Scenario& less, const Places& places) {
  std::erase_if(less.faults, [&](const Fault& fault) { return fault.agv.valid() && !places.has(fault.agv.index()); });
  for (Fault& fault : less.faults) {
    if (fault.agv.valid()) places.renumber(fault.agv);
  }
  std::erase_if(less.deliveries, [&](const GivenDelivery& delivery) {
    return !places.has(delivery.sender.index()) || !places.has(delivery.receiver.index());
  });
  for (GivenDelivery& delivery : less.deliveries) {
    places.renumber(delivery.sender);
    places.renumber(delivery.receiver);
  }
}

}  // namespace

Scenario with_agvs(const Scenario& scenario, const Keeps& keeps) {
  const std::size_t fleet = scenario.agvs.size();
  const DrawNumbers numbers(scenario);
  Scenario less = scenario;
  for (std::size_t i = 0; i < fleet; ++i) less.agvs[i].draws_as = numbers.of(AgvId{i}).value;
  less.agvs = kept(less.agvs, keeps);
  forget_others(less, Places(scenario.participant_count(), [&](std::size_t i) { return i >= fleet || keeps(i); }));
  return less;
}

Scenario with_computers(const Scenario& scenario, const Keeps& keeps) {
  const std::size_t fleet = scenario.agvs.size();
  Scenario less = scenario;
  for (std::uint32_t i = 0; i < less.computers.size(); ++i) {
    if (!less.computers[i].draws_as) less.computers[i].draws_as = i;
  }
  less.computers = kept(less.computers, keeps);
  forget_others(less,
                Places(scenario.participant_count(), [&](std::size_t i) { return i < fleet || keeps(i - fleet); }));
  return less;
}

Scenario with_fleet_renumbered(const Scenario& scenario, std::size_t first) {
  const DrawNumbers numbers(scenario);
  Scenario other = scenario;
  const std::size_t fleet = other.agvs.size();
  for (std::size_t i = 0; i < fleet; ++i) other.agvs[i].draws_as = numbers.of(AgvId{i}).value;
  std::rotate(other.agvs.begin(), other.agvs.begin() + static_cast<std::ptrdiff_t>(first), other.agvs.end());
  const auto renumber = [&](EntityId& id) {
    if (id.index() < fleet) id = EntityId{(id.index() + fleet - first) % fleet};
  };
  for (Fault& fault : other.faults) renumber(fault.agv);
  for (GivenDelivery& delivery : other.deliveries) {
    renumber(delivery.sender);
    renumber(delivery.receiver);
  }
  return other;
}

Scenario with_transports(const Scenario& scenario, const Keeps& keeps) {
  const OrderTable orders(scenario);
  Scenario less = scenario;
  // Of one AGV; of an invalid one, the open ones.
  const auto keep = [&](AgvId agv, std::vector<TransportOrder>& list) {
    const auto stays = [&](std::size_t i) { return keeps(orders.at(agv, i).index()); };
    const Places places(list.size(), stays);
    list = kept(list, stays);
    const auto is_of_list = [&](const Fault& fault) { return fault.transport && fault.agv == agv; };
    std::erase_if(less.faults, [&](const Fault& fault) { return is_of_list(fault) && !places.has(*fault.transport); });
    for (Fault& fault : less.faults) {
      if (is_of_list(fault)) fault.transport = places[*fault.transport];
    }
  };
  for (std::size_t i = 0; i < less.agvs.size(); ++i) keep(AgvId{i}, less.agvs[i].transports);
  keep({}, less.open_orders);
  return less;
}

Scenario with_segments(const Scenario& scenario, const Keeps& keeps) {
  Layout layout = scenario.map->layout();
  std::vector<bool> needed(layout.stations.size(), false);
  for (const AgvSetup& agv : scenario.agvs) {
    needed[agv.start.index()] = true;
    for (const TransportOrder& order : agv.transports) needed[order.from.index()] = needed[order.to.index()] = true;
  }
  for (const TransportOrder& order : scenario.open_orders) needed[order.from.index()] = needed[order.to.index()] = true;
  const Places segments(layout.segments.size(), keeps);
  layout.segments = kept(layout.segments, keeps);
  for (const Segment& segment : layout.segments) needed[segment.from.index()] = needed[segment.to.index()] = true;
  const auto stays = [&](std::size_t i) { return needed[i]; };
  const Places stations(layout.stations.size(), stays);
  layout.stations = kept(layout.stations, stays);
  for (Segment& segment : layout.segments) {
    stations.renumber(segment.from);
    stations.renumber(segment.to);
  }
  Scenario less = scenario;
  less.map = std::make_shared<const LogicalMap>(layout);
  const auto renumber = [&](std::vector<TransportOrder>& orders) {
    for (TransportOrder& order : orders) {
      stations.renumber(order.from);
      stations.renumber(order.to);
    }
  };
  renumber(less.open_orders);
  for (AgvSetup& agv : less.agvs) {
    stations.renumber(agv.start);
    renumber(agv.transports);
    for (ScriptedCall& call : agv.script) {
      if (call.segment.valid()) segments.renumber(call.segment);
    }
  }
  return less;
}

}  // namespace fleetproof
