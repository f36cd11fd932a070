#include "campaign/shrink/number_edits.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

Duration rounded_down(Duration time, Duration step) { return time / step * step; }

void add_switches(std::vector<NumberEdit>& edits) {
  edits.push_back({"scanner", [](Scenario& s) { s.scanner = {}; }});
  edits.push_back({"operator", [](Scenario& s) { s.operator_help = {}; }});
  edits.push_back({"cost of calls", [](Scenario& s) { s.agent_clock = {}; }});
  edits.push_back({"air time", [](Scenario& s) {
                     s.radio.air_time_s = RadioSetup{}.air_time_s;
                     s.radio.air_time_per_byte_s = 0.0;
                   }});
}

void add_of_type(std::vector<NumberEdit>& edits, std::size_t i) {
  const auto set = [&](std::string_view what, double VehicleType::*number) {
    edits.push_back({what, [i, number](Scenario& s) { s.vehicle_types[i].*number = VehicleType{}.*number; }});
  };
  set("differing speeds", &VehicleType::speed_deviation);
  set("settling", &VehicleType::settle_s);
  set("spread of transfers", &VehicleType::storage_spread_s);
  set("spread of other transfers", &VehicleType::other_spread_s);
  set("speed in bends", &VehicleType::lateral_mps2);
  set("battery use", &VehicleType::battery_per_m);
  set("battery use at rest", &VehicleType::battery_idle_per_s);
  edits.push_back({"size of loads", [i](Scenario& s) { s.vehicle_types[i].loaded = {}; }});
}

// `order`: finds it in a scenario.
template <class OrderIn>
void add_of_order(std::vector<NumberEdit>& edits, OrderIn order) {
  const auto release = [&](auto to) {
    edits.push_back({"release of an order", [order, to](Scenario& s) {
                       Duration& time = order(s).release;
                       time = to(time);
                     }});
  };
  release([](Duration) { return Duration::zero(); });
  release([](Duration time) { return rounded_down(time, std::chrono::seconds(10)); });
  release([](Duration time) { return rounded_down(time, std::chrono::seconds(1)); });
  edits.push_back({"withdrawal of an order", [order](Scenario& s) { order(s).withdrawn = kLongestDuration; }});
}

void add_of_agv(std::vector<NumberEdit>& edits, const AgvSetup& agv, std::size_t i) {
  edits.push_back({"sensing", [i](Scenario& s) { s.agvs[i].sensing = {}; }});
  edits.push_back({"battery", [i](Scenario& s) { s.agvs[i].battery = 1.0; }});
  for (std::size_t k = 0; k < agv.transports.size(); ++k)
    add_of_order(edits, [i, k](Scenario& s) -> TransportOrder& { return s.agvs[i].transports[k]; });
}

void add_of_fault(std::vector<NumberEdit>& edits, std::size_t i) {
  for (const Duration step : {Duration(std::chrono::seconds(10)), Duration(std::chrono::seconds(1))}) {
    edits.push_back(
        {"instant of a fault", [i, step](Scenario& s) { s.faults[i].at = rounded_down(s.faults[i].at, step); }});
    edits.push_back({"length of a fault", [i, step](Scenario& s) {
                       Duration& lasts = s.faults[i].lasts;
                       lasts = std::min(lasts, std::max(step, rounded_down(lasts / 2, step)));
                     }});
  }
}

template <class Visit>
void visit_instants(Scenario& scenario, Visit visit) {
  const auto visit_orders = [&](std::vector<TransportOrder>& orders) {
    for (TransportOrder& order : orders) {
      visit(order.release);
      if (order.withdrawn != kLongestDuration) visit(order.withdrawn);
    }
  };
  visit_orders(scenario.open_orders);
  for (AgvSetup& agv : scenario.agvs) {
    visit_orders(agv.transports);
    for (ScriptedCall& call : agv.script) visit(call.at);
  }
  for (Fault& fault : scenario.faults) {
    if (!fault.transport) visit(fault.at);
  }
  for (ObstacleSetup& obstacle : scenario.obstacles) {
    visit(obstacle.appears);
    if (obstacle.leaves != kLongestDuration) visit(obstacle.leaves);
  }
  for (GivenDelivery& delivery : scenario.deliveries) visit(delivery.sent);
}

}  // namespace

std::vector<NumberEdit> number_edits(const Scenario& scenario) {
  std::vector<NumberEdit> edits;
  add_switches(edits);
  for (std::size_t i = 0; i < scenario.vehicle_types.size(); ++i) add_of_type(edits, i);
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) add_of_agv(edits, scenario.agvs[i], i);
  for (std::size_t i = 0; i < scenario.open_orders.size(); ++i)
    add_of_order(edits, [i](Scenario& s) -> TransportOrder& { return s.open_orders[i]; });
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) add_of_fault(edits, i);
  return edits;
}

Scenario earlier_by(const Scenario& scenario, Duration by) {
  Scenario earlier = scenario;
  visit_instants(earlier, [by](Duration& time) { time = std::max(Duration::zero(), time - by); });
  return earlier;
}

Duration earliest_instant(const Scenario& scenario) {
  Scenario copy = scenario;
  Duration earliest = kLongestDuration;
  visit_instants(copy, [&](Duration time) {
    if (time > Duration::zero()) earliest = std::min(earliest, time);
  });
  return earliest == kLongestDuration ? Duration::zero() : earliest;
}

}  // namespace fleetproof
