#include "tests/support/vda5050_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetproof::test::vda5050_model {
namespace {

using enum Status;
using Possible = VehicleModel::Possible;

enum class Answer { No, Yes, Either };

constexpr std::string_view kStateRequest = "stateRequest", kFactsheetRequest = "factsheetRequest";

State with(State state, std::string why) {
  state.why = std::move(why);
  return state;
}

void end(TrackedAction& action, StatusSet may_be) {
  action.phase = Phase::Over;
  action.may_be = std::move(may_be);
}

void trigger(State& state, TrackedAction& action) {
  if (action.phase != Phase::Untriggered) return;
  action.phase = Phase::Triggered;
  action.trigger = ++state.triggers;
}

void trigger_all(State& state, Scope scope, std::uint32_t sequence) {
  for (TrackedAction& action : state.actions) {
    if (action.scope == scope && action.sequence == sequence) trigger(state, action);
  }
}

bool all_order_actions_over(const State& state) {
  return std::ranges::all_of(state.actions,
                             [](const TrackedAction& action) { return !is_order_action(action) || is_over(action); });
}

bool has_running_instant_action(const State& state) {
  return std::ranges::any_of(state.actions, [](const TrackedAction& action) {
    return !is_order_action(action) && action.action.type != kCancelOrder && !is_over(action);
  });
}

// ---- errors

void reject(State& state, ExpectedError error) { state.errors.push_back(std::move(error)); }

// "If an order update is rejected, [orderUpdateId] is to be passed in the rejection message" (6.6.6).
ExpectedError update_error(const Order& order) {
  return {{"orderUpdateError"}, {{"orderUpdateId", std::to_string(order.update)}}};
}

// Figure 8 of 2.0.0 names orderUpdateError with the orderUpdateId; Figure 8 of 2.1.0 names no type.
ExpectedError still_executing_error(const Order& order, Version version) {
  if (version == Version::V2_0_0) return update_error(order);
  return {{"orderUpdateError", "orderError"}, {}};
}

// Figure 8 of 2.0.0: noRouteError with the first node as reference; Figure 8 of 2.1.0 names no type.
ExpectedError no_route_error(const Order& order, Version version) {
  if (version == Version::V2_0_0) return {{"noRouteError"}, {{"nodeId", order.nodes.front().id}}};
  return {{"noRouteError", "orderError", "orderUpdateError"}, {}};
}

// What a warning with "shall be reported until the vehicle has accepted a new order" demands ends with a new order. An
// update is no new order, but may end it, too.
void settle_errors(State& state, bool new_order) {
  if (new_order) std::erase_if(state.errors, [](const ExpectedError& error) { return error.lasting; });
  for (ExpectedError& error : state.errors) error.must = error.lasting = false;
}

void age_errors(State& state) {
  for (ExpectedError& error : state.errors) error.must = error.must && error.lasting;
}

// ---- orders

void add_actions(State& state, const std::vector<Action>& actions, Scope scope, std::uint32_t sequence, bool released) {
  for (const Action& action : actions) {
    TrackedAction tracked;
    tracked.action = action;
    tracked.scope = scope;
    tracked.sequence = sequence;
    tracked.released = released;
    state.actions.push_back(std::move(tracked));
  }
}

void append_node(State& state, const OrderNode& node) {
  state.order.nodes.push_back({node.id, node.sequence, node.released});
  add_actions(state, node.actions, Scope::Node, node.sequence, node.released);
}

void append_edge(State& state, const OrderEdge& edge) {
  state.order.edges.push_back({edge.id, edge.start, edge.sequence, edge.released});
  add_actions(state, edge.actions, Scope::Edge, edge.sequence, edge.released);
}

// Appends all but the first node: the horizon is part of the state (6.6.2, note 3 to Figure 8).
void append_path(State& state, const Order& order) {
  for (std::size_t i = 0; i < order.edges.size(); ++i) {
    append_edge(state, order.edges[i]);
    append_node(state, order.nodes[i + 1]);
  }
}

void enter_edge(State& state, std::uint32_t sequence) { trigger_all(state, Scope::Edge, sequence); }

// "The actions that were active on the edge shall be finished" (6.10.2, Figure 15). Of an action that had not begun the
// standard says nothing.
void leave_edges_before(State& state, std::uint32_t node) {
  while (!state.order.edges.empty() && state.order.edges.front().sequence < node) state.order.edges.pop_front();
  for (TrackedAction& action : state.actions) {
    if (action.scope != Scope::Edge || action.sequence > node || is_over(action)) continue;
    const bool active = action.phase == Phase::Begun || action.seen == Running;
    end(action, active ? StatusSet{Finished} : StatusSet{Finished, Failed});
  }
}

// After the traversal of a node the AGV enters the next edge, except if it has to pause before it (6.10.2).
void enter_next_edge(State& state) {
  if (state.order.edges.empty() || !state.order.edges.front().released || state.order.cancel != Cancel::No) return;
  if (is_drive_blocked(state) || state.pause.paused || !state.pause.known || state.pause.requested) return;
  enter_edge(state, state.order.edges.front().sequence);
}

void traverse(State& state, const VehicleTraits& traits) {
  const NodeState node = state.order.nodes.front();
  state.order.nodes.pop_front();
  leave_edges_before(state, node.sequence);
  state.order.last = {node.id, node.sequence};
  trigger_all(state, Scope::Node, node.sequence);
  enter_next_edge(state);
  const bool still_braking =
      state.pause.requested == true || (state.order.cancel == Cancel::Running && traits.stops_between_nodes);
  const bool stays = drivable_edges(state, traits).empty() && !still_braking;
  state.body.motion = stays || state.order.cancel == Cancel::Running ? Motion::Standing : Motion::Unknown;
  if (still_braking) state.body.motion = Motion::Unknown;
}

// 6.6.1: "the AGV is already standing on the node, or [...] is in the node's deviation range".
Answer is_trivially_reachable(const State& state, const OrderNode& node, const VehicleTraits& traits) {
  const bool stands_on_it = !state.body.on_node.empty() && state.body.on_node == node.id;
  if (!node.position) return stands_on_it ? Answer::Yes : Answer::No;
  if (!state.body.position_known) return stands_on_it ? Answer::Yes : Answer::Either;
  const double distance_m =
      std::hypot(node.position->at.x - state.body.position.x, node.position->at.y - state.body.position.y);
  const bool within = distance_m <= std::max(node.position->allowed_deviation_m, traits.tolerance_m);
  if (within) return Answer::Yes;
  return stands_on_it ? Answer::Either : Answer::No;
}

// Figure 8 (3) for a new order.
Answer refuses_new_order(const State& state, const VehicleTraits& traits) {
  if (!state.order.nodes.empty()) return Answer::Yes;
  // Figure 8 of 2.0.0 joins its three conditions by "&&": nodes are traversed, so the order is over.
  if (is_executing(state)) return traits.version == Version::V2_0_0 ? Answer::Either : Answer::Yes;
  // Note 3 counts every action state, also of an instant action; 6.10.6 says that running instant actions outlive a new
  // order.
  return has_running_instant_action(state) ? Answer::Either : Answer::No;
}

State accept_new_order(State state, const Order& order, const VehicleTraits& traits) {
  // 6.10.6: "Action states, except for running instant actions, are removed upon receiving a new order."
  std::erase_if(state.actions, [](const TrackedAction& a) { return is_order_action(a) || is_over(a); });
  for (TrackedAction& action : state.actions) action.may_be_absent |= traits.version == Version::V2_0_0;
  settle_errors(state, true);
  state.order.id = order.id;
  state.order.update = order.update;
  state.order.cancel = Cancel::No;
  state.order.nodes.clear();
  state.order.edges.clear();
  append_node(state, order.nodes.front());
  append_path(state, order);
  return state;
}

std::vector<Possible> take_new_order(const State& state, const Order& order, const VehicleTraits& traits) {
  std::vector<Possible> possible;
  const Answer refuses = refuses_new_order(state, traits);
  const Answer reachable = is_trivially_reachable(state, order.nodes.front(), traits);
  if (refuses != Answer::Yes && reachable != Answer::No) {
    State accepted = accept_new_order(state, order, traits);
    possible.push_back({with(accepted, "new order, first node ahead"), true});
    if (order.nodes.front().released) {
      traverse(accepted, traits);
      possible.push_back({with(accepted, "new order, first node counts as traversed"), true});
    }
  }
  if (refuses != Answer::No) {
    State rejected = with(state, "new order rejected: still executing");
    reject(rejected, still_executing_error(order, traits.version));
    possible.push_back({std::move(rejected), true});
  }
  if (refuses != Answer::Yes && reachable != Answer::Yes) {
    State rejected = with(state, "new order rejected: first node out of reach");
    reject(rejected, no_route_error(order, traits.version));
    possible.push_back({std::move(rejected), true});
  }
  return possible;
}

// "Clear horizon, if vehicle has one" (Figure 8).
void clear_horizon(State& state) {
  std::erase_if(state.order.nodes, [](const NodeState& node) { return !node.released; });
  std::erase_if(state.order.edges, [](const EdgeState& edge) { return !edge.released; });
  std::erase_if(state.actions, [](const TrackedAction& a) { return is_order_action(a) && !a.released; });
}

State accept_update(State state, const Order& order) {
  clear_horizon(state);
  settle_errors(state, false);
  state.order.update = order.update;
  state.order.cancel = Cancel::No;
  // The first node is the stitching node: "its contents are not changed" (6.6.2), so its actions do not count again.
  append_path(state, order);
  return with(std::move(state), "update accepted");
}

// Figure 8 (5) to (8).
std::vector<Possible> take_update(const State& state, const Order& order) {
  if (order.update == state.order.update) return {{with(state, "repeated order ignored"), false}};  // 6.6.4.3
  State rejected = with(state, "update rejected");
  reject(rejected, update_error(order));
  const LastNode first{order.nodes.front().id, order.nodes.front().sequence};
  const bool continues = first == decision_point(state);  // (7); of a completed order, its last node: (8)
  if (order.update < state.order.update || !continues || state.order.cancel == Cancel::Running)
    return {{std::move(rejected), true}};
  std::vector<Possible> possible{{accept_update(state, order), true}};
  // Figure 8 (8) accepts an update of a cancelled order; but then "the order is deleted" (6.8.1, cancelOrder).
  if (state.order.cancel == Cancel::Done) possible.push_back({std::move(rejected), true});
  return possible;
}

bool knows_all_actions(const Order& order, const VehicleTraits& traits) {
  const auto known = [&](const Action& action) { return traits.known.contains(action.type); };
  return std::ranges::all_of(order.nodes, [&](const auto& node) { return std::ranges::all_of(node.actions, known); }) &&
         std::ranges::all_of(order.edges, [&](const auto& edge) { return std::ranges::all_of(edge.actions, known); });
}

std::vector<Possible> take_order(State state, const ReadOrder& read, const VehicleTraits& traits) {
  if (read.flaw != Flaw::None) {  // 6.6.4.1
    ExpectedError error{{"validationError"}, {}};
    if (read.flaw == Flaw::BrokenGraph) error.types.insert("orderError");
    error.lasting = true;
    reject(state, error);
    return {{with(std::move(state), "malformed order: " + read.why), true}};
  }
  if (!knows_all_actions(read.order, traits)) {  // 6.6.4.2; Figure 16: "must be rejected", never reported as failed
    ExpectedError error{{"orderError"}, {}, true};
    // In 2.0.0 the third point of 6.6.4.2 has one "not" too many.
    error.lasting = traits.version != Version::V2_0_0;
    reject(state, error);
    return {{with(std::move(state), "order with an unknown action"), true}};
  }
  if (read.order.id != state.order.id) return take_new_order(state, read.order, traits);
  return take_update(state, read.order);
}

// ---- instant actions

TrackedAction& add_instant(State& state, const Action& action, Scope scope, StatusSet may_be) {
  TrackedAction tracked;
  tracked.action = action;
  tracked.scope = scope;
  tracked.phase = Phase::Triggered;
  tracked.trigger = ++state.triggers;
  tracked.may_be = std::move(may_be);
  state.actions.push_back(std::move(tracked));
  return state.actions.back();
}

// 6.6.3: scheduled actions fail; running ones should, if they can be interrupted.
void cancel_action(TrackedAction& action, const VehicleTraits& traits) {
  if (is_over(action) || action.scope == Scope::Control) return;
  if (action.scope == Scope::Instant) {
    action.may_be_interrupted = true;  // "all actions are canceled" (6.8.1), or only those of the order
    return;
  }
  const bool begun = action.phase == Phase::Begun;
  const bool shown = action.seen && *action.seen != Waiting;
  if (!begun && !(shown && action.phase == Phase::Triggered)) {
    end(action, {Failed});
    return;
  }
  action.may_be_interrupted = !begun || !traits.uninterruptible.contains(action.action.type);
}

void start_cancel(State& state, const Action& action, const VehicleTraits& traits) {
  ExpectedError no_order{{"noOrderToCancel"}, {{"actionId", action.id}}};
  if (state.order.cancel == Cancel::Running) {
    // Idempotent (6.8.1), so it may share the end of the first one; or "the previous order was canceled" (6.6.3.2).
    no_order.must = false;
    state.errors.push_back(no_order);
    add_instant(state, action, Scope::Control, {Running, Finished, Failed});
    return;
  }
  if (!is_executing(state)) {  // 6.6.3.2
    end(add_instant(state, action, Scope::Control, {}), {Failed});
    state.errors.push_back(no_order);
    return;
  }
  for (TrackedAction& tracked : state.actions) cancel_action(tracked, traits);
  add_instant(state, action, Scope::Control, {Running});
  state.order.cancel = Cancel::Running;
}

void start_instant(State& state, const Action& action, const VehicleTraits& traits) {
  if (action.type == kCancelOrder) return start_cancel(state, action, traits);
  if (action.type == kStartPause || action.type == kStopPause) {
    // 6.8.2: RUNNING while the transition is prepared; it can be omitted.
    add_instant(state, action, Scope::Control, {Running, Finished});
    state.pause.requested = action.type == kStartPause;
  } else if (action.type == kStateRequest || action.type == kFactsheetRequest) {
    end(add_instant(state, action, Scope::Control, {}), {Finished});  // 6.8.2: no other status
  } else if (traits.known.contains(action.type)) {
    add_instant(state, action, Scope::Instant, {});
  } else {
    // The standard is silent on instant actions that the AGV does not know.
    TrackedAction& unknown = add_instant(state, action, Scope::Control, {});
    end(unknown, {Failed});
    unknown.may_be_absent = true;
  }
}

// ---- facts

void reach_node(State& state, const Input& input, const VehicleTraits& traits, bool& must_publish) {
  state.body.on_node = input.node_id;
  state.body.position = input.position;
  state.body.position_known = true;
  if (!state.order.nodes.empty() && state.order.nodes.front().sequence == input.sequence) {
    traverse(state, traits);
    must_publish = true;  // 6.10: "driving over a node"
  } else if (state.order.cancel != Cancel::No && !(state.order.last == LastNode{input.node_id, input.sequence})) {
    // Figure 9: "lastNodeId and lastNodeSequenceId must be updated accordingly".
    state.order.last = {input.node_id, input.sequence};
    if (!traits.stops_between_nodes) state.body.motion = Motion::Standing;
    must_publish = true;
  }
}

void begin_action(State& state, TrackedAction& action, bool& must_publish) {
  if (action.phase == Phase::Untriggered && is_at_edge_entry(state, action)) trigger(state, action);
  if (action.phase != Phase::Triggered) return;
  action.phase = Phase::Begun;
  must_publish = action.seen != Running && !state.pause.paused && !action.may_be_interrupted;
}

void end_action(TrackedAction& action, Status status, bool& must_publish) {
  if (is_over(action)) return;
  must_publish = true;  // 6.10.6: "when an action is completed, an updated state message is published"
  const bool interrupted = action.may_be_interrupted && status == Finished;
  end(action, interrupted ? StatusSet{Finished, Failed} : StatusSet{status});
}

void take_pause(State& state, bool on, bool& must_publish) {
  for (const TrackedAction& action : state.actions) {
    const bool asks = action.scope == Scope::Control && action.action.type == (on ? kStartPause : kStopPause);
    must_publish |= asks && !is_over(action) && action.seen != Finished;
  }
  settle_pause(state, on);
}

// The standard says nothing of restarts. An AGV may have lost its order and its last node, its order only, or nothing.
std::vector<Possible> restart(const State& before) {
  State cleared;
  cleared.body = before.body;
  cleared.body.online = true;
  cleared.body.motion = Motion::Standing;
  cleared.pause.known = false;
  State located = cleared;
  located.order.last = before.order.last;
  State kept = before;
  kept.body = cleared.body;
  kept.pause = cleared.pause;
  for (TrackedAction& action : kept.actions) {
    action.may_be_interrupted |= !is_over(action);
    if (!is_over(action) && action.scope == Scope::Control) action.may_be = {Running, Finished, Failed};
    if (!is_over(action)) action.seen.reset();
  }
  return {{with(located, "restarted without order"), false},
          {with(cleared, "restarted without order and last node"), false},
          {with(kept, "restarted with order"), false}};
}

// ---- cancel

void finish_cancel(State& state) {
  state.order.nodes.clear();
  state.order.edges.clear();
  state.order.cancel = Cancel::Done;
  bool first = true;
  for (TrackedAction& action : state.actions) {
    if (action.action.type != kCancelOrder || is_over(action)) continue;
    end(action, first ? StatusSet{Finished} : StatusSet{Finished, Failed});
    first = false;
  }
}

// "After all movement of the vehicle and all of its actions are stopped, the cancelOrder action status shall report
// FINISHED"; until then RUNNING (6.6.3).
void settle_cancel(State& state) {
  if (state.order.cancel != Cancel::Running) return;
  if (state.body.motion == Motion::Standing && all_order_actions_over(state)) return finish_cancel(state);
  const bool may_be_settled =
      state.body.motion != Motion::Moving && std::ranges::all_of(state.actions, [](const TrackedAction& action) {
        return !is_order_action(action) || is_over(action) || action.may_be_interrupted;
      });
  const auto first = std::ranges::find_if(state.actions, [](const TrackedAction& action) {
    return action.action.type == kCancelOrder && !is_over(action);
  });
  if (first != state.actions.end()) first->may_be = may_be_settled ? StatusSet{Running, Finished} : StatusSet{Running};
}

// Figure 9: which node and edge states a cancelled order may still have.
void spread_cancel(const Possible& possible, const VehicleTraits& traits, std::vector<Possible>& out) {
  const State& state = possible.state;
  if (state.order.cancel != Cancel::Running || state.order.nodes.empty()) return out.push_back(possible);
  const auto add = [&](std::size_t nodes, std::size_t edges, std::string why) {
    Possible part = possible;
    part.state.order.nodes.resize(std::min(nodes, part.state.order.nodes.size()));
    part.state.order.edges.resize(std::min(edges, part.state.order.edges.size()));
    part.state.why = std::move(why);
    out.push_back(std::move(part));
  };
  const bool drives_on = !traits.stops_between_nodes && state.body.motion != Motion::Standing;
  if (drives_on) {
    add(1, 1, "cancelled: drives to the next node, whose edge is kept");
    add(1, 0, "cancelled: drives to the next node, whose edge is deleted");
  }
  // The flow of Figure 9 deletes states at its end, after actions have ended and the AGV has stopped.
  if (!drives_on || !all_order_actions_over(state)) out.push_back(possible);
  if (!drives_on || state.body.motion == Motion::Unknown) add(0, 0, "cancelled: states are deleted");
}

Consequence take_instant_actions(State state, const Input& input, const VehicleTraits& traits) {
  const ReadInstantActions read = read_instant_actions(input.text);
  Consequence consequence;
  for (const Action& action : read.actions) {
    if (find_action(state, action.id) != nullptr) continue;  // the standard says nothing of an actionId sent twice
    start_instant(state, action, traits);
    consequence.must_send_factsheet |= action.type == kFactsheetRequest;
  }
  consequence.possible = {{with(std::move(state), "instant actions"), !read.actions.empty()}};
  return consequence;
}

Possible take_fact(State state, const Input& input, const VehicleTraits& traits) {
  using enum Input::Kind;
  bool must_publish = false;
  TrackedAction* action = find_action(state, input.action_id);
  if (input.kind == NodeReached) reach_node(state, input, traits, must_publish);
  if (input.kind == EdgeEntered) {
    if (state.order.cancel == Cancel::No) enter_edge(state, input.sequence);
    state.body.motion = Motion::Moving;
    state.body.on_node.clear();
    state.body.position_known = false;
  }
  if (input.kind == Stopped) {
    state.body.motion = Motion::Standing;
    state.body.on_node = input.node_id;
    state.body.position = input.position;
    state.body.position_known = true;
  }
  if (input.kind == ActionBegun && action) begin_action(state, *action, must_publish);
  if (input.kind == ActionFinished && action) end_action(*action, Finished, must_publish);
  if (input.kind == ActionFailed && action) end_action(*action, Failed, must_publish);
  if (input.kind == PauseEffective) take_pause(state, input.on, must_publish);
  return {with(std::move(state), std::string(name_of(input.kind))), must_publish};
}

}  // namespace

