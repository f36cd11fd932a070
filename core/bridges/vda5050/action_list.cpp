#include "core/bridges/vda5050/action_list.hpp"

#include <algorithm>

namespace fleetproof::bridges::vda5050 {

using Kind = ActionWish::Kind;

bool ActionList::knows(std::string_view action_id) const {
  return std::ranges::any_of(entries_, [&](const Entry& entry) { return entry.action.action_id == action_id; });
}

bool ActionList::keeps_with_order(std::string_view action_id) const {
  return std::ranges::any_of(
      entries_, [&](const Entry& entry) { return entry.action.action_id == action_id && entry.outlives_order(); });
}

bool ActionList::keeps_with_update(std::string_view action_id, std::uint32_t sequence_id) const {
  return std::ranges::any_of(entries_, [&](const Entry& entry) {
    return entry.action.action_id == action_id && !entry.is_behind(sequence_id);
  });
}

void ActionList::add(const Action& action, ActionPlace place) {
  entries_.push_back({action,
                      place,
                      ActionStatus::Waiting,
                      ActionStatus::Running,
                      place.kind == ActionPlace::Kind::Instant,
                      false,
                      {}});
}

void ActionList::add_own(const Action& action, ActionStatus status, std::string result) {
  entries_.push_back({action, {}, status, status, true, true, std::move(result)});
}

void ActionList::trigger(ActionPlace place) {
  for (Entry& entry : entries_) entry.is_triggered |= entry.place == place;
}

bool ActionList::can(const Entry& entry, bool Ability::*what) const {
  const Ability* ability = abilities_.find(entry.action.action_type);
  return ability != nullptr && ability->*what;
}

bool ActionList::may_start(const Entry& entry, bool stands) const {
  if (blocks_driving(entry.action) && !stands) return false;
  const bool is_hard = entry.action.blocking_type == BlockingType::Hard;
  bool is_earlier = true;
  for (const Entry& other : entries_) {
    if (&other == &entry) {
      is_earlier = false;
      continue;
    }
    if (other.is_own || has_ended(other.status) || !other.is_triggered) continue;
    const bool one_is_hard = is_hard || other.action.blocking_type == BlockingType::Hard;
    if (one_is_hard && (other.is_under_way() || is_earlier)) return false;
  }
  return true;
}

std::vector<ActionWish> ActionList::start(bool stands) {
  std::vector<ActionWish> wishes;
  for (Entry& entry : entries_) {
    if (!entry.is_triggered || entry.status != ActionStatus::Waiting || !may_start(entry, stands)) continue;
    entry.status = ActionStatus::Initializing;
    wishes.push_back({Kind::Start, entry.action});
  }
  return wishes;
}

std::vector<ActionWish> ActionList::pause() {
  std::vector<ActionWish> wishes;
  for (Entry& entry : entries_) {
    const bool runs = entry.is_under_way() && entry.status != ActionStatus::Paused && !entry.is_own;
    if (!runs || !can(entry, &Ability::can_be_paused)) continue;
    entry.before_pause = entry.status;
    entry.status = ActionStatus::Paused;
    wishes.push_back({Kind::Pause, entry.action});
  }
  return wishes;
}

std::vector<ActionWish> ActionList::resume() {
  std::vector<ActionWish> wishes;
  for (Entry& entry : entries_) {
    if (entry.status != ActionStatus::Paused) continue;
    entry.status = entry.before_pause;
    wishes.push_back({Kind::Resume, entry.action});
  }
  return wishes;
}

std::vector<ActionWish> ActionList::cancel_order() {
  std::vector<ActionWish> wishes;
  for (Entry& entry : entries_) {
    if (!entry.is_of_order() || has_ended(entry.status)) continue;
    if (entry.is_under_way()) {
      if (!can(entry, &Ability::can_be_cancelled)) continue;
      wishes.push_back({Kind::Cancel, entry.action});
    }
    entry.status = ActionStatus::Failed;
    entry.result = "the order was cancelled";
  }
  return wishes;
}

std::vector<ActionWish> ActionList::leave_edge(std::uint32_t sequence_id) {
  std::vector<ActionWish> wishes;
  for (Entry& entry : entries_) {
    if (entry.place != ActionPlace{ActionPlace::Kind::Edge, sequence_id} || has_ended(entry.status)) continue;
    const bool has_begun = entry.is_under_way();
    if (has_begun) wishes.push_back({Kind::End, entry.action});
    entry.status = has_begun ? ActionStatus::Finished : ActionStatus::Failed;
    entry.result = has_begun ? "" : "the edge was left before the action could start";
  }
  return wishes;
}

ActionList::Entry* ActionList::under_way(std::string_view action_id) {
  const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.action.action_id == action_id && entry.is_under_way() && !entry.is_own;
  });
  return found == entries_.end() ? nullptr : &*found;
}

bool ActionList::begun(std::string_view action_id) {
  Entry* entry = under_way(action_id);
  if (entry == nullptr) return false;
  if (entry->status == ActionStatus::Paused) {
    entry->before_pause = ActionStatus::Running;
  } else {
    entry->status = ActionStatus::Running;
  }
  return true;
}

bool ActionList::ended(std::string_view action_id, ActionStatus how, const std::string& result) {
  Entry* entry = under_way(action_id);
  if (entry == nullptr) return false;
  entry->status = how;
  entry->result = result;
  return true;
}

void ActionList::set_own(std::string_view action_id, ActionStatus status) {
  for (Entry& entry : entries_) {
    if (entry.is_own && entry.action.action_id == action_id) entry.status = status;
  }
}

void ActionList::forget_behind(std::uint32_t sequence_id) {
  std::erase_if(entries_, [&](const Entry& entry) { return entry.is_behind(sequence_id); });
}

void ActionList::forget_former_order() {
  std::erase_if(entries_, [](const Entry& entry) { return !entry.outlives_order(); });
}

void ActionList::keep_at_most(std::size_t count) {
  for (auto entry = entries_.begin(); entry != entries_.end() && entries_.size() > count;) {
    entry = !entry->is_of_order() && has_ended(entry->status) ? entries_.erase(entry) : entry + 1;
  }
}

bool ActionList::holds_vehicle() const {
  return std::ranges::any_of(entries_, [](const Entry& entry) {
    return !entry.is_own && entry.is_triggered && !has_ended(entry.status) && blocks_driving(entry.action);
  });
}

bool ActionList::holds_vehicle_at(ActionPlace place) const {
  return std::ranges::any_of(entries_, [&](const Entry& entry) {
    return entry.place == place && !has_ended(entry.status) && blocks_driving(entry.action);
  });
}

bool ActionList::has_open_order_actions() const {
  return std::ranges::any_of(entries_,
                             [](const Entry& entry) { return entry.is_of_order() && !has_ended(entry.status); });
}

std::vector<ActionState> ActionList::states() const {
  std::vector<ActionState> states;
  for (const Entry& entry : entries_) {
    ActionState state{entry.action.action_id, entry.action.action_type, entry.status, {}};
    if (!entry.result.empty()) state.result_description = entry.result;
    states.push_back(state);
  }
  return states;
}

}  // namespace fleetproof::bridges::vda5050
