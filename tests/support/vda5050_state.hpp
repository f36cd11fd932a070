#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/vda5050_documents.hpp"

// What an AGV knows and reports, as VDA 5050 fixes it. Numbers in brackets are sections of VDA5050_EN.md,
// version 2.1.0; "2.0.0" marks what only that version says.
namespace fleetproof::test::vda5050_model {

enum class Version { V2_0_0, V2_1_0 };

// What the standard leaves to the AGV or its integrator.
struct VehicleTraits {
  Version version = Version::V2_1_0;
  bool stops_between_nodes = true;                        // 6.6.3, Figure 9
  std::set<std::string> uninterruptible{"pick", "drop"};  // action types that a cancel cannot end (6.6.3)
  std::set<std::string> known{"pick", "drop", "beep", "wait", "lift", "finePositioning", "detectObject"};
  double tolerance_m = 0.1;  // "normal tolerance" of a node with no or zero allowedDeviationXY (6.6.6)
  std::string start_node;    // where it stands at the beginning; empty if on none
  Position start_position;
};

// Table 2 of 6.11.
enum class Status { Waiting, Initializing, Running, Paused, Finished, Failed };
using StatusSet = std::set<Status>;

std::string_view name_of(Status status);
std::optional<Status> status_of(std::string_view name);

// Where an action came from. Control: instant actions that concern the order or the AGV itself (startPause, stopPause,
// cancelOrder, stateRequest, factsheetRequest): they take part in no blocking.
enum class Scope { Node, Edge, Instant, Control };

enum class Phase {
  Untriggered,  // its node is not reached, its edge not entered
  Triggered,    // by a traversal (6.10.2) or as an instant action (6.9); the body has not begun it
  Begun,
  Over
};

struct TrackedAction {
  Action action;
  Scope scope = Scope::Node;
  std::uint32_t sequence = 0;  // of its node or edge
  bool released = true;        // false: in the horizon
  Phase phase = Phase::Untriggered;
  std::uint32_t trigger = 0;        // counts triggers
  StatusSet may_be;                 // Over, or Control: what may be reported
  std::optional<Status> seen;       // what was reported last, if a report was judged
  bool may_be_interrupted = false;  // by a cancel (6.6.3): FAILED at any time
  bool may_be_absent = false;
  friend bool operator==(const TrackedAction&, const TrackedAction&) = default;
};

struct NodeState {
  std::string id;
  std::uint32_t sequence = 0;
  bool released = false;
  friend bool operator==(const NodeState&, const NodeState&) = default;
};

struct EdgeState {
  std::string id, start;
  std::uint32_t sequence = 0;
  bool released = false;
  friend bool operator==(const EdgeState&, const EdgeState&) = default;
};

struct LastNode {
  std::string id;
  std::uint32_t sequence = 0;
  friend bool operator==(const LastNode&, const LastNode&) = default;
};

// An error that must be, or may be, in the state.
struct ExpectedError {
  std::set<std::string> types;                    // one of these
  std::map<std::string, std::string> references;  // that it must have
  bool any_reference = false;                     // it must have at least one
  bool must = true;
  bool lasting = false;  // "shall be reported until the vehicle has accepted a new order" (6.6.4.1, 6.6.4.2)
  friend bool operator==(const ExpectedError&, const ExpectedError&) = default;
};

enum class Cancel { No, Running, Done };
enum class Motion { Standing, Moving, Unknown };

struct OrderProgress {
  std::string id;
  std::uint32_t update = 0;
  LastNode last;
  std::deque<NodeState> nodes;
  std::deque<EdgeState> edges;
  Cancel cancel = Cancel::No;
  friend bool operator==(const OrderProgress&, const OrderProgress&) = default;
};

struct Body {
  std::string on_node;  // empty: between nodes
  Position position;
  bool position_known = true;
  Motion motion = Motion::Standing;
  bool online = true;
  friend bool operator==(const Body&, const Body&) = default;
};

inline constexpr std::string_view kCancelOrder = "cancelOrder", kStartPause = "startPause", kStopPause = "stopPause";

struct Pause {
  bool paused = false;
  bool known = true;              // false: not said since a restart
  std::optional<bool> requested;  // by an instant action, not effective yet
  friend bool operator==(const Pause&, const Pause&) = default;
};

struct State {
  OrderProgress order;
  Body body;
  Pause pause;
  std::vector<TrackedAction> actions;
  std::vector<ExpectedError> errors;
  std::uint32_t triggers = 0;
  std::string why;  // the choice that led here, for people
};

// Whether two states allow the same from now on.
bool is_same(const State& a, const State& b);

// The pause mode is in force, or no more: ends the instant actions that asked for it (6.8.2).
void settle_pause(State& state, bool paused);

TrackedAction* find_action(State& state, std::string_view id);
const TrackedAction* find_action(const State& state, std::string_view id);

bool is_order_action(const TrackedAction& action);
bool is_over(const TrackedAction& action);

// Everything that the standard allows as actionStatus now.
StatusSet allowed_statuses(const State& state, const TrackedAction& action);

// Whether a HARD action, or another one while it is HARD itself, keeps this triggered action from starting (6.12).
bool is_held_back(const State& state, const TrackedAction& action);

// Whether a SOFT or HARD action forbids to drive (6.12): begun, or triggered and still to come, because the AGV stops
// before it executes the list (Figure 17).
bool is_drive_blocked(const State& state);

// Whether this is an action of the edge ahead that is triggered when the AGV begins to move again (6.10.2).
bool is_at_edge_entry(const State& state, const TrackedAction& action);

// Figure 8 (3): nodes left to traverse or actions of the order that are not over, or a cancel under way.
bool is_executing(const State& state);

// sequenceIds of the released edges ahead that the AGV may drive now: empty if paused, blocked or cancelled.
std::vector<std::uint32_t> drivable_edges(const State& state, const VehicleTraits& traits);

// The last node of the base, or the last node reached: where an update must begin (6.6.2).
LastNode decision_point(const State& state);

}  // namespace fleetproof::test::vda5050_model
