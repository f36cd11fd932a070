#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Documents of the topics "order" and "instantActions" of VDA 5050 (2.0.0 and 2.1.0), as an independent reader of the
// standard understands them. Numbers in brackets are sections of VDA5050_EN.md, version 2.1.0.
namespace fleetproof::test::vda5050_model {

enum class Blocking { None, Soft, Hard };

struct Action {
  std::string id, type;
  Blocking blocking = Blocking::None;
  friend bool operator==(const Action&, const Action&) = default;
};

struct Position {
  double x = 0.0, y = 0.0;
  friend bool operator==(const Position&, const Position&) = default;
};

struct NodePosition {
  Position at;
  double allowed_deviation_m = 0.0;
};

struct OrderNode {
  std::string id;
  std::uint32_t sequence = 0;
  bool released = false;
  std::optional<NodePosition> position;
  std::vector<Action> actions;
};

struct OrderEdge {
  std::string id, start, end;
  std::uint32_t sequence = 0;
  bool released = false;
  std::vector<Action> actions;
};

struct Order {
  std::string id;
  std::uint32_t update = 0;
  std::vector<OrderNode> nodes;
  std::vector<OrderEdge> edges;
};

// What is wrong with a document. The standard names one error for a malformed order (6.6.4.1: "validationError"). It
// does not say whether a graph that breaks a rule of 6.6.1 is malformed, too: so the two are told apart.
enum class Flaw { None, Malformed, BrokenGraph };

struct ReadOrder {
  Order order;  // as far as it could be read
  Flaw flaw = Flaw::None;
  std::string why;  // for people
};

// Never throws: every text is an order or has a flaw.
ReadOrder read_order(std::string_view text);

struct ReadInstantActions {
  std::vector<Action> actions;
  bool malformed = false;
};

// The list is called "actions" (6.9), and "instantActions" in the schema of 2.0.0: both are read.
ReadInstantActions read_instant_actions(std::string_view text);

// What the header of 6.4 says apart from the time, which is always the same.
struct Header {
  std::uint32_t id = 0;
  std::string version = "2.1.0";
};

std::string write_order(const Order& order, const Header& header);
std::string write_instant_actions(const std::vector<Action>& actions, const Header& header);

}  // namespace fleetproof::test::vda5050_model
