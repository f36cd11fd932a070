#pragma once

#include <string>
#include <vector>

#include "core/bridges/vda5050/order_check.hpp"

// The actions of a vehicle with their life cycle, and which of them may run beside which (6.11, 6.12).
namespace fleetproof::bridges::vda5050 {

// What the body of the vehicle shall do with an action. Cancel and Pause are asked only of actions that can be
// cancelled or paused. End: the edge of the action has been left, so its effect ends.
struct ActionWish {
  enum class Kind : std::uint8_t { Start, Pause, Resume, Cancel, End };
  Kind kind = Kind::Start;
  Action action;
};

// Which element of the order an action belongs to.
struct ActionPlace {
  enum class Kind : std::uint8_t { Node, Edge, Instant };
  Kind kind = Kind::Instant;
  std::uint32_t sequence_id = 0;
  bool operator==(const ActionPlace&) const = default;
};

inline bool has_ended(ActionStatus status) {
  return status == ActionStatus::Finished || status == ActionStatus::Failed;
}
// An action with which the vehicle must not drive.
inline bool blocks_driving(const Action& action) { return action.blocking_type != BlockingType::None; }

// An action waits until it is triggered. Then it starts as soon as the blocking types allow it: SOFT and HARD while the
// vehicle stands, HARD when no other action runs, and nothing beside a running HARD one or ahead of a HARD one that was
// triggered earlier.
class ActionList {
 public:
  explicit ActionList(const Abilities& abilities) : abilities_(abilities) {}

  bool knows(std::string_view action_id) const;
  // Whether an action of this id stays: beside a new order, or beside an update that begins at this sequenceId.
  bool keeps_with_order(std::string_view action_id) const;
  bool keeps_with_update(std::string_view action_id, std::uint32_t sequence_id) const;
  void add(const Action& action, ActionPlace place);
  // An instant action that the protocol carries out itself, with its status.
  void add_own(const Action& action, ActionStatus status, std::string result = {});
  void trigger(ActionPlace place);

  // What has to be started, paused or ended, in order. The body says later how it goes.
  std::vector<ActionWish> start(bool stands);
  std::vector<ActionWish> pause();
  std::vector<ActionWish> resume();
  // The actions of the order: those that wait or can be cancelled fail, the others go on to their end.
  std::vector<ActionWish> cancel_order();
  // The edge was left: what is active on it is finished.
  std::vector<ActionWish> leave_edge(std::uint32_t sequence_id);

  // What the body says. False if there is no such action under way.
  bool begun(std::string_view action_id);
  bool ended(std::string_view action_id, ActionStatus how, const std::string& result);
  // The status of an instant action that the protocol carries out itself.
  void set_own(std::string_view action_id, ActionStatus status);

  // Actions of nodes and edges behind this one, which the horizon had.
  void forget_behind(std::uint32_t sequence_id);
  // A new order is there: all but instant actions that have not ended.
  void forget_former_order();
  // Keeps at most so many, if enough instant actions have ended: the oldest of these go.
  void keep_at_most(std::size_t count);

  // Whether a SOFT or HARD action has been triggered and has not ended.
  bool holds_vehicle() const;
  // Whether SOFT or HARD actions wait at this place.
  bool holds_vehicle_at(ActionPlace place) const;
  bool has_open_order_actions() const;  // some that have not ended
  std::vector<ActionState> states() const;

 private:
  struct Entry {
    Action action;
    ActionPlace place;
    ActionStatus status = ActionStatus::Waiting;
    ActionStatus before_pause = ActionStatus::Running;
    bool is_triggered = false, is_own = false;
    std::string result;

    bool is_under_way() const { return status != ActionStatus::Waiting && !has_ended(status); }
    bool is_of_order() const { return place.kind != ActionPlace::Kind::Instant; }
    bool outlives_order() const { return !is_of_order() && !has_ended(status); }
    bool is_behind(std::uint32_t sequence_id) const {
      return is_of_order() && place.sequence_id > sequence_id && status == ActionStatus::Waiting;
    }
  };

  Entry* under_way(std::string_view action_id);
  bool may_start(const Entry& entry, bool stands) const;
  bool can(const Entry& entry, bool Ability::*what) const;

  const Abilities& abilities_;
  std::vector<Entry> entries_;  // as received; triggered ones start in this order
};

}  // namespace fleetproof::bridges::vda5050
