#include "campaign/plan/plan_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "campaign/plan/plan_fields.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/purpose_words.hpp"

namespace fleetproof {
namespace {

constexpr int kVersion = 1;

// Plan texts have a list where campaign files have several tables.
std::string json_key(const Field& field) {
  const bool is_list = field.key == "vehicle" || field.key == "gate";
  return std::string(field.key) + (is_list ? "s" : "");
}

Json layout_json(const LayoutFactor& layout) {
  Json json = {{"name", layout.name}};
  if (layout.mutate) json["mutate"] = true;
  if (layout.map != nullptr) json["content"] = read_json(to_text(layout.map->layout()));
  return json;
}

LayoutFactor layout_from(const Json& json) {
  LayoutFactor layout{json.at("name"), nullptr, json.value("mutate", false)};
  if (json.contains("content"))
    layout.map =
        std::make_shared<const LogicalMap>(parse_layout(json_text(json.at("content")), "layout " + layout.name));
  return layout;
}

Json agent_json(const AgentFactor& agent) {
  if (agent.is_word()) return agent.name;
  Json json = {{"name", agent.name}, {"program", agent.program}};
  if (agent.config) json["config"] = *agent.config;
  if (agent.global_symbols) json["symbols"] = "global";
  if (agent.role != AgentRole::ByOrigin) json["role"] = name_of(agent.role);
  for (const ComputerPart& part : agent.computers) {
    Json& of_computer = json["computers"][part.computer] = {{"program", part.program}};
    if (part.config) of_computer["config"] = *part.config;
    if (part.global_symbols) of_computer["symbols"] = "global";
  }
  return json;
}

void read_part(const Json& json, ProgramPart& part) {
  part.program = json.at("program");
  if (json.contains("config")) part.config = json.at("config").get<std::string>();
  part.global_symbols = json.value("symbols", "local") == "global";
}

AgentFactor agent_from(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  AgentFactor agent;
  agent.name = json.at("name");
  read_part(json, agent);
  if (json.contains("role")) agent.role = value_of<AgentRole>(json.at("role").get<std::string>()).value();
  if (!json.contains("computers")) return agent;
  for (const auto& [computer, part] : json.at("computers").items()) {
    read_part(part, agent.computers.emplace_back());
    agent.computers.back().computer = computer;
  }
  return agent;
}

Json order_json(const ListedOrder& order) {
  return {{"line", order.line},
          {"release_ns", order.release.count()},
          {"from", order.from},
          {"to", order.to},
          {"agv", order.agv ? Json(*order.agv) : Json(nullptr)}};
}

ListedOrder order_from(const Json& json) {
  ListedOrder order{
      Duration{json.at("release_ns").get<std::int64_t>()}, json.at("from"), json.at("to"), {}, json.at("line")};
  if (!json.at("agv").is_null()) order.agv = json.at("agv").get<std::uint32_t>();
  return order;
}

// Writes a plan by its list of fields.
class PlanWriter {
 public:
  explicit PlanWriter(const CampaignPlan& plan) : plan_(plan) {}

  template <HasFields Setup>
  Json json(const Setup& setup) const {
    Json object = Json::object();
    visit_fields(setup, [&](const Field& field, const auto& value) {
      if (field.home == FieldHome::Both && !is_absent(value) && !is_left_out(field))
        object[json_key(field)] = json(value);
    });
    return object;
  }

 private:
  // Plans of before these fields keep their hash.
  static bool is_left_out(const Field& field) {
    return field.left_out &&
           (field.key == kKeep.key || field.key == kCentreAhead.key || field.key == kReverseSpeed.key ||
            field.key == kClocksAgree.key || field.key == kConstantDelayShare.key || field.key == "computers" ||
            field.key == "wire" || field.key == "at_m" || field.key == kComputerFaults.key ||
            field.key == kDiskLosses.key || field.key == kDiskLossLasts.key || field.key == "transports" ||
            field.key == "withdrawn_share");
  }
  template <class Value>
  static bool is_absent(const Value&) {
    return false;
  }
  template <class Shared>
  static bool is_absent(const std::shared_ptr<const Shared>& value) {
    return value == nullptr;
  }
  template <OptionalPlain Maybe>
  static bool is_absent(const Maybe& value) {
    return !value;
  }

  template <PlainValue Plain>
  Json json(const Plain& value) const {
    if constexpr (HasWords<Plain>) {
      return name_of(value);
    } else {
      return value;
    }
  }
  template <OptionalPlain Maybe>
  Json json(const Maybe& value) const {
    return json(*value);
  }
  template <class Item>
  Json json(const std::vector<Item>& items) const {
    Json list = Json::array();
    for (const Item& item : items) list.push_back(json(item));
    return list;
  }
  Json json(Stream stream) const { return name_of(stream); }
  // A value, or its bounds.
  Json json(const FactorSpan& span) const {
    return span.is_drawn() ? Json{{"from", span.from}, {"to", span.to}} : Json(span.from);
  }
  Json json(const std::optional<Vec2>& place_m) const { return {place_m->x(), place_m->y()}; }
  Json json(const AgentFactor& agent) const { return agent_json(agent); }
  Json json(const LayoutFactor& layout) const { return layout_json(layout); }
  Json json(const ExemptPair& pair) const { return Json::array({pair.one, pair.other}); }
  Json json(Purposes purposes) const { return purposes_text(purposes); }
  Json json(const std::optional<std::vector<std::string>>&) const { return plan_.probes_to_meet(); }
  Json json(const std::shared_ptr<const OrderList>& list) const {
    Json orders = Json::array();
    for (const ListedOrder& order : list->orders) orders.push_back(order_json(order));
    return {{"source", list->source}, {"orders", orders}};
  }
  // A recorded message is [sender, receiver, sent_ns, delay_ns], without a delay if it was lost.
  Json json(const std::shared_ptr<const RadioTrace>& trace) const {
    Json messages = Json::array();
    for (const auto& [sender, receiver, sent, delay] : *trace) {
      Json message = Json::array({sender.value, receiver.value, sent.count()});
      if (delay) message.push_back(delay->count());
      messages.push_back(std::move(message));
    }
    return messages;
  }
  Json json(const std::vector<RadioSource>&) const { return nullptr; }  // drawn; has another home

