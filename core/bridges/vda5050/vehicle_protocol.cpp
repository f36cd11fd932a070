#include "core/bridges/vda5050/vehicle_protocol.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

namespace fleetproof::bridges::vda5050 {
namespace {

constexpr double kLimitlessDeviation_m = 1e6;  // so that squares stay finite

void append(std::vector<ActionWish>& to, std::vector<ActionWish> wishes) {
  to.insert(to.end(), std::make_move_iterator(wishes.begin()), std::make_move_iterator(wishes.end()));
}

// 7.1: what a message of the master was, for an error about it.
std::vector<Reference> references_to(const Header& header, Topic topic) {
  return {{"topic", std::string(topic_word(topic))}, {"headerId", std::to_string(header.header_id)}};
}

std::optional<double> number_of(const Action& action, std::string_view key) {
  const ActionParameter* parameter = action.parameter(key);
  double number = 0.0;
  if (parameter == nullptr || parameter->is_string) return {};
  const char* end = parameter->value.data() + parameter->value.size();
  const auto result = std::from_chars(parameter->value.data(), end, number);
  return result.ec == std::errc{} && result.ptr == end ? std::optional(number) : std::nullopt;
}

std::optional<std::string> text_of(const Action& action, std::string_view key) {
  const ActionParameter* parameter = action.parameter(key);
  return parameter != nullptr && parameter->is_string ? std::optional(parameter->value) : std::nullopt;
}

bool is_within(double distance_x, double distance_y, double radius) {
  return distance_x * distance_x + distance_y * distance_y <= radius * radius;
}

}  // namespace

VehicleProtocol::VehicleProtocol(VehicleSettings settings, Factsheet factsheet)
    : settings_(std::move(settings)),
      factsheet_(std::move(factsheet)),
      actions_(settings_.abilities),
      errors_(settings_.most_errors) {}

// ---- what is known

bool VehicleProtocol::is_executing() const {
  return !order_.nodes().empty() || actions_.has_open_order_actions() || !under_way_.cancels.empty();
}

bool VehicleProtocol::is_in_control() const {
  return body_.mode == OperatingMode::Automatic || body_.mode == OperatingMode::Semiautomatic;
}

// It stands on the node, or within the deviation that the order allows (6.6.1).
bool VehicleProtocol::is_near(const Node& node) const {
  if (place_.is_on_node && place_.node_id == node.node_id) return true;
  if (!node.node_position || !place_.position || !place_.position->position_initialized) return false;
  const NodePosition& there = *node.node_position;
  const AgvPosition& here = *place_.position;
  const double allowed = std::min(there.allowed_deviation_xy.value_or(0.0), kLimitlessDeviation_m);
  return there.map_id == here.map_id &&
         is_within(there.x - here.x, there.y - here.y, std::max(allowed, settings_.node_tolerance_m));
}

bool VehicleProtocol::wants_base() const {
  return under_way_.cancels.empty() && order_.has_horizon() && order_.base_ahead() <= settings_.asks_for_base_at;
}

// ---- orders

// The steps 3 to 8 of figure 8.
std::optional<Refusal> VehicleProtocol::refuse_now(const Order& order, bool is_update) const {
  if (!is_in_control()) return Refusal{"orderError", "the master is not in control of the vehicle", {}};
  const Node& first = order.nodes.front();
  const std::vector<Reference> at_first = {{"nodeId", first.node_id},
                                           {"sequenceId", std::to_string(first.sequence_id)}};
  if (is_update) {
    if (!under_way_.cancels.empty()) return Refusal{"orderUpdateError", "the order is being cancelled", {}};
    if (!order_.is_decision_point(first))
      return Refusal{"orderUpdateError", "the update does not begin at the last node of the base", at_first};
  } else {
    if (is_executing()) return Refusal{"orderError", "another order is being executed", {}};
    if (!is_near(first)) return Refusal{"noRouteError", "the vehicle is not at the first node", at_first};
  }
  for (const Edge& edge : order.edges) {
    if (settings_.knows_edge && !settings_.knows_edge(edge))
      return Refusal{"orderError", "the map of the vehicle has no such edge", {{"edgeId", edge.edge_id}}};
  }
  return refuse_used_ids(order, is_update);
}

std::optional<Refusal> VehicleProtocol::refuse_used_ids(const Order& order, bool is_update) const {
  std::optional<Refusal> refusal;
  const std::uint32_t first = order.nodes.front().sequence_id;
  traverse(order, [&](const auto& element) {
    if (is_update && element.sequence_id == first) return;  // the node that is known already
    for (const Action& action : element.actions) {
      const bool is_used =
          is_update ? actions_.keeps_with_update(action.action_id, first) : actions_.keeps_with_order(action.action_id);
      if (is_used && !refusal)
        refusal = {"validationError", "the actionId is in use already", {{"actionId", action.action_id}}};
    }
  });
  return refusal;
}

void VehicleProtocol::reject(const Order& order, const Refusal& refusal) {
  std::vector<Reference> references = references_to(order.header, Topic::Order);
  references.push_back({"orderId", order.order_id});
  references.push_back({"orderUpdateId", std::to_string(order.order_update_id)});
  errors_.reject(refusal, std::move(references));
}

void VehicleProtocol::order_received(std::string_view bytes) {
  link_.owes_state = true;
  Order order;
  std::string why;
  if (!read_document(bytes, *settings_.identity.version, order, why))
    return reject(order, {"validationError", why, {}});
  if (const auto refusal = refuse_malformed(order)) return reject(order, *refusal);
  const bool is_update = order.order_id == order_.order_id();
  if (is_update && order.order_update_id == order_.update_id()) return;  // it was sent again (6.6.4.3)
  if (is_update && order.order_update_id < order_.update_id())
    return reject(order, {"orderUpdateError", "the orderUpdateId is smaller than that on the vehicle", {}});
  if (const auto refusal = refuse_unable(order, settings_.abilities)) return reject(order, *refusal);
  if (const auto refusal = refuse_now(order, is_update)) return reject(order, *refusal);
  accept(order, is_update);
  settle();
}

void VehicleProtocol::accept(const Order& order, bool is_update) {
  const std::uint32_t first = order.nodes.front().sequence_id;
  errors_.accepted();
  if (is_update) {
    actions_.forget_behind(first);
    order_.extend(order);
  } else {
    actions_.forget_former_order();
    order_.take(order);
    place_.drives_until = first;
  }
  traverse(order, [&](const auto& element) {
    if (is_update && element.sequence_id == first) return;
    constexpr bool kIsNode = std::is_same_v<std::remove_cvref_t<decltype(element)>, Node>;
    for (const Action& action : element.actions)
      actions_.add(action, {kIsNode ? ActionPlace::Kind::Node : ActionPlace::Kind::Edge, element.sequence_id});
  });
  if (!is_update) pass_node();  // it is there
}

// ---- instant actions

void VehicleProtocol::instant_actions_received(std::string_view bytes) {
  link_.owes_state = true;
  InstantActions message;
  std::string why;
  if (!read_document(bytes, *settings_.identity.version, message, why))
    return errors_.reject({"validationError", why, {}}, references_to(message.header, Topic::InstantActions));
  for (const Action& action : message.actions) {
    if (!actions_.knows(action.action_id)) do_instant_action(action, message.header);
  }
  actions_.keep_at_most(settings_.most_action_states);
  settle();
}

void VehicleProtocol::do_instant_action(const Action& action, const Header& header) {
  const auto fail = [&](Refusal refusal) {
    refusal.references.push_back({"actionId", action.action_id});
    errors_.reject(refusal, references_to(header, Topic::InstantActions));
    actions_.add_own(action, ActionStatus::Failed, refusal.why);
  };
  const std::string& type = action.action_type;
  if (type == "cancelOrder") {
    if (!is_executing()) return fail({"noOrderToCancel", "there is no order to cancel", {}});
    begin_cancel(action);
  } else if (type == "startPause") {
    begin_pause(action);
  } else if (type == "stopPause") {
    end_pause();
    actions_.add_own(action, ActionStatus::Finished);
  } else if (type == "stateRequest") {
    actions_.add_own(action, ActionStatus::Finished);
  } else if (type == "factsheetRequest") {
    link_.owes_factsheet = true;
    actions_.add_own(action, ActionStatus::Finished);
  } else if (type == "initPosition") {
    if (const char* why = why_not_at(action)) return fail({"instantActionError", why, {}});
    actions_.add_own(action, ActionStatus::Finished);
  } else if (auto refusal = refuse_unable(action, ActionScope::Instant, settings_.abilities)) {
    fail({"instantActionError", refusal->why, {{"actionType", type}}});
  } else if (!is_in_control()) {
    fail({"instantActionError", "the master is not in control of the vehicle", {}});
  } else {
    actions_.add(action, {});
  }
}

// Where it cannot stop between nodes, it keeps the nodes to which it drives in any case, and no edge (figure 9).
void VehicleProtocol::begin_cancel(const Action& action) {
  append(wishes_, actions_.cancel_order());
  const bool has_begun_edge = place_.drives_until > order_.last_sequence_id();
  if (!has_begun_edge) {
    order_.forget_path();
  } else if (!settings_.stops_between_nodes) {
    order_.cut_behind(place_.drives_until + 1);
  }
  actions_.add_own(action, ActionStatus::Running);
  under_way_.cancels.push_back(action.action_id);
}

void VehicleProtocol::begin_pause(const Action& action) {
  const bool is_on = under_way_.pause == Pause::On;
  actions_.add_own(action, is_on ? ActionStatus::Finished : ActionStatus::Running);
  if (is_on) return;
  under_way_.start_pauses.push_back(action.action_id);
  if (under_way_.pause == Pause::Off) append(wishes_, actions_.pause());
  under_way_.pause = Pause::Stopping;
}

void VehicleProtocol::end_pause() {
  for (const std::string& id : under_way_.start_pauses) actions_.set_own(id, ActionStatus::Failed);
  under_way_.start_pauses.clear();
  if (under_way_.pause != Pause::Off) append(wishes_, actions_.resume());
  under_way_.pause = Pause::Off;
}

// The body knows where it is. So a position is set only if it is the one that it has; null then.
const char* VehicleProtocol::why_not_at(const Action& action) const {
  const auto x = number_of(action, "x"), y = number_of(action, "y"), theta = number_of(action, "theta");
  const auto map = text_of(action, "mapId"), node = text_of(action, "lastNodeId");
  if (!x || !y || !theta || !map || !node) return "it needs x, y, theta, mapId and lastNodeId";
  if (is_executing()) return "an order is being executed";
  if (!place_.is_on_node || *node != place_.node_id) return "the vehicle does not stand at this node";
  if (!place_.position) return nullptr;
  const AgvPosition& here = *place_.position;
  const bool is_same = *map == here.map_id && is_within(*x - here.x, *y - here.y, settings_.node_tolerance_m);
  return is_same ? nullptr : "the vehicle is elsewhere";
}

// A mode in which nobody may drive by orders: they are gone at once.
void VehicleProtocol::drop_order() {
  append(wishes_, actions_.cancel_order());
  order_.forget_path();
}

// ---- the way

void VehicleProtocol::pass_node() {
  const Node node = order_.nodes().front();
  order_.pass_node();
  if (place_.is_on_edge && node.sequence_id > 0) append(wishes_, actions_.leave_edge(node.sequence_id - 1));
  place_.is_on_node = true;
  place_.is_on_edge = false;
  place_.node_id = node.node_id;
  place_.drives_until = std::max(place_.drives_until, node.sequence_id);
  actions_.trigger({ActionPlace::Kind::Node, node.sequence_id});
}

// It enters the edge behind a node when it moves on, or when the edge has actions during which it must stand: they run
// at the beginning of the edge (6.10.2).
void VehicleProtocol::enter_edge() {
  const bool may_enter = place_.is_on_node && !order_.edges().empty() && order_.edges().front().released;
  if (!may_enter) return;
  const std::uint32_t edge = order_.edges().front().sequence_id;
  const bool is_begun = place_.drives_until >= edge;
  const bool is_free =
      under_way_.pause == Pause::Off && under_way_.cancels.empty() && is_in_control() && !actions_.holds_vehicle();
  const bool stands_on_it = is_free && actions_.holds_vehicle_at({ActionPlace::Kind::Edge, edge});
  if (!is_begun && !stands_on_it && !(is_free && body_.drives)) return;
  place_.is_on_node = false;
  place_.is_on_edge = true;
  if (body_.drives) place_.drives_until = std::max(place_.drives_until, edge);
  actions_.trigger({ActionPlace::Kind::Edge, edge});
}

// What follows from the last message or fact.
void VehicleProtocol::settle() {
  if (under_way_.pause == Pause::Stopping && !body_.drives) {
    under_way_.pause = Pause::On;
    for (const std::string& id : under_way_.start_pauses) actions_.set_own(id, ActionStatus::Finished);
    under_way_.start_pauses.clear();
  }
  if (!under_way_.cancels.empty()) {
    if (settings_.stops_between_nodes && !body_.drives) order_.forget_path();
    if (order_.nodes().empty() && !body_.drives && !actions_.has_open_order_actions()) {
      for (const std::string& id : under_way_.cancels) actions_.set_own(id, ActionStatus::Finished);
      under_way_.cancels.clear();
      place_.is_on_edge = false;
      place_.drives_until = order_.last_sequence_id();
    }
  }
  enter_edge();
  if (under_way_.pause == Pause::Off && is_in_control()) append(wishes_, actions_.start(!body_.drives));
}

DrivingWish VehicleProtocol::driving_wish() const {
  DrivingWish wish;
  const bool is_cancelling = !under_way_.cancels.empty();
  wish.hold =
      under_way_.pause != Pause::Off || actions_.holds_vehicle() || (is_cancelling && settings_.stops_between_nodes);
  if (wish.hold || is_cancelling || !is_in_control()) return wish;
  for (const Edge& edge : order_.edges()) {
    const bool node_is_ahead = edge.sequence_id > order_.last_sequence_id() + 1;
    const bool stops_before =
        node_is_ahead && actions_.holds_vehicle_at({ActionPlace::Kind::Node, edge.sequence_id - 1});
    if (!edge.released || stops_before || actions_.holds_vehicle_at({ActionPlace::Kind::Edge, edge.sequence_id})) break;
    if (edge.sequence_id > place_.drives_until) wish.edges.push_back(edge);
  }
  return wish;
}

std::vector<ActionWish> VehicleProtocol::take_action_wishes() { return std::exchange(wishes_, {}); }

// ---- facts

struct VehicleProtocol::Hearing {
  VehicleProtocol& v;

