#include "tests/support/vda5050_sequences.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace fleetproof::test::vda5050_model {
namespace {

using nlohmann::json;
using Kind = Input::Kind;

constexpr std::uint32_t kGridSide = 3, kGridNodes = kGridSide * kGridSide;
constexpr double kGridPitch_m = 10.0;

std::string grid_node(std::uint32_t index) { return "n" + std::to_string(index); }

Position grid_position(std::uint32_t index) {
  return {kGridPitch_m * (index % kGridSide), kGridPitch_m * (index / kGridSide)};
}

// Temporary nodes (6.6.3.1) are not on the grid.
std::optional<std::uint32_t> grid_index(const std::string& node) {
  for (std::uint32_t i = 0; i < kGridNodes; ++i) {
    if (node == grid_node(i)) return i;
  }
  return {};
}

std::vector<std::uint32_t> neighbours(std::uint32_t index) {
  std::vector<std::uint32_t> found;
  const std::uint32_t column = index % kGridSide, row = index / kGridSide;
  if (column > 0) found.push_back(index - 1);
  if (column + 1 < kGridSide) found.push_back(index + 1);
  if (row > 0) found.push_back(index - kGridSide);
  if (row + 1 < kGridSide) found.push_back(index + kGridSide);
  return found;
}

OrderNode node_on_grid(std::uint32_t index, std::uint32_t sequence) {
  return {grid_node(index), sequence, false, NodePosition{grid_position(index), 0.5}, {}};
}

Input fact(Kind kind) {
  Input input;
  input.kind = kind;
  return input;
}

Input action_fact(Kind kind, const TrackedAction& action) {
  Input input = fact(kind);
  input.action_id = action.action.id;
  return input;
}

Input document(Kind kind, std::string text) {
  Input input = fact(kind);
  input.text = std::move(text);
  return input;
}

// Between nodes: somewhere beside the last node.
Position beside(const State& state) {
  const auto index = grid_index(state.order.last.id);
  const Position from = index ? grid_position(*index) : state.body.position;
  return {from.x + 3.0, from.y + 1.0};
}

// The actions of the horizon, to be sent again with it.
std::vector<Action> planned_actions(const State& state, Scope scope, std::uint32_t sequence) {
  std::vector<Action> actions;
  for (const TrackedAction& action : state.actions) {
    if (action.scope == scope && action.sequence == sequence && !action.released) actions.push_back(action.action);
  }
  return actions;
}

void append_horizon(Order& order, const State& state) {
  for (const EdgeState& edge : state.order.edges) {
    if (edge.released) continue;
    const auto end = std::ranges::find(state.order.nodes, edge.sequence + 1, &NodeState::sequence);
    if (end == state.order.nodes.end()) return;
    order.edges.push_back(
        {edge.id, edge.start, end->id, edge.sequence, false, planned_actions(state, Scope::Edge, edge.sequence)});
    OrderNode node{end->id, end->sequence, false, {}, planned_actions(state, Scope::Node, end->sequence)};
    if (const auto index = grid_index(end->id)) node.position = NodePosition{grid_position(*index), 0.5};
    order.nodes.push_back(std::move(node));
  }
}

// Breaks the types and fields of 6.6.6, or the graph of 6.6.1.
std::string broken(std::string order, std::uint32_t how) {
  json parsed = json::parse(order);
  switch (how) {
    case 0:
      return order.substr(0, order.size() / 2);
    case 1:
      parsed.erase("orderId");
      break;
    case 2:
      parsed["orderUpdateId"] = "1";
      break;
    case 3:
      parsed["nodes"][0].erase("actions");
      break;
    case 4:
      parsed["nodes"][0]["actions"] = {{{"actionId", "x"}, {"actionType", "beep"}, {"blockingType", "none"}}};
      break;
    case 5:
      parsed["nodes"][0]["released"] = "true";
      break;
    case 6:
      parsed["nodes"] = parsed["edges"] = json::array();
      break;
    case 7:
      parsed["edges"].push_back({{"edgeId", "loose"},
                                 {"sequenceId", 77},
                                 {"released", true},
                                 {"startNodeId", "n0"},
                                 {"endNodeId", "n1"},
                                 {"actions", json::array()}});
      break;
    default:
      parsed["nodes"][0]["sequenceId"] = -1;
      break;
  }
  return parsed.dump();
}

constexpr std::uint32_t kWaysToBreak = 9;

}  // namespace

