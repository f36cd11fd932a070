#include "tests/support/vda5050_documents.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace fleetproof::test::vda5050_model {
namespace {

using nlohmann::json;

// A field that is missing or has another type than the tables of 6.6.6 say.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A rule of 6.6.1 that the graph breaks.
struct BrokenGraph : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const json& field(const json& object, const char* name) {
  if (!object.is_object() || !object.contains(name)) throw Malformed(std::string("no ") + name);
  return object.at(name);
}

std::string text(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_string()) throw Malformed(std::string(name) + " is no string");
  return value.get<std::string>();
}

std::uint32_t uint32(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    throw Malformed(std::string(name) + " is no uint32");
  return value.get<std::uint32_t>();
}

bool boolean(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_boolean()) throw Malformed(std::string(name) + " is no boolean");
  return value.get<bool>();
}

double number(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_number()) throw Malformed(std::string(name) + " is no number");
  return value.get<double>();
}

const json& array(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_array()) throw Malformed(std::string(name) + " is no array");
  return value;
}

void require_header(const json& document) {  // 6.4
  uint32(document, "headerId");
  for (const char* name : {"timestamp", "version", "manufacturer", "serialNumber"}) text(document, name);
}

// Table 3 of 6.12; "all keywords are case sensitive" (6.1).
Blocking blocking_of(const std::string& name) {
  if (name == "NONE") return Blocking::None;
  if (name == "SOFT") return Blocking::Soft;
  if (name == "HARD") return Blocking::Hard;
  throw Malformed("blockingType " + name);
}

std::vector<Action> actions_of(const json& list) {
  std::vector<Action> actions;
  for (const json& entry : list) {
    actions.push_back({text(entry, "actionId"), text(entry, "actionType"), blocking_of(text(entry, "blockingType"))});
  }
  return actions;
}

std::optional<NodePosition> position_of(const json& node) {
  if (!node.contains("nodePosition")) return {};
  const json& position = node.at("nodePosition");
  NodePosition read{{number(position, "x"), number(position, "y")}, 0.0};
  text(position, "mapId");
  // The schema of 2.0.0 spells it allowedDeviationXy.
  for (const char* name : {"allowedDeviationXY", "allowedDeviationXy"}) {
    if (position.contains(name)) read.allowed_deviation_m = number(position, name);
  }
  return read;
}

OrderNode node_of(const json& entry) {
  OrderNode node;
  node.id = text(entry, "nodeId");
  node.sequence = uint32(entry, "sequenceId");
  node.released = boolean(entry, "released");
  node.position = position_of(entry);
  node.actions = actions_of(array(entry, "actions"));
  return node;
}

OrderEdge edge_of(const json& entry) {
  OrderEdge edge;
  edge.id = text(entry, "edgeId");
  edge.sequence = uint32(entry, "sequenceId");
  edge.released = boolean(entry, "released");
  edge.start = text(entry, "startNodeId");
  edge.end = text(entry, "endNodeId");
  edge.actions = actions_of(array(entry, "actions"));
  return edge;
}

void require_sequence(const Order& order) {
  for (std::size_t i = 0; i < order.edges.size(); ++i) {
    const OrderEdge& edge = order.edges[i];
    const OrderNode& from = order.nodes[i];
    const OrderNode& to = order.nodes[i + 1];
    // 6.6.2: the number runs over nodes and edges.
    if (edge.sequence != from.sequence + 1 || to.sequence != edge.sequence + 1) throw BrokenGraph("sequenceId jumps");
    if (edge.start != from.id || edge.end != to.id) throw BrokenGraph("an edge between other nodes");
    // 6.6.1: an edge can be released only if its ends are; nothing released follows an unreleased edge.
    if (edge.released && !(from.released && to.released)) throw BrokenGraph("a released edge with an unreleased end");
    if (!edge.released && to.released) throw BrokenGraph("a released node behind an unreleased edge");
  }
}