Consequence consequence_of(const State& before, const Input& input, const VehicleTraits& traits) {
  using enum Input::Kind;
  State state = before;
  age_errors(state);
  Consequence consequence;
  const bool by_mqtt = input.kind == Order || input.kind == InstantActions;
  if (by_mqtt && !state.body.online) {  // QoS 0 (6.2): the message is lost
    consequence.possible = {{state, false}};
  } else if (input.kind == Order) {
    consequence.possible = take_order(std::move(state), read_order(input.text), traits);
  } else if (input.kind == InstantActions) {
    consequence = take_instant_actions(std::move(state), input, traits);
  } else if (input.kind == ConnectionLost || input.kind == ConnectionRestored) {
    // 6.2: "it keeps all the order information and fulfills the order up to the last released node".
    state.body.online = input.kind == ConnectionRestored;
    consequence.must_announce_online = state.body.online;
    consequence.possible = {{std::move(state), false}};
  } else if (input.kind == Restarted) {
    consequence.must_announce_online = true;
    consequence.possible = restart(state);
  } else {
    consequence.possible = {take_fact(std::move(state), input, traits)};
  }
  std::vector<Possible> spread;
  for (Possible& possible : consequence.possible) {
    const bool may_move = !drivable_edges(possible.state, traits).empty();
    if (possible.state.body.motion == Motion::Standing && may_move && possible.state.order.cancel == Cancel::No)
      possible.state.body.motion = Motion::Unknown;
    settle_cancel(possible.state);
    possible.must_publish = possible.must_publish && possible.state.body.online;
    spread_cancel(possible, traits, spread);
  }
  consequence.possible = std::move(spread);
  return consequence;
}

}  // namespace fleetproof::test::vda5050_model
