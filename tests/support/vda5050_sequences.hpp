#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/vda5050_model.hpp"

// Draws what master control sends and what the body of the AGV does, step by step: on a grid of nine nodes, mostly
// valid, with a share of wrong orders. One seed gives one sequence, as long as the model decides the same.
namespace fleetproof::test::vda5050_model {

struct SequenceSettings {
  std::uint64_t seed = 1;
  std::size_t steps = 40;
  double wrong_share = 0.15;               // of the orders and updates
  bool actions_continue_in_pause = false;  // actions may also end while the AGV is paused (6.8.1)
  bool restarts = true;
};

// Traits whose start node is on the grid of the sequences.
VehicleTraits grid_traits(Version version, bool stops_between_nodes);

class SequenceDrawer {
 public:
  SequenceDrawer(VehicleTraits traits, SequenceSettings settings);

  // The next input, which fits what the model says of the AGV now; nothing at the end of the sequence. Call it with a
  // model that has applied all inputs before and, if there is an AGV, has judged its reports: then facts follow the
  // choices of the AGV.
  std::optional<Input> next(const VehicleModel& model);

 private:
  double share();  // in [0, 1)
  std::uint32_t below(std::uint32_t n);
  bool chance(double p) { return share() < p; }

  // What the body does.
  std::optional<Input> body_fact(const State& state);
  std::optional<Input> first_node(const State& state);
  std::optional<Input> move(const State& state);
  std::optional<Input> stop_for_cancel(const State& state);
  std::optional<Input> act(const State& state);
  Input reach(const NodeState& node);

  // What master control sends.
  Input message(const State& state);
  Input instant_action(const State& state);
  Input order(const State& state);
  Input wrong_order(const State& state);
  Order new_order(const State& state);
  Order update(const State& state);
  void extend(Order& order, std::uint32_t edges);
  void release(Order& order, std::uint32_t nodes);
  std::vector<Action> draw_actions(double p);
  Input sent(const Order& order);
  Header header();

  VehicleTraits traits_;
  SequenceSettings settings_;
  std::uint64_t random_;
  std::size_t steps_ = 0;
  std::uint32_t orders_ = 0, actions_ = 0, headers_ = 0;
  std::string last_sent_;  // an order, to be repeated
};

// A whole sequence for an AGV that always takes the plain reading.
std::vector<Input> draw_sequence(const VehicleTraits& traits, const SequenceSettings& settings);

}  // namespace fleetproof::test::vda5050_model
