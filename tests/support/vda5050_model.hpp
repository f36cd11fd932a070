#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/support/vda5050_state.hpp"

// A model of the AGV that VDA 5050 describes, written from the standard alone: what a state message may say after each
// input. Where the standard leaves a choice, the model keeps every possible state, and a judged report strikes out
// those that it contradicts. tests/support/vda5050_choices.md lists the choices.
namespace fleetproof::test::vda5050_model {

struct Input {
  enum class Kind {
    Order,               // text
    InstantActions,      // text
    NodeReached,         // node_id, sequence, position. It also leaves the edge before the node (6.10.2).
    EdgeEntered,         // sequence: the AGV begins to move on this edge
    Stopped,             // the AGV stands: node_id (empty between nodes), position
    ActionBegun,         // action_id
    ActionFinished,      // action_id
    ActionFailed,        // action_id
    PauseEffective,      // on: the AGV stands paused, or is free again
    ConnectionLost,      // inputs by MQTT are lost until it is restored
    ConnectionRestored,  //
    Restarted            // the AGV stands, and connects
  };
  Kind kind = Kind::Order;
  std::string text;
  std::string node_id, action_id;
  std::uint32_t sequence = 0;
  Position position;
  bool on = false;
  // The AGV may have concluded this fact by itself: that it stands on the first node of a new order, or that an action
  // ended by a cancel has failed. The model takes it as news or as a repetition.
  bool may_be_known = false;
};

std::string_view name_of(Input::Kind kind);

// One state that the standard allows.
struct Alternative {
  std::string order_id;
  std::uint32_t order_update_id = 0;
  LastNode last;
  std::vector<NodeState> nodes;
  std::vector<EdgeState> edges;
  std::map<std::string, StatusSet> actions;
  std::set<std::string> actions_that_may_be_absent;
  std::vector<ExpectedError> errors;
  std::set<bool> paused;
  bool new_base_request_allowed = false;  // 6.10.3: "can set"
  std::vector<std::uint32_t> drivable_edges;
  bool must_publish = false;  // 6.10: the input is one of the events that trigger a state message
  std::string why;            // the choice that this alternative takes
};

struct Expectation {
  std::vector<Alternative> alternatives;  // never empty; the first one is the plain reading
  bool must_send_factsheet = false;       // 6.8.2
  bool must_announce_online = false;      // 6.14
};

struct ReportedError {
  std::string type, level;
  std::map<std::string, std::string> references;
};

// What an AGV said or would say after an input.
struct Report {
  std::string order_id;
  std::uint32_t order_update_id = 0;
  LastNode last;
  std::vector<NodeState> nodes;
  std::vector<EdgeState> edges;  // without start
  std::map<std::string, Status> actions;
  std::vector<ReportedError> errors;
  std::optional<bool> paused, new_base_request;
  std::optional<std::vector<std::uint32_t>> drives;  // edges that it would drive now, if known
  bool published = false, sent_factsheet = false, announced_online = false;
};

// Reads the document of topic "state"; throws std::runtime_error if a field of 6.10.6 that the model compares is
// missing or has another type.
Report read_report(std::string_view state_document);

class VehicleModel {
 public:
  explicit VehicleModel(VehicleTraits traits);

  Expectation apply(const Input& input);

  // What the report says against the last expectation: empty if one alternative allows it. Alternatives that do not are
  // struck out, and choices that the report shows are kept.
  std::vector<std::string> judge(const Report& report);

  // Strikes out all but the plain reading: for those who have no AGV to ask.
  void assume_plain_reading();

  const State& plain_state() const { return possible_.front().state; }
  const VehicleTraits& traits() const { return traits_; }

  struct Possible {
    State state;
    bool must_publish = false;
  };

 private:
  VehicleTraits traits_;
  std::vector<Possible> possible_;
  Expectation expected_;
  std::optional<Report> before_;
};

// What one state and one input lead to.
struct Consequence {
  std::vector<VehicleModel::Possible> possible;
  bool must_send_factsheet = false, must_announce_online = false;
};
Consequence consequence_of(const State& state, const Input& input, const VehicleTraits& traits);

}  // namespace fleetproof::test::vda5050_model