VehicleTraits grid_traits(Version version, bool stops_between_nodes) {
  VehicleTraits traits;
  traits.version = version;
  traits.stops_between_nodes = stops_between_nodes;
  traits.start_node = grid_node(4);
  traits.start_position = grid_position(4);
  return traits;
}

SequenceDrawer::SequenceDrawer(VehicleTraits traits, SequenceSettings settings)
    : traits_(std::move(traits)), settings_(settings), random_(settings.seed) {}

// SplitMix64.
double SequenceDrawer::share() {
  random_ += 0x9e3779b97f4a7c15U;
  std::uint64_t z = random_;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  z ^= z >> 31U;
  return static_cast<double>(z >> 11U) * 0x1.0p-53;
}

std::uint32_t SequenceDrawer::below(std::uint32_t n) {
  return static_cast<std::uint32_t>(share() * static_cast<double>(n));
}

std::optional<Input> SequenceDrawer::next(const VehicleModel& model) {
  if (steps_++ >= settings_.steps) return {};
  const State& state = model.plain_state();
  if (auto input = first_node(state)) return input;
  if (settings_.restarts && chance(0.01)) return fact(Kind::Restarted);
  if (!state.body.online && chance(0.2)) return fact(Kind::ConnectionRestored);
  if (state.body.online && chance(0.03)) return fact(Kind::ConnectionLost);
  // Master control keeps the base short, and waits for the end of a cancel.
  const bool waits = state.order.cancel == Cancel::Running || state.order.nodes.size() > 5;
  const bool master = state.body.online && chance(waits ? 0.2 : 0.35);
  if (!master) {
    if (auto input = body_fact(state)) return input;
  }
  if (!state.body.online) return fact(Kind::ConnectionRestored);
  return message(state);
}

// ---- the body

// The AGV stands on or in reach of the first node of a new order, or the order would have been rejected.
std::optional<Input> SequenceDrawer::first_node(const State& state) {
  const bool ahead = state.order.cancel == Cancel::No && state.order.nodes.size() > state.order.edges.size();
  if (!ahead || !state.order.nodes.front().released) return {};
  Input input = reach(state.order.nodes.front());
  input.position = state.body.position;
  input.may_be_known = true;
  return input;
}

Input SequenceDrawer::reach(const NodeState& node) {
  Input input = fact(Kind::NodeReached);
  input.node_id = node.id;
  input.sequence = node.sequence;
  if (const auto index = grid_index(node.id)) input.position = grid_position(*index);
  return input;
}

std::optional<Input> SequenceDrawer::body_fact(const State& state) {
  if (state.pause.requested && chance(0.5)) {
    Input input = fact(Kind::PauseEffective);
    input.on = *state.pause.requested;
    return input;
  }
  if (chance(0.5)) {
    if (auto input = act(state)) return input;
  }
  auto input = state.order.cancel == Cancel::Running ? stop_for_cancel(state) : move(state);
  return input ? input : act(state);
}

std::optional<Input> SequenceDrawer::move(const State& state) {
  if (state.order.nodes.empty() || state.order.edges.empty()) return {};
  const NodeState& next = state.order.nodes.front();
  const EdgeState& ahead = state.order.edges.front();
  if (!next.released || !ahead.released || next.sequence != ahead.sequence + 1) return {};
  const bool moving = state.body.motion == Motion::Moving;
  if (drivable_edges(state, traits_).empty()) {
    // An AGV that brakes for a pause may still reach the node.
    const bool brakes = state.pause.requested == true && !state.pause.paused && moving;
    if (brakes && chance(0.1)) return reach(next);
    return {};
  }
  if (moving || chance(0.6)) return reach(next);
  Input input = fact(Kind::EdgeEntered);
  input.sequence = ahead.sequence;
  return input;
}

std::optional<Input> SequenceDrawer::stop_for_cancel(const State& state) {
  if (state.body.motion == Motion::Standing) return {};
  const bool on_node = !state.body.on_node.empty();
  if (!traits_.stops_between_nodes && !state.order.nodes.empty() && (!on_node || chance(0.5))) {
    if (drivable_edges(state, traits_).empty()) return {};  // paused on its way: it goes on after the pause
    return reach(state.order.nodes.front());
  }
  if (!traits_.stops_between_nodes && !on_node) return {};
  Input input = fact(Kind::Stopped);
  input.node_id = state.body.on_node;
  input.position = on_node ? state.body.position : beside(state);
  return input;
}

