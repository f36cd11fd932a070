#include "core/bridges/vda5050/order_check.hpp"

#include <algorithm>
#include <set>

namespace fleetproof::bridges::vda5050 {
namespace {

Refusal malformed(std::string why, std::vector<Reference> references = {}) {
  return {"validationError", std::move(why), std::move(references)};
}

Refusal unable(std::string why, std::vector<Reference> references) {
  return {"orderError", std::move(why), std::move(references)};
}

std::optional<Refusal> refuse_numbers(const Order& order) {
  std::optional<Refusal> refusal;
  std::uint32_t next = order.nodes.front().sequence_id;
  traverse(order, [&](const auto& element) {
    if (element.sequence_id != next && !refusal)
      refusal = malformed("the sequenceIds of nodes and edges do not count up by one",
                          {{"sequenceId", std::to_string(element.sequence_id)}});
    next = element.sequence_id + 1;
  });
  return refusal;
}

std::optional<Refusal> refuse_release(const Order& order) {
  if (!order.nodes.front().released)
    return malformed("the first node is not released", {{"nodeId", order.nodes.front().node_id}});
  std::optional<Refusal> refusal;
  bool is_base = true;
  traverse(order, [&](const auto& element) {
    if (element.released && !is_base && !refusal)
      refusal = malformed("a released node or edge follows one that is not released",
                          {{"sequenceId", std::to_string(element.sequence_id)}});
    is_base = is_base && element.released;
  });
  // The base ends at a node: an edge is released only if both its nodes are.
  for (std::size_t i = 0; i < order.edges.size() && !refusal; ++i) {
    if (order.edges[i].released && !order.nodes[i + 1].released)
      refusal = malformed("an edge is released, and the node at its end is not", {{"edgeId", order.edges[i].edge_id}});
  }
  return refusal;
}

std::optional<Refusal> refuse_repeated_actions(const Order& order) {
  std::optional<Refusal> refusal;
  std::set<std::string_view> ids;
  traverse(order, [&](const auto& element) {
    for (const Action& action : element.actions) {
      if (!ids.insert(action.action_id).second && !refusal)
        refusal = malformed("two actions have the same actionId", {{"actionId", action.action_id}});
    }
  });
  return refusal;
}

// Collects what an order uses and the vehicle does not obey.
class FieldUse {
 public:
  FieldUse(const Abilities& abilities, std::string key, const std::string& id)
      : abilities_(abilities), id_key_(std::move(key)), id_(id) {}

  void operator()(bool is_present, std::string_view field) {
    if (is_present && std::ranges::find(abilities_.optional_fields, field) == abilities_.optional_fields.end())
      unusable.push_back({std::string(field), id_});
  }

  std::optional<Refusal> refusal() {
    if (unusable.empty()) return {};
    const std::string why = "the vehicle cannot use " + unusable.front().reference_key;
    unusable.push_back({id_key_, id_});
    return unable(why, unusable);
  }

  std::vector<Reference> unusable;

