#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/bridges/vda5050/action_list.hpp"
#include "core/bridges/vda5050/held_order.hpp"
#include "core/bridges/vda5050/vehicle_errors.hpp"

// What VDA 5050 says that a vehicle shall do, as a pure state machine: no engine, no MQTT, no clock. In: messages of
// the master, and facts of the vehicle's body. Out: messages to publish, and wishes to the body. shall_table.md lists
// each rule of the standard with the test of it.
namespace fleetproof::bridges::vda5050 {

struct VehicleIdentity {
  const Version* version = nullptr;
  std::string manufacturer, serial_number;
  std::int64_t unix_seconds_at_zero = 0;  // for timestamps
};

struct VehicleSettings {
  VehicleIdentity identity;
  Abilities abilities;
  // Whether the map of the vehicle has an edge; none: it has all.
  std::function<bool(const Edge&)> knows_edge{};
  // False: a cancelled vehicle drives on to the node ahead, or further if it must (EdgeBegun).
  bool stops_between_nodes = false;
  // How near a node counts as "on the node" if no deviation is allowed.
  double node_tolerance_m = 0.1;
  std::int64_t state_interval_ns = 30'000'000'000;  // a state at least so often
  // It asks for a new base if so many released nodes or fewer are ahead, and a horizon behind them.
  std::uint32_t asks_for_base_at = 1;
  std::size_t most_action_states = 500, most_errors = 32;
};

// ---- facts of the body

struct ConnectionOpened {};
struct ConnectionLost {};
struct StandsAt {
  std::string node_id;
};  // at the start, or set down there: a place that the body knows
struct EdgeBegun {
  std::uint32_t sequence_id = 0;
};  // it will drive this edge to its end, whatever is cancelled
struct NodeReached {
  std::uint32_t sequence_id = 0;
};  // the first node ahead; anything else is ignored
struct Driving {
  bool is_driving = false;
};
struct ActionBegun {
  std::string action_id;
};
struct ActionFinished {
  std::string action_id, result;
};
struct ActionFailed {
  std::string action_id, why;
};
struct Located {
  AgvPosition position;
};
struct BatteryIs {
  BatteryState battery;
};
struct LoadsAre {
  std::vector<Load> loads;
};
struct ErrorRaised {
  Error error;
};  // one error of a type at a time
struct ErrorCleared {
  std::string error_type;
};
struct ModeSet {
  OperatingMode mode = OperatingMode::Automatic;
};
struct SafetyIs {
  SafetyState safety;
};

using Fact = std::variant<ConnectionOpened, ConnectionLost, StandsAt, EdgeBegun, NodeReached, Driving, ActionBegun,
                          ActionFinished, ActionFailed, Located, BatteryIs, LoadsAre, ErrorRaised, ErrorCleared,
                          ModeSet, SafetyIs>;

// ---- what comes out

struct Publication {
  Topic topic = Topic::State;
  std::string payload;
  std::uint8_t qos = 0;
  bool retained = false;
  std::string about;  // for people: "header 12, order o3 update 2"
};

struct DrivingWish {
  // The edges that may be begun now and have not been, in order: the base up to its end, or up to a node or edge at
  // which the vehicle has to stand for an action.
  std::vector<Edge> edges;
  // Stand still as soon as you can: pause, an action during which it must not drive, or a cancelled order.
  bool hold = false;
};

class VehicleProtocol {
 public:
  VehicleProtocol(VehicleSettings settings, Factsheet factsheet);
  VehicleProtocol(const VehicleProtocol&) = delete;
  VehicleProtocol& operator=(const VehicleProtocol&) = delete;

  // Messages of the master, as they came.
  void order_received(std::string_view bytes);
  void instant_actions_received(std::string_view bytes);
  void hear(const Fact& fact);

  // The last will for the connection that is about to be made (CONNECTIONBROKEN), and the message before an orderly end
  // (OFFLINE).
  Publication last_will(std::int64_t now_ns);
  Publication farewell(std::int64_t now_ns);
  // What has to be published now, in order. Nothing while there is no connection. Whatever happened since the last call
  // is in one state.
  std::vector<Publication> publish(std::int64_t now_ns);
  // When `publish` has to be called again if nothing happens before.
  std::int64_t next_deadline_ns() const;

  // What the body has to do about actions, in order; each wish once.
  std::vector<ActionWish> take_action_wishes();
  DrivingWish driving_wish() const;

  // As the next state has it, without its header.
  State state() const;
  const HeldOrder& order() const { return order_; }

 private:
  struct Hearing;  // one function for each kind of fact

  // Where the vehicle is.
  struct Whereabouts {
    bool is_on_node = false;  // on the node of `node_id`; else on an edge, or not known
    std::string node_id;
    bool is_on_edge = false;
    std::uint32_t drives_until = 0;  // the sequenceId of the last edge that it will drive in any case
    std::optional<AgvPosition> position;
  };
  struct Body {
    bool drives = false;
    BatteryState battery;
    std::vector<Load> loads;
    OperatingMode mode = OperatingMode::Automatic;
    SafetyState safety;
  };
  enum class Pause : std::uint8_t { Off, Stopping, On };
  // The instant actions under way that the protocol carries out itself.
  struct UnderWay {
    Pause pause = Pause::Off;
    std::vector<std::string> start_pauses, cancels;  // their actionIds
  };
  struct Link {
    bool is_open = false, owes_online = false, owes_factsheet = false, owes_state = false;
    std::int64_t state_at_ns = 0;                // the last one
    std::array<std::uint32_t, 6> next_header{};  // by topic
  };

  bool is_executing() const;
  bool is_in_control() const;
  bool is_near(const Node& node) const;
  std::optional<Refusal> refuse_now(const Order& order, bool is_update) const;
  std::optional<Refusal> refuse_used_ids(const Order& order, bool is_update) const;
  void reject(const Order& order, const Refusal& refusal);
  void accept(const Order& order, bool is_update);
  void do_instant_action(const Action& action, const Header& header);
  void begin_cancel(const Action& action);
  const char* why_not_at(const Action& action) const;
  void begin_pause(const Action& action);
  void end_pause();
  void drop_order();
  bool wants_base() const;
  void pass_node();
  void enter_edge();
  void settle();
  Header next_header(Topic topic, std::int64_t now_ns);
  Publication connection_message(ConnectionState state, std::int64_t now_ns);

  const VehicleSettings settings_;
  Factsheet factsheet_;
  HeldOrder order_;
  ActionList actions_;
  VehicleErrors errors_;
  Whereabouts place_;
  Body body_;
  UnderWay under_way_;
  Link link_;
  std::vector<ActionWish> wishes_;
};

}  // namespace fleetproof::bridges::vda5050
