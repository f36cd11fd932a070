#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "campaign/plan.hpp"
#include "core/error.hpp"
#include "generators/layout_file.hpp"

namespace fleetproof {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const VehicleType& vehicle) {
  return {{"name", vehicle.name},
          {"length_m", vehicle.footprint.length_m},
          {"width_m", vehicle.footprint.width_m},
          {"speed_mps", vehicle.drive.speed_mps},
          {"acceleration_mps2", vehicle.drive.acceleration_mps2},
          {"deceleration_mps2", vehicle.drive.deceleration_mps2},
          {"turn_speed_radps", vehicle.turn.speed_mps},
          {"turn_acceleration_radps2", vehicle.turn.acceleration_mps2},
          {"turn_deceleration_radps2", vehicle.turn.deceleration_mps2},
          {"battery_per_m", vehicle.battery_per_m},
          {"charge_per_s", vehicle.charge_per_s},
          {"pick_s", vehicle.pick_s},
          {"drop_s", vehicle.drop_s}};
}

VehicleType vehicle_from(const Json& json) {
  VehicleType vehicle;
  vehicle.name = json.at("name");
  vehicle.footprint = {json.at("length_m"), json.at("width_m")};
  vehicle.drive = {json.at("speed_mps"), json.at("acceleration_mps2"), json.at("deceleration_mps2")};
  vehicle.turn = {json.at("turn_speed_radps"), json.at("turn_acceleration_radps2"), json.at("turn_deceleration_radps2")};
  vehicle.battery_per_m = json.at("battery_per_m");
  vehicle.charge_per_s = json.at("charge_per_s");
  vehicle.pick_s = json.at("pick_s");
  vehicle.drop_s = json.at("drop_s");
  return vehicle;
}

Json to_json(const GateRecord& gate) {
  return {{"name", gate.name},
          {"agent", gate.agent},
          {"kind", name_of(gate.kind)},
          {"end_point", name_of(gate.end_point)},
          {"region", name_of(gate.region)},
          {"limit", gate.limit},
          {"confidence", gate.confidence},
          {"min_transports_per_agv_hour", gate.min_transports_per_agv_hour}};
}

template <class Enum>
Enum enum_from(const Json& json, std::initializer_list<Enum> all) {
  for (const Enum value : all) {
    if (json == name_of(value)) return value;
  }
  throw EngineError(fmt::format("the plan in the archive names {}, which this version does not know", json.dump()));
}

GateRecord gate_from(const Json& json, std::size_t index) {
  GateRecord gate;
  gate.index = static_cast<std::uint32_t>(index);
  gate.name = json.at("name");
  gate.agent = json.at("agent");
  gate.kind = enum_from(json.at("kind"), {GateKind::None, GateKind::Rate});
  gate.end_point = enum_from(json.at("end_point"), {EndPoint::Violation, EndPoint::Contact});
  gate.region = enum_from(json.at("region"), {Region::Contract, Region::WorstCase, Region::All});
  gate.limit = json.at("limit");
  gate.confidence = json.at("confidence");
  gate.min_transports_per_agv_hour = json.at("min_transports_per_agv_hour");
  return gate;
}

Json layouts_json(const CampaignPlan& plan) {
  Json layouts = Json::array();
  for (const LayoutFactor& layout : plan.layouts) {
    Json entry = {{"name", layout.name}};
    if (layout.mutate) entry["mutate"] = true;
    if (layout.map != nullptr) entry["content"] = Json::parse(to_text(layout.map->layout()));
    layouts.push_back(std::move(entry));
  }
  return layouts;
}

Json world_json(const CampaignPlan& plan) {
  Json world = {
      {"transports_per_agv_hour", plan.transports_per_agv_hour}, {"placement", name_of(plan.placement)}, {"hot_spot_skew", plan.hot_spot_skew}};
  if (plan.orders == nullptr) return world;
  Json orders = Json::array();
  for (const ListedOrder& order : plan.orders->orders) {
    const Json agv = order.agv ? Json(*order.agv) : Json(nullptr);
    orders.push_back({{"line", order.line}, {"release_ns", order.release.count()}, {"from", order.from}, {"to", order.to}, {"agv", agv}});
  }
  world["orders"] = {{"source", plan.orders->source}, {"orders", orders}};
  return world;
}