  void operator()(const ConnectionOpened&) { v.link_.is_open = v.link_.owes_online = v.link_.owes_state = true; }
  void operator()(const ConnectionLost&) { v.link_.is_open = false; }
  void operator()(const StandsAt& fact) {
    if (!v.order_.nodes().empty()) return;
    if (v.order_.last_node_id() != fact.node_id) v.order_.stand_at(fact.node_id);
    v.place_.is_on_node = true;
    v.place_.is_on_edge = false;
    v.place_.node_id = fact.node_id;
    news();
  }
  void operator()(const EdgeBegun& fact) {
    const auto& edges = v.order_.edges();
    if (std::ranges::find(edges, fact.sequence_id, &Edge::sequence_id) == edges.end()) return;
    v.place_.drives_until = std::max(v.place_.drives_until, fact.sequence_id);
    news();
  }
  void operator()(const NodeReached& fact) {
    if (v.order_.nodes().empty() || v.order_.nodes().front().sequence_id != fact.sequence_id) return;
    v.pass_node();
    news();
  }
  void operator()(const Driving& fact) {
    if (v.body_.drives == fact.is_driving) return;
    v.body_.drives = fact.is_driving;
    if (fact.is_driving && v.place_.is_on_edge && !v.order_.edges().empty())
      v.place_.drives_until = std::max(v.place_.drives_until, v.order_.edges().front().sequence_id);
    news();
  }
  void operator()(const ActionBegun& fact) {
    if (v.actions_.begun(fact.action_id)) news();
  }
  void operator()(const ActionFinished& fact) {
    if (v.actions_.ended(fact.action_id, ActionStatus::Finished, fact.result)) news();
  }
  void operator()(const ActionFailed& fact) {
    if (v.actions_.ended(fact.action_id, ActionStatus::Failed, fact.why)) news();
  }
  void operator()(const Located& fact) { v.place_.position = fact.position; }
  void operator()(const BatteryIs& fact) {
    if (v.body_.battery.charging != fact.battery.charging) news();
    v.body_.battery = fact.battery;
  }
  void operator()(const LoadsAre& fact) {
    v.body_.loads = fact.loads;
    news();
  }
  void operator()(const ErrorRaised& fact) {
    if (v.errors_.raise(fact.error)) news();
  }
  void operator()(const ErrorCleared& fact) {
    if (v.errors_.clear(fact.error_type)) news();
  }
  // It clears all orders when it enters or leaves MANUAL (table 1).
  void operator()(const ModeSet& fact) {
    if (v.body_.mode == fact.mode) return;
    if (v.body_.mode == OperatingMode::Manual || fact.mode == OperatingMode::Manual) v.drop_order();
    v.body_.mode = fact.mode;
    news();
  }
  void operator()(const SafetyIs& fact) {
    v.body_.safety = fact.safety;
    news();
  }

