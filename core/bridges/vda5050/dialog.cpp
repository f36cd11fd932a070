#include "core/bridges/vda5050/dialog.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof::bridges::vda5050 {

using agents::central::Step;

namespace {

const ActionState* find_action(const State& state, std::string_view id) {
  const auto found = std::ranges::find(state.action_states, id, &ActionState::action_id);
  return found == state.action_states.end() ? nullptr : &*found;
}

bool has_ended_in(const State& state, std::string_view id) {
  const ActionState* action = find_action(state, id);
  return action != nullptr &&
         (action->action_status == ActionStatus::Finished || action->action_status == ActionStatus::Failed);
}

Action action_of(const Step& step, std::string id) {
  Action action;
  action.action_id = std::move(id);
  action.blocking_type = BlockingType::Hard;
  action.action_type = step.charges() ? "startCharging" : step.kind == Step::Kind::Pick ? "pick" : "drop";
  if (!step.charges()) action.action_parameters = {{{"loadId", std::to_string(step.what), true}}};
  return action;
}

}  // namespace

std::string Dialog::way_name() const { return std::to_string(way_.server_boot) + "." + std::to_string(way_.agv_boot); }

void Dialog::begin(agents::central::WayNumber way) {
  way_ = way;
  leg_ = {};
  done_ = 0;
  is_joining_ = true;
}

void Dialog::recall(agents::central::WayNumber way, const Leg& leg, std::uint32_t station) {
  way_ = way;
  leg_ = leg;
  station_ = leg.number == 1 ? leg.station : station;
  is_joining_ = false;
}

Dialog::Heard Dialog::hear(const State& state, agents::central::State& to) {
  const auto station = names_.station_of(state.last_node_id);
  if (!station) return Heard::Nothing;
  if (is_joining_) {
    const bool stands = state.node_states.empty() && state.edge_states.empty() && !state.driving &&
                        state.agv_position && state.agv_position->position_initialized;
    if (!stands || !has_ended_in(state, "join " + way_name())) return Heard::Nothing;
    is_joining_ = false;
    station_ = *station;
    to.heading = heading_of(state.agv_position->theta);
  } else if (leg_.number > 0 && state.order_id == leg_name()) {
    leg_.is_known = leg_.is_known || state.order_update_id >= leg_.update;
    done_ = std::max(done_, leg_.first_step + steps_done(state));
  } else if (!has_former_leg(state, *station)) {
    return Heard::BeganAgain;
  }
  to.way = way_;
  to.stands = true;
  to.station = station_;
  to.known = leg_.first_step + static_cast<std::uint32_t>(leg_.is_known ? leg_.steps.size() : leg_.update_from);
  to.done = std::min(done_, to.known);
  to.number = ++heard_;
  to.battery = std::clamp(state.battery_state.battery_charge / 100.0, 0.0, 1.0);
  to.out_of_order =
      std::ranges::any_of(state.errors, [](const Error& e) { return e.error_level == ErrorLevel::Fatal; });
  return Heard::OfWay;
}

// It has what it had before the leg that is under way to it.
bool Dialog::has_former_leg(const State& state, std::uint32_t station) const {
  if (leg_.number == 0) return true;
  if (leg_.is_known || leg_.update > 0) return false;
  return leg_.number == 1 ? station == station_ : state.order_id == way_name() + "." + std::to_string(leg_.number - 1);
}

// A lane is done when its end was reached, and a transfer when its action has ended.
std::uint32_t Dialog::steps_done(const State& state) const {
  std::uint32_t done = 0, lanes = 0;
  for (const Step& step : leg_.steps) {
    lanes += step.drives() ? 1 : 0;
    const bool is_done =
        step.drives() ? state.last_node_sequence_id >= 2 * lanes : has_ended_in(state, action_id(done));
    if (!is_done) break;
    ++done;
  }
  return done;
}

std::uint32_t Dialog::station_after(std::size_t steps) const {
  std::uint32_t station = leg_.station;
  for (std::size_t i = 0; i < steps; ++i) {
    if (leg_.steps[i].drives()) station = map_.lane(leg_.steps[i].what).to;
  }
  return station;
}

bool Dialog::send(std::uint32_t first, std::vector<Step> steps) {
  if (is_joining_ || steps.empty() || !leg_.is_known) return false;
  const std::uint32_t sent = leg_.first_step + static_cast<std::uint32_t>(leg_.steps.size());
  if (first != sent) return false;  // the book does not know yet what the vehicle knows
  if (leg_.number > 0 && steps.front().drives()) {
    leg_.update_from = static_cast<std::uint32_t>(leg_.steps.size());
    ++leg_.update;
    leg_.steps.insert(leg_.steps.end(), steps.begin(), steps.end());
  } else {
    if (done_ < sent) return false;  // the leg before has to end
    leg_ = {leg_.number + 1, sent, leg_.number == 0 ? station_ : station_after(leg_.steps.size()), 0, 0, false,
            std::move(steps)};
  }
  leg_.is_known = false;
  return true;
}

std::optional<InstantActions> Dialog::barrier() const {
  if (!is_joining_) return std::nullopt;
  InstantActions message;
  Action& action = message.actions.emplace_back();
  action.action_type = "cancelOrder";
  action.action_id = "join " + way_name();
  action.blocking_type = BlockingType::Hard;
  return message;
}

std::optional<Order> Dialog::order() const {
  if (leg_.is_known) return std::nullopt;
  Order order;
  order.order_id = leg_name();
  order.order_update_id = leg_.update;
  std::uint32_t sequence = 0;
  const auto add_node = [&](std::uint32_t station) {
    Node& node = order.nodes.emplace_back();
    node.node_id = names_.node_id(station);
    node.sequence_id = sequence++;
    node.released = true;
  };
  // An update begins with the last node of the base, as that was sent.
  std::size_t begin = leg_.update_from;
  while (leg_.update > 0 && begin > 0 && !leg_.steps[begin - 1].drives()) --begin;
  for (std::size_t i = 0; i < begin; ++i) sequence += leg_.steps[i].drives() ? 2 : 0;
  add_node(station_after(begin));
  for (std::size_t i = begin; i < leg_.steps.size(); ++i) {
    const Step& step = leg_.steps[i];
    if (!step.drives()) {
      order.nodes.back().actions.push_back(action_of(step, action_id(i)));
      continue;
    }
    Edge& edge = order.edges.emplace_back();
    edge.edge_id = names_.edge_id(step.what);
    edge.sequence_id = sequence++;
    edge.released = true;
    edge.start_node_id = order.nodes.back().node_id;
    add_node(map_.lane(step.what).to);
    edge.end_node_id = order.nodes.back().node_id;
  }
  return order;
}

}  // namespace fleetproof::bridges::vda5050