void read_world(const Json& world, CampaignPlan& plan) {
  plan.transports_per_agv_hour = world.at("transports_per_agv_hour");
  plan.placement =
      enum_from(world.at("placement"), {Placement::Random, Placement::ChargerBank, Placement::Adversarial, Placement::Symmetric, Placement::Mixed});
  plan.hot_spot_skew = world.at("hot_spot_skew");
  if (!world.contains("orders")) return;
  OrderList list;
  list.source = world.at("orders").at("source");
  for (const Json& json : world.at("orders").at("orders")) {
    ListedOrder order{Duration{json.at("release_ns").get<std::int64_t>()}, json.at("from"), json.at("to"), {}, json.at("line")};
    if (!json.at("agv").is_null()) order.agv = json.at("agv").get<std::uint32_t>();
    list.orders.push_back(std::move(order));
  }
  plan.orders = std::make_shared<const OrderList>(std::move(list));
}

CampaignPlan plan_from(const Json& json) {
  CampaignPlan plan;
  plan.name = json.at("name");
  plan.kind = json.at("kind");
  plan.seed = json.at("seed");
  plan.replicates = json.at("replicates");
  plan.horizon_s = json.at("horizon_s");
  plan.stuck_after_s = json.at("stuck_after_s");
  plan.contact_stops = json.at("contact_stops");
  const Json& factors = json.at("factors");
  plan.agents = factors.at("agents").get<std::vector<std::string>>();
  plan.fleet_sizes = factors.at("fleet_sizes").get<std::vector<std::uint32_t>>();
  plan.loss = factors.at("loss").get<std::vector<double>>();
  plan.delay_s = factors.at("delay_s").get<std::vector<double>>();
  for (const Json& entry : factors.at("layouts")) {
    LayoutFactor layout{entry.at("name"), nullptr, entry.value("mutate", false)};
    if (entry.contains("content")) layout.map = std::make_shared<const LogicalMap>(parse_layout(entry.at("content").dump(), "layout " + layout.name));
    plan.layouts.push_back(std::move(layout));
  }
  plan.agent_config = json.at("agent_config");
  read_world(json.at("world"), plan);
  plan.vehicle = vehicle_from(json.at("vehicle"));
  const Json& radio = json.at("radio");
  plan.radio.delay_model = radio.at("delay_model") == "uniform" ? RadioSetup::DelayModel::Uniform : RadioSetup::DelayModel::Constant;
  plan.radio.range_m = radio.at("range_m");
  plan.radio.air_time_s = radio.at("air_time_s");
  plan.agent_clock.call_cost_s = json.at("agent_clock").at("call_cost_s");
  plan.law.safety_distance_m = json.at("law").at("safety_distance_m");
  for (const Json& gate : json.at("gates")) plan.gates.push_back(gate_from(gate, plan.gates.size()));
  return plan;
}

}  // namespace

std::string plan_text(const CampaignPlan& plan) {
  Json gates = Json::array();
  for (const GateRecord& gate : plan.gates) gates.push_back(to_json(gate));
  const Json json = {
      {"version", 1},
      {"name", plan.name},
      {"kind", plan.kind},
      {"seed", plan.seed},
      {"replicates", plan.replicates},
      {"horizon_s", plan.horizon_s},
      {"stuck_after_s", plan.stuck_after_s},
      {"contact_stops", plan.contact_stops},
      {"factors",
       {{"agents", plan.agents}, {"layouts", layouts_json(plan)}, {"fleet_sizes", plan.fleet_sizes}, {"loss", plan.loss}, {"delay_s", plan.delay_s}}},
      {"agent_config", plan.agent_config},
      {"world", world_json(plan)},
      {"vehicle", to_json(plan.vehicle)},
      {"radio",
       {{"delay_model", plan.radio.delay_model == RadioSetup::DelayModel::Uniform ? "uniform" : "constant"},
        {"range_m", plan.radio.range_m},
        {"air_time_s", plan.radio.air_time_s}}},
      {"agent_clock", {{"call_cost_s", plan.agent_clock.call_cost_s}}},
      {"law", {{"safety_distance_m", plan.law.safety_distance_m}}},
      {"gates", gates},
  };
  return json.dump(1);
}

CampaignPlan parse_plan(const std::string& text) {
  try {
    return plan_from(Json::parse(text));
  } catch (const Json::exception& error) {
    throw EngineError(fmt::format("the plan in the archive cannot be read: {}", error.what()));
  } catch (const InputError& error) {
    throw EngineError(fmt::format("the plan in the archive cannot be read: {}", error.what()));
  }
}

}  // namespace fleetproof