  const CampaignPlan& plan_;
};

GivenValue given_by(const Json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number_float()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  return std::monostate{};
}

// Reads a plan by its list of fields. A field that the text does not contain (it may come from an older version) has
// its default.
class PlanReader {
 public:
  template <HasFields Setup>
  void read(const Json& object, Setup& setup) const {
    visit_fields(setup, [&](const Field& field, auto&& target) {
      if (field.home != FieldHome::Both) return;
      const auto found = object.find(json_key(field));
      if (found != object.end()) value(field, *found, target);
    });
  }

 private:
  [[noreturn]] static void refuse(const Field& field, const Json& json, std::string_view sentence) {
    throw EngineError(fmt::format("the plan in the archive cannot be read: {}: {} is refused: {}", field.key,
                                  json_text(json), sentence));
  }

  template <PlainValue Plain>
  void value(const Field& field, const Json& json, Plain& target) const {
    if (const auto sentence = take(field, given_by(json), target); !sentence.empty()) refuse(field, json, sentence);
  }
  template <OptionalPlain Maybe>
  void value(const Field& field, const Json& json, Maybe& target) const {
    value(field, json, target.emplace());
  }
  template <HasFields Setup>
  void value(const Field&, const Json& json, Setup& target) const {
    read(json, target);
  }
  template <class Item>
  void value(const Field& field, const Json& json, std::vector<Item>& target) const {
    target.clear();
    for (const Json& item : json) value(field, item, target.emplace_back());
  }
  void value(const Field&, const Json& json, std::vector<GateRecord>& gates) const {
    gates.clear();
    for (const Json& item : json) {
      GateRecord& gate = gates.emplace_back();
      gate.index = static_cast<std::uint32_t>(gates.size() - 1);
      read(item, gate);
    }
  }
  void value(const Field& field, const Json& json, Stream& target) const {
    const auto stream = stream_of_name(json.get<std::string>());
    if (!stream) refuse(field, json, "this version knows no such stream");
    target = *stream;
  }
  void value(const Field& field, const Json& json, FactorSpan& target) const {
    if (!json.is_object()) {
      value(field, json, target.from);
      target.to = target.from;
    } else {
      value(field, json.at("from"), target.from);
      value(field, json.at("to"), target.to);
    }
  }
  void value(const Field&, const Json& json, std::optional<Vec2>& target) const {
    target.emplace(json.at(0).get<double>(), json.at(1).get<double>());
  }
  void value(const Field&, const Json& json, AgentFactor& target) const { target = agent_from(json); }
  void value(const Field&, const Json& json, LayoutFactor& target) const { target = layout_from(json); }
  void value(const Field&, const Json& json, ExemptPair& target) const {
    target = {json.at(0).get<std::string>(), json.at(1).get<std::string>()};
  }
  void value(const Field& field, const Json& json, Purposes& target) const {
    const auto purposes = purposes_of_text(json.get<std::string>());
    if (!purposes) refuse(field, json, expected_word({}, kPurposeNames));
    target = *purposes;
  }
  void value(const Field& field, const Json& json, std::optional<std::vector<std::string>>& target) const {
    value(field, json, target.emplace());
  }
  void value(const Field&, const Json& json, std::shared_ptr<const OrderList>& target) const {
    OrderList list{json.at("source"), {}};
    for (const Json& order : json.at("orders")) list.orders.push_back(order_from(order));
    target = std::make_shared<const OrderList>(std::move(list));
  }
  void value(const Field&, const Json& json, std::shared_ptr<const RadioTrace>& target) const {
    RadioTrace trace;
    for (const Json& entry : json) {
      RecordedMessage message{AgvId{entry.at(0).get<std::uint32_t>()}, AgvId{entry.at(1).get<std::uint32_t>()},
                              Duration{entry.at(2).get<std::int64_t>()}, std::nullopt};
      if (entry.size() > 3) message.delay = Duration{entry.at(3).get<std::int64_t>()};
      trace.push_back(message);
    }
    target = std::make_shared<const RadioTrace>(std::move(trace));
  }
  void value(const Field&, const Json&, std::vector<RadioSource>&) const {}  // drawn; has another home
};

}  // namespace

std::string plan_text(const CampaignPlan& plan) {
  Json json = {{"version", kVersion}};
  json.update(PlanWriter(plan).json(plan));
  return json_text(json, 1);
}

CampaignPlan parse_plan(const std::string& text, PlanCells cells) {
  try {
    const Json json = read_json(text);
    if (json.is_discarded()) throw EngineError("the plan in the archive cannot be read: it is no JSON");
    CampaignPlan plan;
    PlanReader().read(json, plan);
    if (plan.agents.empty() || (plan.cell_count() == 0 && cells == PlanCells::Required))
      throw EngineError("the plan in the archive cannot be read: it has no agent or no cell");
    return plan;
  } catch (const Json::exception& error) {
    throw EngineError(fmt::format("the plan in the archive cannot be read: {}", error.what()));
  } catch (const InputError& error) {
    throw EngineError(fmt::format("the plan in the archive cannot be read: {}", error.what()));
  }
}

}  // namespace fleetproof