  void news() { v.link_.owes_state = true; }
};

void VehicleProtocol::hear(const Fact& fact) {
  std::visit(Hearing{*this}, fact);
  settle();
}

// ---- what is published

Header VehicleProtocol::next_header(Topic topic, std::int64_t now_ns) {
  const VehicleIdentity& own = settings_.identity;
  return {link_.next_header[static_cast<std::size_t>(topic)]++, timestamp_of(own.unix_seconds_at_zero, now_ns),
          std::string(own.version->number), own.manufacturer, own.serial_number};
}

Publication VehicleProtocol::connection_message(ConnectionState state, std::int64_t now_ns) {
  const Connection message{next_header(Topic::Connection, now_ns), state};
  return {Topic::Connection, write_document(message, *settings_.identity.version), 1, true,
          "header " + std::to_string(message.header.header_id) + ", " + std::string(word_of(state))};
}

Publication VehicleProtocol::last_will(std::int64_t now_ns) {
  return connection_message(ConnectionState::ConnectionBroken, now_ns);
}

Publication VehicleProtocol::farewell(std::int64_t now_ns) {
  return connection_message(ConnectionState::Offline, now_ns);
}

State VehicleProtocol::state() const {
  State state;
  const std::vector<Map>& maps = settings_.abilities.maps;
  if (!maps.empty()) state.maps = maps;
  state.order_id = order_.order_id();
  state.order_update_id = order_.update_id();
  state.last_node_id = order_.last_node_id();
  state.last_node_sequence_id = order_.last_sequence_id();
  for (const Node& node : order_.nodes()) state.node_states.push_back({node.node_id, node.sequence_id, node.released});
  for (const Edge& edge : order_.edges()) state.edge_states.push_back({edge.edge_id, edge.sequence_id, edge.released});
  state.agv_position = place_.position;
  state.loads = body_.loads;
  state.driving = body_.drives;
  state.paused = under_way_.pause == Pause::On;
  state.new_base_request = wants_base();
  state.action_states = actions_.states();
  state.battery_state = body_.battery;
  state.operating_mode = body_.mode;
  state.errors = errors_.active();
  state.safety_state = body_.safety;
  return state;
}

std::vector<Publication> VehicleProtocol::publish(std::int64_t now_ns) {
  std::vector<Publication> messages;
  if (!link_.is_open) return messages;
  const Version& version = *settings_.identity.version;
  if (std::exchange(link_.owes_online, false)) messages.push_back(connection_message(ConnectionState::Online, now_ns));
  if (std::exchange(link_.owes_factsheet, false)) {
    factsheet_.header = next_header(Topic::Factsheet, now_ns);
    messages.push_back({Topic::Factsheet, write_document(factsheet_, version), 0, true,
                        "header " + std::to_string(factsheet_.header.header_id)});
  }
  if (!link_.owes_state && now_ns - link_.state_at_ns < settings_.state_interval_ns) return messages;
  link_.owes_state = false;
  link_.state_at_ns = now_ns;
  State message = state();
  message.header = next_header(Topic::State, now_ns);
  messages.push_back({Topic::State, write_document(message, version), 0, false,
                      "header " + std::to_string(message.header.header_id) + ", order " + message.order_id +
                          " update " + std::to_string(message.order_update_id) + ", at " + message.last_node_id});
  return messages;
}

std::int64_t VehicleProtocol::next_deadline_ns() const {
  return link_.is_open ? link_.state_at_ns + settings_.state_interval_ns : std::numeric_limits<std::int64_t>::max();
}

}  // namespace fleetproof::bridges::vda5050