 private:
  const Abilities& abilities_;
  std::string id_key_;
  const std::string& id_;
};

std::optional<Refusal> refuse_fields(const Node& node, const Abilities& abilities) {
  if (!node.node_position) return {};
  const NodePosition& position = *node.node_position;
  FieldUse use(abilities, "nodeId", node.node_id);
  use(true, "order.nodes.nodePosition");
  use(position.theta.has_value(), "order.nodes.nodePosition.theta");
  use(position.allowed_deviation_xy.has_value(), "order.nodes.nodePosition.allowedDeviationXY");
  use(position.allowed_deviation_theta.has_value(), "order.nodes.nodePosition.allowedDeviationTheta");
  if (std::optional<Refusal> refusal = use.refusal()) return refusal;
  const bool can_be_used = std::ranges::any_of(abilities.maps, [&](const Map& map) {
    return map.map_id == position.map_id && map.map_status == MapStatus::Enabled;
  });
  if (abilities.maps.empty() || can_be_used) return {};
  return unable("the map of a node is not on the vehicle, or not enabled",
                {{"mapId", position.map_id}, {"nodeId", node.node_id}});
}

std::optional<Refusal> refuse_fields(const Edge& edge, const Abilities& abilities) {
  FieldUse use(abilities, "edgeId", edge.edge_id);
  use(edge.max_speed.has_value(), "order.edges.maxSpeed");
  use(edge.max_height.has_value(), "order.edges.maxHeight");
  use(edge.min_height.has_value(), "order.edges.minHeight");
  use(edge.orientation.has_value(), "order.edges.orientation");
  use(edge.orientation_type.has_value(), "order.edges.orientationType");
  use(edge.direction.has_value(), "order.edges.direction");
  use(edge.rotation_allowed.has_value(), "order.edges.rotationAllowed");
  use(edge.max_rotation_speed.has_value(), "order.edges.maxRotationSpeed");
  use(edge.trajectory.has_value(), "order.edges.trajectory");
  use(edge.corridor.has_value(), "order.edges.corridor");
  return use.refusal();
}

ActionScope scope_of(const Node&) { return ActionScope::Node; }
ActionScope scope_of(const Edge&) { return ActionScope::Edge; }
const std::string& id_of(const Node& node) { return node.node_id; }
const std::string& id_of(const Edge& edge) { return edge.edge_id; }

std::optional<Refusal> refuse_size(const Order& order, const Abilities& abilities) {
  if (order.nodes.size() > abilities.most_nodes) return unable("too many nodes", {{"nodes", "too many"}});
  std::size_t actions = 0, longest = order.order_id.size();
  traverse(order, [&](const auto& element) {
    actions += element.actions.size();
    longest = std::max(longest, id_of(element).size());
    for (const Action& action : element.actions) longest = std::max(longest, action.action_id.size());
  });
  if (actions > abilities.most_actions) return unable("too many actions", {{"actions", "too many"}});
  if (longest > abilities.longest_id) return unable("an id is too long", {{"id", "too long"}});
  return {};
}

}  // namespace

const Ability* Abilities::find(std::string_view action_type) const {
  const auto found = std::ranges::find(actions, action_type, &Ability::action_type);
  return found == actions.end() ? nullptr : &*found;
}

std::optional<Refusal> refuse_malformed(const Order& order) {
  if (order.order_id.empty()) return malformed("the orderId is empty");
  if (order.nodes.empty()) return malformed("an order needs at least one node", {{"nodes", "0"}});
  if (order.edges.size() + 1 != order.nodes.size())
    return malformed("an order needs one edge fewer than nodes", {{"edges", std::to_string(order.edges.size())}});
  for (std::size_t i = 0; i < order.edges.size(); ++i) {
    const Edge& edge = order.edges[i];
    if (edge.start_node_id != order.nodes[i].node_id || edge.end_node_id != order.nodes[i + 1].node_id)
      return malformed("an edge does not connect the nodes beside it", {{"edgeId", edge.edge_id}});
  }
  if (std::optional<Refusal> refusal = refuse_numbers(order)) return refusal;
  if (std::optional<Refusal> refusal = refuse_release(order)) return refusal;
  return refuse_repeated_actions(order);
}

std::optional<Refusal> refuse_unable(const Action& action, ActionScope scope, const Abilities& abilities) {
  const auto refuse = [&](const std::string& why) {
    return unable(why, {{"actionId", action.action_id}, {"actionType", action.action_type}});
  };
  const Ability* ability = abilities.find(action.action_type);
  if (ability == nullptr) return refuse("the vehicle cannot carry out such an action");
  const bool is_in_scope = scope == ActionScope::Node   ? ability->on_nodes
                           : scope == ActionScope::Edge ? ability->on_edges
                                                        : ability->as_instant_action;
  if (!is_in_scope) return refuse("the vehicle cannot carry out such an action there");
  if (std::ranges::find(ability->blocking_types, action.blocking_type) == ability->blocking_types.end())
    return refuse("the vehicle cannot carry out the action with this blockingType");
  for (const std::string& key : ability->needed_parameters) {
    if (action.parameter(key) == nullptr) return refuse("the action lacks the parameter " + key);
  }
  return {};
}

std::optional<Refusal> refuse_unable(const Order& order, const Abilities& abilities) {
  std::optional<Refusal> refusal = refuse_size(order, abilities);
  if (!refusal && order.zone_set_id)
    refusal = unable("the vehicle has no zones", {{"order.zoneSetId", *order.zone_set_id}});
  traverse(order, [&](const auto& element) {
    if (!refusal) refusal = refuse_fields(element, abilities);
    for (const Action& action : element.actions) {
      if (!refusal) refusal = refuse_unable(action, scope_of(element), abilities);
    }
  });
  return refusal;
}

}  // namespace fleetproof::bridges::vda5050