void require_unique_actions(const Order& order) {  // 6.6.6: actionId is a "unique ID"
  std::set<std::string> ids;
  const auto add = [&](const std::vector<Action>& actions) {
    for (const Action& action : actions) {
      if (!ids.insert(action.id).second) throw BrokenGraph("actionId twice");
    }
  };
  for (const OrderNode& node : order.nodes) add(node.actions);
  for (const OrderEdge& edge : order.edges) add(edge.actions);
}

void require_graph(const Order& order) {
  // 6.6.1: at least one node, and one edge fewer than nodes.
  if (order.nodes.empty()) throw BrokenGraph("no node");
  if (order.edges.size() + 1 != order.nodes.size()) throw BrokenGraph("edges do not fit the nodes");
  require_sequence(order);
  require_unique_actions(order);
}

std::string_view name_of(Blocking blocking) {
  if (blocking == Blocking::None) return "NONE";
  return blocking == Blocking::Soft ? "SOFT" : "HARD";
}

json written(const Header& header) {
  return {{"headerId", header.id},
          {"timestamp", "2026-01-01T00:00:00.00Z"},
          {"version", header.version},
          {"manufacturer", "maker"},
          {"serialNumber", "1"}};
}

json written(const std::vector<Action>& actions) {
  json list = json::array();
  for (const Action& action : actions) {
    list.push_back({{"actionId", action.id}, {"actionType", action.type}, {"blockingType", name_of(action.blocking)}});
  }
  return list;
}

json written(const OrderNode& node) {
  json object{{"nodeId", node.id},
              {"sequenceId", node.sequence},
              {"released", node.released},
              {"actions", written(node.actions)}};
  if (node.position) {
    object["nodePosition"] = {{"x", node.position->at.x},
                              {"y", node.position->at.y},
                              {"allowedDeviationXY", node.position->allowed_deviation_m},
                              {"mapId", "hall"}};
  }
  return object;
}

json written(const OrderEdge& edge) {
  return {{"edgeId", edge.id},         {"sequenceId", edge.sequence}, {"released", edge.released},
          {"startNodeId", edge.start}, {"endNodeId", edge.end},       {"actions", written(edge.actions)}};
}

}  // namespace

ReadOrder read_order(std::string_view document) {
  ReadOrder read;
  try {
    const json parsed = json::parse(document);
    require_header(parsed);
    read.order.id = text(parsed, "orderId");
    read.order.update = uint32(parsed, "orderUpdateId");
    for (const json& entry : array(parsed, "nodes")) read.order.nodes.push_back(node_of(entry));
    for (const json& entry : array(parsed, "edges")) read.order.edges.push_back(edge_of(entry));
    require_graph(read.order);
  } catch (const BrokenGraph& broken) {
    read.flaw = Flaw::BrokenGraph;
    read.why = broken.what();
  } catch (const std::exception& malformed) {
    read.flaw = Flaw::Malformed;
    read.why = malformed.what();
  }
  return read;
}

ReadInstantActions read_instant_actions(std::string_view document) {
  try {
    const json parsed = json::parse(document);
    require_header(parsed);
    const char* name = parsed.contains("actions") ? "actions" : "instantActions";
    return {actions_of(array(parsed, name)), false};
  } catch (const std::exception&) {
    return {{}, true};
  }
}

std::string write_order(const Order& order, const Header& header) {
  json document = written(header);
  document["orderId"] = order.id;
  document["orderUpdateId"] = order.update;
  document["nodes"] = document["edges"] = json::array();
  for (const OrderNode& node : order.nodes) document["nodes"].push_back(written(node));
  for (const OrderEdge& edge : order.edges) document["edges"].push_back(written(edge));
  return document.dump();
}

std::string write_instant_actions(const std::vector<Action>& actions, const Header& header) {
  json document = written(header);
  document["actions"] = written(actions);
  return document.dump();
}

}  // namespace fleetproof::test::vda5050_model
