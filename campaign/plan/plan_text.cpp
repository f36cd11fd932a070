#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "campaign/plan/plan.hpp"
#include "campaign/plan/plan_fields.hpp"
#include "core/base/error.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/radio_fields.hpp"

namespace fleetproof {
namespace {

using Json = nlohmann::ordered_json;

template <class Table>
Json numbers_json(Table table) {
  Json json = Json::object();
  for (const NumberField& field : number_fields(table)) json[field.key] = *field.value;
  return json;
}

template <class Table>
void read_numbers(const Json& json, Table& table) {
  for (const NumberField& field : number_fields(table)) *field.value = json.at(field.key);
}

Json vehicles_json(const std::vector<VehicleShare>& vehicles) {
  Json list = Json::array();
  for (const auto& [type, share] : vehicles) {
    Json json = numbers_json(type);
    json["name"] = type.name;
    json["share"] = share;
    list.push_back(std::move(json));
  }
  return list;
}

std::vector<VehicleShare> vehicles_from(const Json& list) {
  std::vector<VehicleShare> vehicles;
  for (const Json& json : list) {
    VehicleShare& vehicle = vehicles.emplace_back();
    read_numbers(json, vehicle.type);
    vehicle.type.name = json.at("name");
    vehicle.share = json.at("share");
  }
  return vehicles;
}

template <class Helper>
Json helper_json(const Helper& helper) {
  Json json = numbers_json(helper);
  json["on"] = helper.on;
  return json;
}

template <class Helper>
void read_helper(const Json& json, Helper& helper) {
  read_numbers(json, helper);
  helper.on = json.at("on");
}

// A recorded message is [sender, receiver, sent_ns, delay_ns], without a delay if it was lost.
Json radio_json(const CampaignPlan& plan) {
  const RadioSetup& radio = plan.radio;
  Json json = Json::object();
  for_each_radio_field(radio, [&](const RadioField& field, const auto& value) {
    if (field.is_factor) return;
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
      json[std::string(field.key)] = field.words[static_cast<std::size_t>(value)];
    } else {
      json[std::string(field.key)] = value;
    }
  });
  json["sources"] = plan.sources.count;
  json.update(numbers_json(plan.sources));
  if (radio.trace == nullptr) return json;
  Json& messages = json["trace"] = Json::array();
  for (const auto& [sender, receiver, sent, delay] : *radio.trace) {
    Json message = {sender.value, receiver.value, sent.count()};
    if (delay) message.push_back(delay->count());
    messages.push_back(std::move(message));
  }
  return json;
}

void read_radio(const Json& json, CampaignPlan& plan) {
  RadioSetup& radio = plan.radio;
  for_each_radio_field(radio, [&](const RadioField& field, auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if (field.is_factor) return;
    const Json& entry = json.at(std::string(field.key));
    if constexpr (std::is_enum_v<Value>) {
      const auto found = std::ranges::find(field.words, entry.get<std::string>());
      if (found == field.words.end())
        throw EngineError(
            fmt::format("the plan in the archive names {}, which this version does not know", entry.dump()));
      value = static_cast<Value>(found - field.words.begin());
    } else {
      value = entry.get<Value>();
    }
  });
  plan.sources.count = json.at("sources").get<std::uint32_t>();
  read_numbers(json, plan.sources);
  if (!json.contains("trace")) return;
  RadioTrace trace;
  for (const Json& entry : json.at("trace")) {
    RecordedMessage message{AgvId{entry.at(0).get<std::uint32_t>()}, AgvId{entry.at(1).get<std::uint32_t>()},
                            Duration{entry.at(2).get<std::int64_t>()}, std::nullopt};
    if (entry.size() > 3) message.delay = Duration{entry.at(3).get<std::int64_t>()};
    trace.push_back(message);
  }
  radio.trace = std::make_shared<const RadioTrace>(std::move(trace));
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

// A value, or its bounds.
Json spans_json(const std::vector<FactorSpan>& factor) {
  Json list = Json::array();
  for (const FactorSpan span : factor)
    list.push_back(span.is_drawn() ? Json{{"from", span.from}, {"to", span.to}} : Json(span.from));
  return list;
}

std::vector<FactorSpan> spans_from(const Json& list) {
  std::vector<FactorSpan> factor;
  for (const Json& json : list) {
    if (json.is_object()) {
      factor.emplace_back(json.at("from").get<double>(), json.at("to").get<double>());
    } else {
      factor.emplace_back(json.get<double>());
    }
  }
  return factor;
}

Json vary_json(const CampaignPlan& plan) {
  Json hold = Json::array();
  for (const Stream stream : plan.held_streams) hold.push_back(name_of(stream));
  return {{"hold", hold}, {"held_replicate", plan.held_replicate}};
}

void read_vary(const Json& json, CampaignPlan& plan) {
  for (const Json& name : json.at("hold")) {
    const auto stream = stream_of_name(name.get<std::string>());
    if (!stream)
      throw EngineError(fmt::format("the plan in the archive names {}, which this version does not know", name.dump()));
    plan.held_streams.push_back(*stream);
  }
  plan.held_replicate = json.at("held_replicate");
}

Json law_json(const CampaignPlan& plan) {
  Json pairs = Json::array();
  for (const auto& [one, other] : plan.law.exempt_pairs) pairs.push_back({one, other});
  return {{"safety_distance_m", plan.law.safety_distance_m},
          {"reaction_s", plan.law.reaction_s},
          {"min_transports_per_agv_hour", plan.law.min_transports_per_agv_hour},
          {"leave_out", plan.laws_left_out},
          {"exempt_purposes", purposes_text(plan.law.exempt_purposes)},
          {"exempt_radius_m", plan.law.exempt_radius_m},
          {"exempt_pairs", pairs}};
}

void read_law(const Json& json, CampaignPlan& plan) {
  plan.law.safety_distance_m = json.at("safety_distance_m");
  plan.law.reaction_s = json.at("reaction_s");
  plan.law.min_transports_per_agv_hour = json.at("min_transports_per_agv_hour");
  plan.laws_left_out = json.at("leave_out").get<std::vector<std::string>>();
  const auto purposes = purposes_of_text(json.at("exempt_purposes").get<std::string>());
  if (!purposes)
    throw EngineError(fmt::format("the plan in the archive exempts {}, which this version does not know",
                                  json.at("exempt_purposes").dump()));
  plan.law.exempt_purposes = *purposes;
  plan.law.exempt_radius_m = json.at("exempt_radius_m");
  for (const Json& pair : json.at("exempt_pairs"))
    plan.law.exempt_pairs.push_back({pair.at(0).get<std::string>(), pair.at(1).get<std::string>()});
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

Json factors_json(const CampaignPlan& plan) {
  return {{"agents", plan.agents},
          {"layouts", layouts_json(plan)},
          {"fleet_sizes", plan.fleet_sizes},
          {"loss", spans_json(plan.loss)},
          {"delay_s", spans_json(plan.delay_s)},
          {"mean_outage_s", spans_json(plan.mean_outage_s)},
          {"sampling", name_of(plan.sampling)}};
}

Json world_json(const CampaignPlan& plan) {
  Json world = {{"transports_per_agv_hour", plan.transports_per_agv_hour},
                {"placement", name_of(plan.placement)},
                {"hot_spot_skew", plan.hot_spot_skew}};
  if (plan.orders == nullptr) return world;
  Json orders = Json::array();
  for (const ListedOrder& order : plan.orders->orders) {
    const Json agv = order.agv ? Json(*order.agv) : Json(nullptr);
    orders.push_back({{"line", order.line},
                      {"release_ns", order.release.count()},
                      {"from", order.from},
                      {"to", order.to},
                      {"agv", agv}});
  }
  world["orders"] = {{"source", plan.orders->source}, {"orders", orders}};
  return world;
}

void read_world(const Json& world, CampaignPlan& plan) {
  plan.transports_per_agv_hour = world.at("transports_per_agv_hour");
  plan.placement = enum_from(world.at("placement"), {Placement::Random, Placement::ChargerBank, Placement::Adversarial,
                                                     Placement::Symmetric, Placement::Mixed});
  plan.hot_spot_skew = world.at("hot_spot_skew");
  if (!world.contains("orders")) return;
  OrderList list;
  list.source = world.at("orders").at("source");
  for (const Json& json : world.at("orders").at("orders")) {
    ListedOrder order{
        Duration{json.at("release_ns").get<std::int64_t>()}, json.at("from"), json.at("to"), {}, json.at("line")};
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
  plan.loss = spans_from(factors.at("loss"));
  plan.delay_s = spans_from(factors.at("delay_s"));
  plan.mean_outage_s = spans_from(factors.at("mean_outage_s"));
  plan.sampling = enum_from(factors.at("sampling"), {Sampling::Uniform, Sampling::LatinHypercube, Sampling::Sobol});
  for (const Json& entry : factors.at("layouts")) {
    LayoutFactor layout{entry.at("name"), nullptr, entry.value("mutate", false)};
    if (entry.contains("content"))
      layout.map =
          std::make_shared<const LogicalMap>(parse_layout(entry.at("content").dump(), "layout " + layout.name));
    plan.layouts.push_back(std::move(layout));
  }
  read_vary(json.at("vary"), plan);
  plan.agent_config = json.at("agent_config");
  read_world(json.at("world"), plan);
  plan.vehicles = vehicles_from(json.at("vehicles"));
  read_numbers(json.at("faults"), plan.faults);
  read_helper(json.at("scanner"), plan.scanner);
  read_helper(json.at("operator"), plan.operator_help);
  read_radio(json.at("radio"), plan);
  plan.agent_clock.call_cost_s = json.at("agent_clock").at("call_cost_s");
  read_law(json.at("law"), plan);
  plan.required_probes = json.at("coverage").at("probes").get<std::vector<std::string>>();
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
      {"factors", factors_json(plan)},
      {"vary", vary_json(plan)},
      {"agent_config", plan.agent_config},
      {"world", world_json(plan)},
      {"vehicles", vehicles_json(plan.vehicles)},
      {"faults", numbers_json(plan.faults)},
      {"scanner", helper_json(plan.scanner)},
      {"operator", helper_json(plan.operator_help)},
      {"radio", radio_json(plan)},
      {"agent_clock", {{"call_cost_s", plan.agent_clock.call_cost_s}}},
      {"law", law_json(plan)},
      {"coverage", {{"probes", plan.probes_to_meet()}}},
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
