#pragma once

#include <gmock/gmock.h>

#include <map>

#include "core/bridges/vda5050/vehicle_protocol.hpp"
#include "tests/support/vda5050_rules.hpp"

// A vehicle of VDA 5050 without a body: a test says what the master sends and what the body does. Every message that it
// publishes is checked against the rules of the standard.
namespace fleetproof::test::vda5050 {

using namespace fleetproof::bridges::vda5050;

// What a node or edge of an order has beside its name.
struct Element {
  std::string id;
  std::vector<Action> actions = {};
};

inline Action action(std::string type, std::string id, BlockingType blocking = BlockingType::None,
                     std::optional<std::vector<ActionParameter>> parameters = {}) {
  return {std::move(type), std::move(id), {}, blocking, std::move(parameters)};
}

// Nodes and edges in turn, from this sequenceId on. The first `base` nodes, and the edges between them, are released.
inline Order order(std::string id, std::uint32_t update, std::vector<Element> elements, std::size_t base,
                   std::uint32_t first_sequence = 0) {
  Order order;
  order.header = {0, "2026-01-01T00:00:00.00Z", "2.1.0", "fp", "agv1"};
  order.order_id = std::move(id);
  order.order_update_id = update;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto sequence = first_sequence + static_cast<std::uint32_t>(i);
    const bool is_released = i < 2 * base - 1;
    if (i % 2 == 0) {
      order.nodes.push_back({elements[i].id, sequence, {}, is_released, {}, elements[i].actions});
    } else {
      Edge edge;
      edge.edge_id = elements[i].id;
      edge.sequence_id = sequence;
      edge.released = is_released;
      edge.start_node_id = elements[i - 1].id;
      edge.end_node_id = elements[i + 1].id;
      edge.actions = elements[i].actions;
      order.edges.push_back(edge);
    }
  }
  return order;
}

// "a -ab- b -bc- c" and so on: names of nodes are letters.
inline std::vector<Element> way(const std::string& letters) {
  std::vector<Element> elements;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (i > 0) elements.push_back({letters.substr(i - 1, 2)});
    elements.push_back({letters.substr(i, 1)});
  }
  return elements;
}

class Vda5050Bench : public testing::Test {
 protected:
  // Abilities: `lift` (nodes, cannot be interrupted), `scan` (everywhere, can be cancelled and paused).
  Vda5050Bench() { restart(settings()); }

  static VehicleSettings settings() {
    VehicleSettings settings;
    settings.identity = {find_version("2.1"), "fp", "agv1", 1'767'225'600};
    settings.abilities.actions = {{"lift", true, false, false, {}, false, false},
                                  {"scan", true, true, true, {}, true, true}};
    return settings;
  }

  // A vehicle that has just been switched on at node "a", and has said so.
  void restart(const VehicleSettings& with, bool is_connected = true) {
    version_ = std::string(with.identity.version->number);
    published_.clear();
    wishes_.clear();
    vehicle_ = std::make_unique<VehicleProtocol>(with, Factsheet{});
    hear(StandsAt{"a"});
    if (is_connected) hear(ConnectionOpened{});
  }

  void hear(const Fact& fact) {
    vehicle_->hear(fact);
    collect();
  }
  void send(const Order& order) { send_order_text(write_document(order, *find_version(version_))); }
  void send_order_text(const std::string& text) {
    vehicle_->order_received(text);
    collect();
  }
  void send(const Action& action) {
    const InstantActions message{{0, "2026-01-01T00:00:00.00Z", "2.1.0", "fp", "agv1"}, {action}};
    vehicle_->instant_actions_received(write_document(message, *find_version(version_)));
    collect();
  }
  void pass_seconds(int seconds) {
    now_ns_ += seconds * 1'000'000'000ll;
    collect();
  }

  // Drives the first edge that it may begin to its end, without a stop in between if it `rolls` on.
  void drive_edge(bool rolls = false) {
    const DrivingWish wish = vehicle_->driving_wish();
    ASSERT_FALSE(wish.edges.empty());
    begin_edge();
    const std::uint32_t node = wish.edges[0].sequence_id + 1;
    if (!rolls) hear(Driving{false});
    hear(NodeReached{node});
  }
  void begin_edge() {
    hear(EdgeBegun{vehicle_->driving_wish().edges.at(0).sequence_id});
    hear(Driving{true});
  }
  void finish(const std::string& action_id) {
    hear(ActionBegun{action_id});
    hear(ActionFinished{action_id, "done"});
  }

  // The edges that it may begin, as "ab bc"; "hold" if it has to stand.
  std::string driving() const {
    const DrivingWish wish = vehicle_->driving_wish();
    std::string text = wish.hold ? "hold" : "";
    for (const Edge& edge : wish.edges) text += (text.empty() ? "" : " ") + edge.edge_id;
    return text;
  }
  // Since the last look: "Start lift1, Cancel scan1".
  std::string wishes() { return std::exchange(wishes_, {}); }
  std::string status(const std::string& action_id) const {
    constexpr std::array kWordsOfStatus = {"WAITING", "INITIALIZING", "RUNNING", "PAUSED", "FINISHED", "FAILED"};
    for (const ActionState& state : state().action_states) {
      if (state.action_id == action_id) return kWordsOfStatus[static_cast<std::size_t>(state.action_status)];
    }
    return "unknown";
  }
  std::string nodes() const {
    std::string text;
    for (const NodeState& node : state().node_states) text += node.released ? node.node_id : "(" + node.node_id + ")";
    return text;
  }
  std::string edges() const {
    std::string text;
    for (const EdgeState& edge : state().edge_states)
      text += (text.empty() ? "" : " ") + (edge.released ? edge.edge_id : "(" + edge.edge_id + ")");
    return text;
  }
  std::string errors() const {
    std::string text;
    for (const Error& error : state().errors) text += (text.empty() ? "" : " ") + error.error_type;
    return text;
  }
  State state() const { return vehicle_->state(); }
  VehicleProtocol& vehicle() { return *vehicle_; }
  // What was published since the last look.
  std::vector<Publication> published() { return std::exchange(published_, {}); }
  std::string topics() {
    std::string text;
    for (const Publication& message : published())
      text += (text.empty() ? "" : " ") + std::string(topic_word(message.topic));
    return text;
  }
  std::int64_t now_ns_ = 0;

 private:
  void collect() {
    for (Publication& message : vehicle_->publish(now_ns_)) {
      EXPECT_THAT(broken_rules(message.payload, topic_word(message.topic), version_), testing::IsEmpty());
      published_.push_back(std::move(message));
    }
    constexpr std::array kWordsOfWishes = {"Start", "Pause", "Resume", "Cancel", "End"};
    for (const ActionWish& wish : vehicle_->take_action_wishes())
      wishes_ += (wishes_.empty() ? "" : ", ") + std::string(kWordsOfWishes[static_cast<std::size_t>(wish.kind)]) +
                 " " + wish.action.action_id;
  }

  std::string version_;
  std::unique_ptr<VehicleProtocol> vehicle_;
  std::vector<Publication> published_;
  std::string wishes_;
};

}  // namespace fleetproof::test::vda5050
