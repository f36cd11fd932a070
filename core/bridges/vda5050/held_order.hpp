#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/bridges/vda5050/documents.hpp"

// The order that a vehicle holds: what of its base and horizon is not traversed yet (6.6.1, 6.6.2).
namespace fleetproof::bridges::vda5050 {

class HeldOrder {
 public:
  const std::string& order_id() const { return order_id_; }
  std::uint32_t update_id() const { return update_id_; }
  const std::string& last_node_id() const { return last_node_id_; }
  std::uint32_t last_sequence_id() const { return last_sequence_id_; }

  // Not traversed, in order. The edge that leads to a node stands before it in the sequence.
  const std::deque<Node>& nodes() const { return nodes_; }
  const std::deque<Edge>& edges() const { return edges_; }
  bool has_horizon() const { return !nodes_.empty() && !nodes_.back().released; }
  // The released nodes ahead.
  std::size_t base_ahead() const;

  // Whether this is the last node of the base, at which an update has to begin. If the base is done, that is the node
  // traversed last.
  bool is_decision_point(const Node& node) const;

  // Where the vehicle is before it has an order.
  void stand_at(const std::string& node_id);
  void take(const Order& order);
  // Replaces the horizon. The first node is the decision point, which stays as it is.
  void extend(const Order& order);

  // The first node ahead is traversed, and so is the edge that led to it.
  void pass_node();
  // Forgets all edges, and all nodes behind this sequenceId.
  void cut_behind(std::uint32_t sequence_id);
  void forget_path();

 private:
  std::string order_id_;
  std::uint32_t update_id_ = 0;
  std::string last_node_id_;
  std::uint32_t last_sequence_id_ = 0;
  std::deque<Node> nodes_;
  std::deque<Edge> edges_;
};

}  // namespace fleetproof::bridges::vda5050