std::optional<Input> SequenceDrawer::act(const State& state) {
  const bool pausing = state.pause.paused || state.pause.requested == true;
  std::vector<Input> possible;
  for (const TrackedAction& action : state.actions) {
    if (action.scope == Scope::Control || is_over(action)) continue;
    const bool interrupted =
        action.may_be_interrupted && state.order.cancel == Cancel::Running && is_order_action(action);
    if (interrupted) {
      Input failed = action_fact(Kind::ActionFailed, action);
      failed.may_be_known = true;
      possible.push_back(failed);
    } else if (pausing && !settings_.actions_continue_in_pause) {
      continue;
    } else if (action.phase == Phase::Begun) {
      possible.push_back(action_fact(chance(0.15) ? Kind::ActionFailed : Kind::ActionFinished, action));
    } else if (action.phase == Phase::Triggered && !is_held_back(state, action)) {
      possible.push_back(action_fact(Kind::ActionBegun, action));
    }
  }
  if (possible.empty()) return {};
  return possible[below(static_cast<std::uint32_t>(possible.size()))];
}

// ---- master control

Header SequenceDrawer::header() { return {headers_++, traits_.version == Version::V2_0_0 ? "2.0.0" : "2.1.0"}; }

Input SequenceDrawer::message(const State& state) {
  const bool cancels = state.order.cancel == Cancel::Running;
  if (chance(cancels ? 0.6 : 0.35)) return instant_action(state);
  if (chance(settings_.wrong_share)) return wrong_order(state);
  return order(state);
}

Input SequenceDrawer::instant_action(const State& state) {
  struct Choice {
    const char* type;
    double weight;
    Blocking blocking;
  };
  const double resume = state.pause.paused || state.pause.requested == true ? 8.0 : 0.5;
  const std::array<Choice, 8> choices{{{"startPause", 1.5, Blocking::Hard},
                                       {"stopPause", resume, Blocking::Hard},
                                       {"cancelOrder", is_executing(state) ? 1.5 : 0.5, Blocking::Hard},
                                       {"stateRequest", 1.0, Blocking::None},
                                       {"factsheetRequest", 0.7, Blocking::None},
                                       {"beep", 0.8, Blocking::None},
                                       {"finePositioning", 0.2, Blocking::Soft},
                                       {"lift", 0.2, Blocking::Hard}}};
  double total = 0.0;
  for (const Choice& choice : choices) total += choice.weight;
  double left = share() * total;
  const Choice* chosen = &choices.back();
  for (const Choice& choice : choices) {
    left -= choice.weight;
    if (left < 0.0) {
      chosen = &choice;
      break;
    }
  }
  const Action action{"i" + std::to_string(actions_++), chosen->type, chosen->blocking};
  return document(Kind::InstantActions, write_instant_actions({action}, header()));
}

Input SequenceDrawer::order(const State& state) {
  const bool continues = is_executing(state) || chance(0.2);
  const bool has_order = !state.order.id.empty() && !decision_point(state).id.empty();
  return sent(continues && has_order ? update(state) : new_order(state));
}

Input SequenceDrawer::sent(const Order& order) {
  last_sent_ = write_order(order, header());
  return document(Kind::Order, last_sent_);
}

std::vector<Action> SequenceDrawer::draw_actions(double p) {
  static constexpr std::array<std::string_view, 5> kDrawnTypes{"pick", "drop", "beep", "wait", "detectObject"};
  std::vector<Action> actions;
  while (chance(p) && actions.size() < 4) {
    actions.push_back({"a" + std::to_string(actions_++), std::string(kDrawnTypes.at(below(kDrawnTypes.size()))),
                       static_cast<Blocking>(below(3))});
  }
  return actions;
}

void SequenceDrawer::extend(Order& order, std::uint32_t edges) {
  for (std::uint32_t i = 0; i < edges; ++i) {
    const OrderNode& from = order.nodes.back();
    const auto index = grid_index(from.id);
    const auto around = index ? neighbours(*index) : std::vector<std::uint32_t>{0, 4, 8};
    OrderNode to = node_on_grid(around[below(static_cast<std::uint32_t>(around.size()))], from.sequence + 2);
    to.actions = draw_actions(0.3);
    order.edges.push_back({from.id + "-" + to.id, from.id, to.id, from.sequence + 1, false, draw_actions(0.15)});
    order.nodes.push_back(std::move(to));
  }
}

