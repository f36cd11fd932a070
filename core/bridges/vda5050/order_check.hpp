#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/bridges/vda5050/documents.hpp"

// What a vehicle can do, and whether it can do what an order asks.
namespace fleetproof::bridges::vda5050 {

// An action that the vehicle can carry out.
struct Ability {
  std::string action_type;
  bool on_nodes = true, on_edges = false, as_instant_action = false;
  std::vector<std::string> needed_parameters{};
  bool can_be_cancelled = false;  // while it runs: at once
  bool can_be_paused = false;
  std::vector<BlockingType> blocking_types = {BlockingType::None, BlockingType::Soft, BlockingType::Hard};
};

struct Abilities {
  std::vector<Ability> actions;
  // The optional fields that the vehicle obeys, as in "order.edges.maxSpeed". An order with any other is refused, for a
  // vehicle must not ignore it (6.1.1). Descriptions and the length of an edge ask for nothing.
  std::vector<std::string> optional_fields = {"order.nodes.nodePosition",
                                              "order.nodes.nodePosition.allowedDeviationXY"};
  std::vector<Map> maps;  // on the vehicle; none: it needs none, and takes orders on any
  std::uint32_t most_nodes = 1000, most_actions = 1000;
  std::uint32_t longest_id = 128;

  const Ability* find(std::string_view action_type) const;
};

// Why an order is not taken over, as the standard has it reported.
struct Refusal {
  std::string error_type;  // "validationError", "orderError", ...
  std::string why;
  std::vector<Reference> references;
};

// Calls `visit(node)` and `visit(edge)` in the order in which they are traversed. An order that is not malformed has
// one edge between two nodes.
template <class Visit>
void traverse(const Order& order, Visit visit) {
  for (std::size_t i = 0; i < order.nodes.size(); ++i) {
    visit(order.nodes[i]);
    if (i < order.edges.size()) visit(order.edges[i]);
  }
}

// What is wrong with the graph of an order by itself: a validationError.
std::optional<Refusal> refuse_malformed(const Order& order);
// What this vehicle cannot do of it: an orderError, with the wrong fields and actions as references.
std::optional<Refusal> refuse_unable(const Order& order, const Abilities& abilities);
// The same for one action, `scope` being one of Node, Edge and Instant.
std::optional<Refusal> refuse_unable(const Action& action, ActionScope scope, const Abilities& abilities);

}  // namespace fleetproof::bridges::vda5050
