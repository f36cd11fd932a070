#include "campaign/plan/default_gates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "campaign/plan/scenario_source.hpp"
#include "core/scenario/ways.hpp"

namespace fleetproof {
namespace {

constexpr double kShareOfUndisturbed = 0.05, kShareOfDemand = 0.5;
constexpr double kUnknownFloor = 1.0;      // if no run is long enough for an order
constexpr double kTransportsInARun = 4.0;  // a shorter run says little about throughput

double length_m(const LogicalMap& map, StationId from, StationId to) {
  return shortest_ways(map, from, to).back().length_m;
}

// Open transports as if the AGVs took them in turn.
Scenario with_orders_given_out(Scenario scenario) {
  for (std::size_t i = 0; i < scenario.open_orders.size(); ++i)
    scenario.agvs[i % scenario.agvs.size()].transports.push_back(scenario.open_orders[i]);
  scenario.open_orders.clear();
  return scenario;
}

// The time of a transport for an AGV that has the warehouse to itself, drives at full speed all the time and always has
// an order: the mean over the AGVs and orders of the first world of each layout and fleet. None without orders.
std::optional<double> undisturbed_transport_s(const CampaignPlan& plan) {
  const ScenarioSource scenarios(plan);
  double busy_s = 0.0, transports = 0.0;
  for (std::uint64_t index = 0; index < plan.cell_count(); index += plan.cells_per_world()) {
    const Scenario scenario = with_orders_given_out(scenarios.scenario(index));
    for (const AgvSetup& agv : scenario.agvs) {
      const VehicleType& type = scenario.type_of(agv);
      StationId at = agv.start;
      for (const TransportOrder& order : agv.transports) {
        const double way_m = length_m(*scenario.map, at, order.from) + length_m(*scenario.map, order.from, order.to);
        busy_s += way_m / type.drive.speed_mps + type.pick_s + type.drop_s;
        transports += 1.0;
        at = order.to;
      }
    }
  }
  return busy_s > 0.0 ? std::optional(busy_s / transports) : std::nullopt;
}

// With two digits, because people read it.
double as_floor(double rate) { return std::floor(100.0 * rate) / 100.0; }

// What the fleet has to get done per AGV-hour.
double throughput_floor(const CampaignPlan& plan, std::optional<double> transport_s) {
  const bool has_orders = plan.orders || plan.demand.transports_per_agv_hour > 0.0;
  if (!has_orders) return 0.0;
  if (!transport_s) return kUnknownFloor;
  const double undisturbed = 3600.0 / *transport_s;
  const double wanted = plan.orders ? undisturbed : plan.demand.transports_per_agv_hour;
  return as_floor(std::min(kShareOfUndisturbed * undisturbed, kShareOfDemand * wanted));
}

GateRecord gate(const std::string& agent, EndPoint end_point, GateKind kind, double limit) {
  GateRecord gate;
  gate.name = fmt::format("{} {}", agent, name_of(end_point));
  gate.agent = agent;
  gate.end_point = end_point;
  gate.kind = kind;
  gate.limit = limit;
  return gate;
}

constexpr EndPoint kNoneAllowed[] = {EndPoint::Violation, EndPoint::Crash, EndPoint::WrongLoad};
constexpr EndPoint kFewAllowed[] = {EndPoint::Deadlock, EndPoint::Livelock, EndPoint::Starvation, EndPoint::Hang};

bool is_default(const GateRecord& one) {
  const bool allows_none = std::ranges::find(kNoneAllowed, one.end_point) != std::end(kNoneAllowed);
  GateRecord usual = gate(one.agent, one.end_point, allows_none ? GateKind::None : GateKind::Rate,
                          allows_none ? kDefaultSafetyLimit : kDefaultLimit);
  usual.index = one.index, usual.region = one.region, usual.decides = one.decides, usual.table = one.table;
  usual.min_transports_per_agv_hour = one.min_transports_per_agv_hour;
  return one == usual;
}

bool has_contract_cells(const std::vector<CellRecord>& cells, const std::string& agent) {
  return std::ranges::any_of(cells, [&](const CellRecord& cell) { return cell.agent == agent && cell.in_contract(); });
}

}  // namespace

std::vector<std::string> agents_under_test(const CampaignPlan& plan, const std::vector<bool>& is_plugin) {
  std::vector<std::string> chosen, others;
  for (std::size_t i = 0; i < plan.agents.size(); ++i) {
    const AgentFactor& agent = plan.agents[i];
    if (agent.role == AgentRole::Reference) continue;
    const bool is_chosen = agent.role == AgentRole::Candidate || is_plugin[i];
    (is_chosen ? chosen : others).push_back(agent.name);
  }
  return chosen.empty() ? others : chosen;
}

void add_default_gates(CampaignPlan& plan, const std::vector<bool>& is_plugin) {
  if (!plan.default_gates || !plan.gates.empty() || plan.kind != CampaignKind::Claim) return;
  const std::vector<CellRecord> cells = plan.cells();
  const auto transport_s = undisturbed_transport_s(plan);
  const double floor = throughput_floor(plan, transport_s);
  const bool judges_throughput = floor > 0.0 && transport_s && plan.horizon_s >= kTransportsInARun * *transport_s;
  for (const std::string& agent : agents_under_test(plan, is_plugin)) {
    const Region region = has_contract_cells(cells, agent) ? Region::Contract : Region::All;
    const auto add = [&](EndPoint end_point, GateKind kind, double limit, double least) {
      plan.gates.push_back(gate(agent, end_point, kind, limit));
      plan.gates.back().region = region;
      plan.gates.back().min_transports_per_agv_hour = least;
    };
    for (const EndPoint end_point : kNoneAllowed)
      add(end_point, GateKind::None, kDefaultSafetyLimit, end_point == EndPoint::Violation ? floor : 0.0);
    for (const EndPoint end_point : kFewAllowed) add(end_point, GateKind::Rate, kDefaultLimit, 0.0);
    if (judges_throughput) add(EndPoint::Throughput, GateKind::Rate, kDefaultLimit, floor);
  }
  for (std::size_t i = 0; i < plan.gates.size(); ++i) plan.gates[i].index = static_cast<std::uint32_t>(i);
}

bool has_default_gates(const CampaignPlan& plan) {
  constexpr std::size_t kLeast = std::size(kNoneAllowed) + std::size(kFewAllowed);
  return plan.default_gates && plan.gates.size() >= kLeast && std::ranges::all_of(plan.gates, is_default);
}

std::string default_floor_text(const CampaignPlan& plan) {
  const double floor = plan.gates.front().min_transports_per_agv_hour,
               demand = plan.orders ? 0.0 : plan.demand.transports_per_agv_hour;
  if (floor == 0.0) return "The default gates ask for no throughput: the campaign has no orders, or hardly any.";
  std::string text = fmt::format(
      "The floor of throughput was not written in the campaign. By default it is {:g} transports (orders) per "
      "AGV-hour: ",
      floor);
  if (demand > 0.0 && floor == as_floor(kShareOfDemand * demand))
    return text + fmt::format("half of the {:g} that the campaign orders.", demand);
  text += fmt::format("a twentieth of the {:.3g} that an AGV alone in these warehouses would do",
                      floor / kShareOfUndisturbed);
  if (floor == kUnknownFloor) text += ", or what is asked for where runs are too short for an order";
  return text + (demand > 0.0 ? fmt::format("; the campaign orders {:g}.", demand) : ".");
}

}  // namespace fleetproof