void SequenceDrawer::release(Order& order, std::uint32_t nodes) {
  for (std::uint32_t i = 0; i < nodes; ++i) {
    order.nodes[i].released = true;
    if (i > 0) order.edges[i - 1].released = true;
  }
}

Order SequenceDrawer::new_order(const State& state) {
  Order order;
  order.id = "order-" + std::to_string(orders_++);
  order.update = chance(0.9) ? 0 : below(5);
  OrderNode first;
  const Position here = state.body.position;
  if (!state.body.on_node.empty()) {
    first = {state.body.on_node, 0, true, NodePosition{here, 0.5}, {}};
  } else if (grid_index(state.order.last.id) && chance(0.5)) {
    // 6.6.3.1: the last node with a deviation so large that the AGV is within.
    first = {state.order.last.id, 0, true, NodePosition{grid_position(*grid_index(state.order.last.id)), 30.0}, {}};
  } else {
    // 6.6.3.1: a temporary node where the AGV stands.
    first = {"t" + std::to_string(orders_), 0, true, NodePosition{here, 0.5}, {}};
  }
  first.actions = draw_actions(0.2);
  order.nodes.push_back(std::move(first));
  extend(order, below(5));
  release(order, 1 + below(static_cast<std::uint32_t>(order.nodes.size())));
  return order;
}

Order SequenceDrawer::update(const State& state) {
  Order order;
  order.id = state.order.id;
  order.update = state.order.update + (chance(0.85) ? 1 : 2 + below(5));
  const LastNode point = decision_point(state);
  OrderNode stitching{point.id, point.sequence, true, {}, {}};
  if (const auto index = grid_index(point.id)) stitching.position = NodePosition{grid_position(*index), 0.5};
  // "The contents of the stitching node are not changed" (6.6.2): what is sent with it does not count.
  if (chance(0.1)) stitching.actions = draw_actions(0.7);
  order.nodes.push_back(std::move(stitching));
  if (chance(0.6)) append_horizon(order, state);
  extend(order, below(4));
  release(order, 1 + below(static_cast<std::uint32_t>(order.nodes.size())));
  return order;
}

Input SequenceDrawer::wrong_order(const State& state) {
  // "This might happen, if the master control resends the order" (6.6.4.3).
  if (!last_sent_.empty() && chance(0.15)) return document(Kind::Order, last_sent_);
  const bool has_order = !state.order.id.empty() && !decision_point(state).id.empty();
  Order changed = has_order ? update(state) : new_order(state);
  switch (below(7)) {
    case 0:  // lower
      if (state.order.update == 0 || !has_order) break;
      changed.update = below(state.order.update);
      return sent(changed);
    case 1:  // equal, with other contents
      if (!has_order) break;
      changed.update = state.order.update;
      return sent(changed);
    case 2:  // another first node
      if (!has_order) break;
      changed.nodes.front().id += "-other";
      if (!changed.edges.empty()) changed.edges.front().start += "-other";
      return sent(changed);
    case 3:  // the right node, another time that it is passed
      if (!has_order) break;
      for (OrderNode& node : changed.nodes) node.sequence += 2;
      for (OrderEdge& edge : changed.edges) edge.sequence += 2;
      return sent(changed);
    case 4:  // a new order while the old one is active, or far away
      changed = new_order(state);
      if (is_executing(state)) return sent(changed);
      changed.nodes.front().id = "far";
      changed.nodes.front().position = NodePosition{{500.0, 500.0}, 1.0};
      if (!changed.edges.empty()) changed.edges.front().start = "far";
      return sent(changed);
    case 5: {
      changed.nodes.back().actions.push_back({"a" + std::to_string(actions_++), "fly", Blocking::Hard});
      return sent(changed);
    }
    default:
      break;
  }
  return document(Kind::Order, broken(write_order(changed, header()), below(kWaysToBreak)));
}

std::vector<Input> draw_sequence(const VehicleTraits& traits, const SequenceSettings& settings) {
  VehicleModel model(traits);
  SequenceDrawer drawer(traits, settings);
  std::vector<Input> inputs;
  while (auto input = drawer.next(model)) {
    model.apply(*input);
    model.assume_plain_reading();
    inputs.push_back(std::move(*input));
  }
  return inputs;
}

}  // namespace fleetproof::test::vda5050_model
