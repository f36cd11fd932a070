#include "tests/support/vda5050_state.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

namespace fleetproof::test::vda5050_model {
namespace {

using enum Status;

constexpr std::array<std::pair<Status, std::string_view>, 6> kStatusNames{{{Waiting, "WAITING"},
                                                                           {Initializing, "INITIALIZING"},
                                                                           {Running, "RUNNING"},
                                                                           {Paused, "PAUSED"},
                                                                           {Finished, "FINISHED"},
                                                                           {Failed, "FAILED"}}};

// Figure 16, closed over steps that two reports may skip.
StatusSet reachable(Status from) {
  switch (from) {
    case Waiting:
      return {Waiting, Initializing, Running, Paused, Finished, Failed};
    case Initializing:
    case Running:
    case Paused:
      return {Initializing, Running, Paused, Finished, Failed};
    case Finished:
      return {Finished};
    case Failed:
      return {Failed};
  }
  return {};
}

bool is_pausing(const State& state) {
  return state.pause.paused || !state.pause.known || state.pause.requested.has_value();
}

// 6.8.1 says of a pause "Actions can continue", 6.8.2 "All actions will be paused": both are allowed.
void allow_pause(const State& state, StatusSet& set) {
  if (!is_pausing(state)) return;
  set.insert(Paused);
  set.insert(Initializing);
}

StatusSet triggered_statuses(const State& state, const TrackedAction& action) {
  StatusSet set;
  if (is_held_back(state, action)) {
    // Table 2 has no status for an action whose node is reached but whose turn has not come.
    set = {Waiting, Initializing};
  } else {
    // "As soon as the AGV reports the node as traversed, the AGV shall trigger the actions" (6.10.2).
    set = {Initializing, Running};
    // A SOFT or HARD action has to wait until the AGV stands (Figure 17: "stop driving").
    if (action.action.blocking != Blocking::None) set.insert(Waiting);
  }
  if (is_pausing(state)) set.insert(Waiting);
  allow_pause(state, set);
  return set;
}

}  // namespace

std::string_view name_of(Status status) {
  return std::ranges::find(kStatusNames, status, [](const auto& pair) { return pair.first; })->second;
}

std::optional<Status> status_of(std::string_view name) {
  const auto* found = std::ranges::find(kStatusNames, name, [](const auto& pair) { return pair.second; });
  if (found == kStatusNames.end()) return {};
  return found->first;
}

bool is_same(const State& a, const State& b) {
  return a.order == b.order && a.body == b.body && a.pause == b.pause && a.actions == b.actions &&
         a.errors == b.errors && a.triggers == b.triggers;
}

void settle_pause(State& state, bool paused) {
  const bool latest = !state.pause.requested || *state.pause.requested == paused;
  state.pause.paused = paused;
  state.pause.known = true;
  if (latest) state.pause.requested.reset();
  for (TrackedAction& action : state.actions) {
    const bool starts = action.action.type == kStartPause;
    if (action.scope != Scope::Control || is_over(action) || !(starts || action.action.type == kStopPause)) continue;
    if (starts != paused && !latest) continue;  // it was asked for later
    action.phase = Phase::Over;
    // Of a request that another one has overtaken the standard says nothing.
    action.may_be = starts == paused ? StatusSet{Finished} : StatusSet{Finished, Failed};
  }
}

const TrackedAction* find_action(const State& state, std::string_view id) {
  const auto found = std::ranges::find(state.actions, id, [](const TrackedAction& a) { return a.action.id; });
  return found == state.actions.end() ? nullptr : &*found;
}

TrackedAction* find_action(State& state, std::string_view id) {
  return const_cast<TrackedAction*>(find_action(std::as_const(state), id));
}

bool is_order_action(const TrackedAction& action) { return action.scope == Scope::Node || action.scope == Scope::Edge; }

bool is_over(const TrackedAction& action) { return action.phase == Phase::Over; }

bool is_held_back(const State& state, const TrackedAction& action) {
  return std::ranges::any_of(state.actions, [&](const TrackedAction& other) {
    if (&other == &action || other.action.id == action.action.id || other.scope == Scope::Control) return false;
    if (other.phase != Phase::Triggered && other.phase != Phase::Begun) return false;
    const bool exclusive = other.action.blocking == Blocking::Hard || action.action.blocking == Blocking::Hard;
    return exclusive && (other.phase == Phase::Begun || other.trigger < action.trigger);
  });
}

bool is_drive_blocked(const State& state) {
  return std::ranges::any_of(state.actions, [](const TrackedAction& action) {
    const bool active = action.phase == Phase::Triggered || action.phase == Phase::Begun;
    return active && action.scope != Scope::Control && action.action.blocking != Blocking::None;
  });
}

bool is_at_edge_entry(const State& state, const TrackedAction& action) {
  if (action.scope != Scope::Edge || action.phase != Phase::Untriggered || state.order.edges.empty()) return false;
  const EdgeState& ahead = state.order.edges.front();
  return ahead.sequence == action.sequence && ahead.released && ahead.start == state.order.last.id &&
         ahead.sequence == state.order.last.sequence + 1 && !is_drive_blocked(state);
}

StatusSet allowed_statuses(const State& state, const TrackedAction& action) {
  StatusSet set;
  if (action.scope == Scope::Control || action.phase == Phase::Over) {
    set = action.may_be;
  } else if (action.phase == Phase::Untriggered) {
    set = {Waiting};
    if (is_at_edge_entry(state, action)) set.insert({Initializing, Running});
  } else if (action.phase == Phase::Triggered) {
    set = triggered_statuses(state, action);
  } else {
    set = {Running};
    allow_pause(state, set);
  }
  if (action.may_be_interrupted && action.phase != Phase::Over) set.insert(Failed);
  if (action.seen) {
    const StatusSet after = reachable(*action.seen);
    std::erase_if(set, [&](Status status) { return !after.contains(status); });
  }
  return set;
}

bool is_executing(const State& state) {
  if (!state.order.nodes.empty() || state.order.cancel == Cancel::Running) return true;
  return std::ranges::any_of(state.actions,
                             [](const TrackedAction& action) { return is_order_action(action) && !is_over(action); });
}

std::vector<std::uint32_t> drivable_edges(const State& state, const VehicleTraits& traits) {
  std::vector<std::uint32_t> edges;
  if (state.pause.paused || state.pause.requested == true || is_drive_blocked(state)) return edges;
  if (state.order.cancel == Cancel::Done) return edges;
  if (state.order.cancel == Cancel::Running) {
    // Figure 9: an AGV that cannot stop between nodes drives on to the next node, and no further.
    const bool drives_on = !traits.stops_between_nodes && state.body.motion != Motion::Standing;
    if (drives_on && !state.order.nodes.empty() && state.order.last.sequence + 2 == state.order.nodes.front().sequence)
      edges.push_back(state.order.last.sequence + 1);
    return edges;
  }
  for (const EdgeState& edge : state.order.edges) {
    if (!edge.released) break;  // 6.6.1: not released: shall not traverse
    edges.push_back(edge.sequence);
  }
  return edges;
}

LastNode decision_point(const State& state) {
  LastNode point = state.order.last;
  for (const NodeState& node : state.order.nodes) {
    if (node.released) point = {node.id, node.sequence};
  }
  return point;
}

}  // namespace fleetproof::test::vda5050_model
