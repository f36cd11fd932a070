#include "core/bridges/vda5050/held_order.hpp"

#include <algorithm>

namespace fleetproof::bridges::vda5050 {

std::size_t HeldOrder::base_ahead() const {
  return static_cast<std::size_t>(std::ranges::count_if(nodes_, &Node::released));
}

bool HeldOrder::is_decision_point(const Node& node) const {
  const std::size_t base = base_ahead();
  if (base == 0) return node.node_id == last_node_id_ && node.sequence_id == last_sequence_id_;
  return node.node_id == nodes_[base - 1].node_id && node.sequence_id == nodes_[base - 1].sequence_id;
}

void HeldOrder::stand_at(const std::string& node_id) {
  last_node_id_ = node_id;
  last_sequence_id_ = 0;
}

void HeldOrder::take(const Order& order) {
  order_id_ = order.order_id;
  update_id_ = order.order_update_id;
  nodes_.assign(order.nodes.begin(), order.nodes.end());
  edges_.assign(order.edges.begin(), order.edges.end());
}

void HeldOrder::extend(const Order& order) {
  update_id_ = order.order_update_id;
  std::erase_if(nodes_, [](const Node& node) { return !node.released; });
  std::erase_if(edges_, [](const Edge& edge) { return !edge.released; });
  nodes_.insert(nodes_.end(), order.nodes.begin() + 1, order.nodes.end());
  edges_.insert(edges_.end(), order.edges.begin(), order.edges.end());
}

void HeldOrder::pass_node() {
  last_node_id_ = nodes_.front().node_id;
  last_sequence_id_ = nodes_.front().sequence_id;
  nodes_.pop_front();
  while (!edges_.empty() && edges_.front().sequence_id < last_sequence_id_) edges_.pop_front();
}

void HeldOrder::cut_behind(std::uint32_t sequence_id) {
  std::erase_if(nodes_, [&](const Node& node) { return node.sequence_id > sequence_id; });
  edges_.clear();
}

void HeldOrder::forget_path() {
  nodes_.clear();
  edges_.clear();
}

}  // namespace fleetproof::bridges::vda5050
