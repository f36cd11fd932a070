// The model of an AGV against what VDA 5050 says and shows: each case quotes a section or a figure of VDA5050_EN.md,
// version 2.1.0, unless it names 2.0.0.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/vda5050_model.hpp"

namespace fleetproof::test::vda5050_model::vda5050_model_test {
namespace {

using enum Status;
using Kind = Input::Kind;

// "f d g | b h": nodes in their order, the horizon behind the bar. Edges are called after their ends.
Order path(const std::string& id, std::uint32_t update, const std::string& nodes, std::uint32_t first_sequence = 0) {
  Order order;
  order.id = id;
  order.update = update;
  bool released = true;
  std::istringstream words(nodes);
  for (std::string word; words >> word;) {
    if (word == "|") {
      released = false;
      continue;
    }
    const auto sequence = first_sequence + 2 * static_cast<std::uint32_t>(order.nodes.size());
    if (!order.nodes.empty())
      order.edges.push_back(
          {order.nodes.back().id + "-" + word, order.nodes.back().id, word, sequence - 1, released, {}});
    order.nodes.push_back({word, sequence, released, {}, {}});
  }
  return order;
}

Action action(const std::string& id, Blocking blocking = Blocking::None, const std::string& type = "beep") {
  return {id, type, blocking};
}

Input fact(Kind kind, const std::string& action_id = {}) {
  Input input;
  input.kind = kind;
  input.action_id = action_id;
  return input;
}

Input document(Kind kind, std::string text) {
  Input input = fact(kind);
  input.text = std::move(text);
  return input;
}

// An AGV that stands on node f and takes the plain reading, unless a case looks at all of them.
class Vda5050Model : public testing::Test {
 protected:
  static VehicleTraits traits_of(Version version, bool stops_between_nodes) {
    VehicleTraits traits;
    traits.version = version;
    traits.stops_between_nodes = stops_between_nodes;
    traits.start_node = "f";
    return traits;
  }

  void become(Version version, bool stops_between_nodes) {
    model = VehicleModel(traits_of(version, stops_between_nodes));
  }

  const Alternative& take(const Input& input) {
    said = model.apply(input);
    all = said.alternatives;
    model.assume_plain_reading();
    return all.front();
  }

  const Alternative& send(const Order& order) { return take(document(Kind::Order, write_order(order, {}))); }

  // Sends a new order and lets the body confirm that it stands on the first node.
  const Alternative& start(const Order& order) {
    send(order);
    return reach(order.nodes.front().id, order.nodes.front().sequence);
  }

  const Alternative& instant(const std::string& type, const std::string& id, Blocking blocking = Blocking::None) {
    return take(document(Kind::InstantActions, write_instant_actions({{id, type, blocking}}, {})));
  }

  const Alternative& reach(const std::string& node, std::uint32_t sequence) {
    Input input = fact(Kind::NodeReached);
    input.node_id = node;
    input.sequence = sequence;
    return take(input);
  }

  const Alternative& enter(std::uint32_t edge) {
    Input input = fact(Kind::EdgeEntered);
    input.sequence = edge;
    return take(input);
  }

  const Alternative& stop(const std::string& node = {}, Position position = {}) {
    Input input = fact(Kind::Stopped);
    input.node_id = node;
    input.position = position;
    return take(input);
  }

  const Alternative& begin(const std::string& id) { return take(fact(Kind::ActionBegun, id)); }
  const Alternative& finish(const std::string& id) { return take(fact(Kind::ActionFinished, id)); }
  const Alternative& fail(const std::string& id) { return take(fact(Kind::ActionFailed, id)); }

  const Alternative& pause(bool on) {
    Input input = fact(Kind::PauseEffective);
    input.on = on;
    return take(input);
  }

  bool is_allowed(const std::function<bool(const Alternative&)>& what) const { return std::ranges::any_of(all, what); }

  VehicleModel model{traits_of(Version::V2_1_0, true)};
  Expectation said;
  std::vector<Alternative> all;
};

std::string nodes(const Alternative& state) {
  std::string text;
  for (const NodeState& node : state.nodes) text += (text.empty() ? "" : " ") + node.id + (node.released ? "" : "?");
  return text;
}

std::string edges(const Alternative& state) {
  std::string text;
  for (const EdgeState& edge : state.edges) text += (text.empty() ? "" : " ") + edge.id + (edge.released ? "" : "?");
  return text;
}

StatusSet status(const Alternative& state, const std::string& id) {
  const auto found = state.actions.find(id);
  return found == state.actions.end() ? StatusSet{} : found->second;
}

std::set<std::string> required_errors(const Alternative& state) {
  std::set<std::string> types;
  for (const ExpectedError& error : state.errors) {
    if (error.must) types.insert(error.types.begin(), error.types.end());
  }
  return types;
}

using Edges = std::vector<std::uint32_t>;
using Names = std::set<std::string>;

// Figure 5, as the order of t = 1 in Figures 4 and 7.
Order figure_5() { return path("1234", 0, "f d g | b h"); }
Order figure_6() { return path("1234", 1, "g b h | i", 4); }

// ---- 6.6.1 and 6.6.2: orders

TEST_F(Vda5050Model, KeepsTheHorizonInItsStates) {  // Figure 7, t = 1
  const Alternative& state = send(figure_5());
  EXPECT_EQ(nodes(state), "f d g b? h?");
  EXPECT_EQ(edges(state), "f-d d-g g-b? b-h?");
  EXPECT_EQ(state.order_id, "1234");
  EXPECT_TRUE(state.must_publish);
}

TEST_F(Vda5050Model, MayCountTheFirstNodeAsTraversedAtOnce) {  // Figure 7, t = 2
  send(figure_5());
  EXPECT_TRUE(is_allowed([](const Alternative& a) { return nodes(a) == "d g b? h?" && a.last == LastNode{"f", 0}; }));
}

TEST_F(Vda5050Model, DrivesToTheDecisionPointAndNoFurther) {
  const Alternative& state = start(figure_5());
  EXPECT_EQ(state.drivable_edges, (Edges{1, 3}));
  reach("d", 2);
  EXPECT_EQ(reach("g", 4).drivable_edges, Edges{});
  EXPECT_EQ(nodes(all.front()), "b? h?");
}

TEST_F(Vda5050Model, AppendsAnUpdateAtTheLastReleasedNode) {  // Figures 6 and 7, t = 3
  start(figure_5());
  reach("d", 2);
  const Alternative& state = send(figure_6());
  EXPECT_EQ(nodes(state), "g b h i?");
  EXPECT_EQ(edges(state), "d-g g-b b-h h-i?");
  EXPECT_EQ(state.order_update_id, 1U);
  EXPECT_EQ(state.drivable_edges, (Edges{3, 5, 7}));
  EXPECT_EQ(required_errors(state), Names{});
}

TEST_F(Vda5050Model, ReplacesTheHorizonByAnother) {  // Figure 4
  start(figure_5());
  EXPECT_EQ(nodes(send(path("1234", 1, "g c | k", 4))), "d g c k?");
}

TEST_F(Vda5050Model, DeletesTheHorizonIfTheUpdateHasNone) {  // "The horizon can also be deleted."
  start(figure_5());
  EXPECT_EQ(nodes(send(path("1234", 1, "g", 4))), "d g");
}

TEST_F(Vda5050Model, ForgetsTheActionsOfAHorizonThatIsReplaced) {  // Figure 8: "clear horizon"
  Order order = figure_5();
  order.nodes[3].actions = {action("at b")};
  order.nodes[2].actions = {action("at g")};
  start(order);
  EXPECT_EQ(status(all.front(), "at b"), StatusSet{Waiting});
  const Alternative& state = send(path("1234", 1, "g c", 4));
  EXPECT_EQ(status(state, "at b"), StatusSet{});
  EXPECT_EQ(status(state, "at g"), StatusSet{Waiting});
}

TEST_F(Vda5050Model,
       KeepsTheContentsOfTheStitchingNode) {  // "the contents of the stitching node [...] are not changed"
  Order order = figure_5();
  order.nodes[2].actions = {action("first")};
  start(order);
  Order update = figure_6();
  update.nodes.front().actions = {action("second")};
  const Alternative& state = send(update);
  EXPECT_EQ(status(state, "first"), StatusSet{Waiting});
  EXPECT_EQ(status(state, "second"), StatusSet{});
}

TEST_F(Vda5050Model,
       RejectsAnUpdateThatBeginsBeforeTheDecisionPoint) {  // "a retransmission of nodes f and d is not valid"
  start(figure_5());
  const Alternative& state = send(path("1234", 1, "d g b", 2));
  EXPECT_EQ(nodes(state), "d g b? h?");
  EXPECT_EQ(state.order_update_id, 0U);
  EXPECT_EQ(required_errors(state), Names{"orderUpdateError"});
}

TEST_F(Vda5050Model, RejectsAnUpdateAtTheRightNodeWithAnotherSequenceId) {  // "the same nodeId (and nodeSequenceId)"
  start(figure_5());
  EXPECT_EQ(required_errors(send(path("1234", 1, "g b h", 6))), Names{"orderUpdateError"});
}

TEST_F(Vda5050Model, NamesTheUpdateThatItRejects) {  // 6.6.6, orderUpdateId: "to be passed in the rejection message"
  start(figure_5());
  const Alternative& state = send(path("1234", 7, "d g b", 2));
  EXPECT_EQ(state.errors.front().references.at("orderUpdateId"), "7");
}

TEST_F(Vda5050Model, RejectsALowerUpdateIdAndGoesOn) {  // 6.6.4.3
  start(figure_5());
  send(path("1234", 3, "g b", 4));
  const Alternative& state = send(path("1234", 2, "b h", 6));
  EXPECT_EQ(required_errors(state), Names{"orderUpdateError"});
  EXPECT_EQ(state.order_update_id, 3U);
  EXPECT_EQ(nodes(state), "d g b");
  EXPECT_EQ(state.drivable_edges, (Edges{1, 3, 5}));
}

TEST_F(Vda5050Model, IgnoresTheSameUpdateSentTwice) {  // 6.6.4.3: "the second order will be ignored"
  start(figure_5());
  const Alternative& state = send(path("1234", 0, "x y z"));
  EXPECT_EQ(nodes(state), "d g b? h?");
  EXPECT_EQ(required_errors(state), Names{});
  EXPECT_FALSE(state.must_publish);
}

TEST_F(Vda5050Model, AcceptsAnUpdateIdThatSkipsSome) {  // Figure 8 asks for smaller and equal only
  start(figure_5());
  EXPECT_EQ(send(path("1234", 9, "g b", 4)).order_update_id, 9U);
}

TEST_F(Vda5050Model, RejectsANewOrderWhileItExecutesOne) {  // Figure 8 (3)
  start(figure_5());
  const Alternative& state = send(path("5678", 0, "f d"));
  EXPECT_EQ(state.order_id, "1234");
  EXPECT_TRUE(required_errors(state).contains("orderUpdateError"));
}

TEST_F(Vda5050Model, RejectsANewOrderWhileItWaitsForTheHorizon) {  // "Vehicle might still have a horizon"
  start(path("1234", 0, "f d | g"));
  reach("d", 2);
  EXPECT_EQ(send(path("5678", 0, "d x")).order_id, "1234");
}

TEST_F(Vda5050Model, RejectsANewOrderWhileAnActionRuns) {  // Figure 8 (3): states neither FAILED nor FINISHED
  Order order = path("1234", 0, "f");
  order.nodes[0].actions = {action("pick", Blocking::Hard, "pick")};
  start(order);
  begin("pick");
  EXPECT_EQ(send(path("5678", 0, "f d")).order_id, "1234");
  finish("pick");
  EXPECT_EQ(send(path("5678", 0, "f d")).order_id, "5678");
}

TEST_F(Vda5050Model, LeavesOpenWhetherAnActionAtTheEndKeepsANewOrderOut) {  // Figure 8 of 2.0.0: "&&"
  become(Version::V2_0_0, true);
  Order order = path("1234", 0, "f");
  order.nodes[0].actions = {action("pick", Blocking::Hard, "pick")};
  start(order);
  begin("pick");
  send(path("5678", 0, "f d"));
  EXPECT_TRUE(is_allowed([](const Alternative& a) { return a.order_id == "1234"; }));
  EXPECT_TRUE(is_allowed([](const Alternative& a) { return a.order_id == "5678"; }));
}

TEST_F(Vda5050Model, RejectsANewOrderWithNodesAheadInBothVersions) {
  become(Version::V2_0_0, true);
  start(figure_5());
  send(path("5678", 0, "f d"));
  EXPECT_FALSE(is_allowed([](const Alternative& a) { return a.order_id == "5678"; }));
}

TEST_F(Vda5050Model, AcceptsANewOrderWhenTheOldOneIsDone) {
  start(path("1234", 0, "f d"));
  reach("d", 2);
  const Alternative& state = start(path("5678", 0, "d g"));
  EXPECT_EQ(state.order_id, "5678");
  EXPECT_EQ(state.last, (LastNode{"d", 0}));
}

TEST_F(Vda5050Model, RejectsANewOrderWhoseFirstNodeIsOutOfReach) {  // 6.6.1, Figure 8 (4)
  EXPECT_EQ(send(path("1234", 0, "q d")).order_id, "");
  EXPECT_TRUE(required_errors(all.front()).contains("noRouteError"));
}

TEST_F(Vda5050Model, NamesTheFirstNodeThatIsOutOfReach) {  // Figure 8 of 2.0.0
  become(Version::V2_0_0, true);
  send(path("1234", 0, "q d"));
  EXPECT_EQ(required_errors(all.front()), Names{"noRouteError"});
  EXPECT_EQ(all.front().errors.front().references.at("nodeId"), "q");
}

TEST_F(Vda5050Model, AcceptsAFirstNodeWithinItsDeviationRange) {  // 6.6.1
  Order order = path("1234", 0, "q d");
  order.nodes[0].position = NodePosition{{1.0, 0.0}, 2.0};
  EXPECT_EQ(send(order).order_id, "1234");
}

TEST_F(Vda5050Model, ContinuesACompletedOrderAtItsLastNode) {  // Figure 8 (8)
  start(path("1234", 0, "f d"));
  reach("d", 2);
  EXPECT_EQ(nodes(send(path("1234", 1, "d g", 2))), "g");
}

TEST_F(Vda5050Model, DoesNotContinueACompletedOrderElsewhere) {  // Figure 8 (8)
  start(path("1234", 0, "f d"));
  reach("d", 2);
  EXPECT_EQ(required_errors(send(path("1234", 1, "f d", 0))), Names{"orderUpdateError"});
}

// ---- 6.6.4: rejection

TEST_F(Vda5050Model, ReportsAMalformedOrderUntilItAcceptsANewOne) {  // 6.6.4.1
  EXPECT_EQ(required_errors(take(document(Kind::Order, "{\"orderId\": "))), Names{"validationError"});
  EXPECT_EQ(required_errors(instant("stateRequest", "s")), Names{"validationError"});
  const Alternative& state = send(figure_5());
  EXPECT_TRUE(state.errors.empty());
}

TEST_F(Vda5050Model, RejectsAnOrderWithAnUnknownAction) {  // 6.6.4.2, Figure 16: "must not be reported as failed"
  Order order = figure_5();
  order.nodes[1].actions = {action("fly", Blocking::Hard, "fly")};
  const Alternative& state = send(order);
  EXPECT_EQ(required_errors(state), Names{"orderError"});
  EXPECT_TRUE(state.errors.front().any_reference);
  EXPECT_EQ(state.order_id, "");
  EXPECT_EQ(status(state, "fly"), StatusSet{});
}

TEST_F(Vda5050Model, FindsGraphsThatBreakTheRules) {  // 6.6.1
  Order unreleased_end = path("1", 0, "f d");
  unreleased_end.nodes[1].released = false;
  Order released_behind = path("1", 0, "f d | g");
  released_behind.nodes[2].released = true;
  Order edge_too_few = path("1", 0, "f d");
  edge_too_few.edges.clear();
  for (const Order& order : {unreleased_end, released_behind, edge_too_few, Order{"1", 0, {}, {}}}) {
    EXPECT_EQ(read_order(write_order(order, {})).flaw, Flaw::BrokenGraph);
  }
  EXPECT_EQ(read_order(write_order(path("1", 0, "f"), {})).flaw, Flaw::None) << "one node is enough for a valid order";
  EXPECT_EQ(read_order(write_order(path("1", 0, "f | d"), {})).flaw, Flaw::None);
}

// ---- 6.6.3: cancel

TEST_F(Vda5050Model, StopsWhereItIsAfterACancel) {  // Figure 9, right
  start(figure_5());
  enter(1);
  const Alternative& told = instant("cancelOrder", "c");
  EXPECT_EQ(status(told, "c"), StatusSet{Running});
  EXPECT_EQ(told.drivable_edges, Edges{});
  const Alternative& state = stop();
  EXPECT_EQ(status(state, "c"), StatusSet{Finished});
  EXPECT_EQ(nodes(state) + edges(state), "");
  EXPECT_EQ(state.order_id, "1234") << "the orderId and orderUpdateId are kept";
  EXPECT_EQ(state.last, (LastNode{"f", 0}));
}

TEST_F(Vda5050Model, DrivesToTheNextNodeIfItCannotStopBetweenNodes) {  // Figure 9, left
  become(Version::V2_1_0, false);
  start(figure_5());
  enter(1);
  const Alternative& told = instant("cancelOrder", "c");
  EXPECT_EQ(nodes(told), "d") << "the nodeState for the node the AGV is driving to is kept";
  EXPECT_EQ(told.drivable_edges, Edges{1});
  EXPECT_EQ(status(told, "c"), StatusSet{Running});
  EXPECT_EQ(required_errors(send(path("1234", 1, "d g", 2))), Names{"orderUpdateError"});
  const Alternative& state = reach("d", 2);
  EXPECT_EQ(state.last, (LastNode{"d", 2}));
  EXPECT_EQ(nodes(state) + edges(state), "");
  EXPECT_EQ(status(state, "c"), StatusSet{Finished});
}

TEST_F(Vda5050Model, FailsScheduledActionsOnACancel) {
  Order order = figure_5();
  order.nodes[1].actions = {action("base")};
  order.nodes[3].actions = {action("horizon")};
  start(order);
  const Alternative& state = instant("cancelOrder", "c");
  EXPECT_EQ(status(state, "base"), StatusSet{Failed});
  EXPECT_EQ(status(state, "horizon"), StatusSet{Failed});
}

TEST_F(Vda5050Model, CancelsARunningActionIfItCan) {
  Order order = path("1234", 0, "f d");
  order.nodes[0].actions = {action("wait", Blocking::Hard, "wait")};
  start(order);
  begin("wait");
  const Alternative& told = instant("cancelOrder", "c");
  EXPECT_EQ(status(told, "wait"), (StatusSet{Running, Failed}));
  EXPECT_EQ(status(told, "c"), (StatusSet{Running, Finished}));
  const Alternative& state = fail("wait");
  EXPECT_EQ(status(state, "wait"), StatusSet{Failed});
  EXPECT_EQ(status(state, "c"), StatusSet{Finished});
}

TEST_F(Vda5050Model, WaitsForAnActionThatCannotBeInterrupted) {
  Order order = path("1234", 0, "f d");
  order.nodes[0].actions = {action("pick", Blocking::Hard, "pick")};
  start(order);
  begin("pick");
  const Alternative& told = instant("cancelOrder", "c");
  EXPECT_EQ(status(told, "pick"), StatusSet{Running});
  EXPECT_EQ(status(told, "c"), StatusSet{Running}) << "until all actions are cancelled/finished";
  EXPECT_EQ(required_errors(send(path("5678", 0, "f d"))).count("orderUpdateError"), 1U);
  const Alternative& state = finish("pick");
  EXPECT_EQ(status(state, "pick"), StatusSet{Finished});
  EXPECT_EQ(status(state, "c"), StatusSet{Finished});
}

TEST_F(Vda5050Model, KeepsActionStatesAfterACancel) {  // Figure 9: "actionStates are kept"
  Order order = figure_5();
  order.nodes[0].actions = {action("a")};
  start(order);
  begin("a");
  finish("a");
  instant("cancelOrder", "c");
  EXPECT_EQ(status(stop(), "a"), StatusSet{Finished});
}

TEST_F(Vda5050Model, HasNothingToCancelWithoutAnOrder) {  // 6.6.3.2
  const Alternative& state = instant("cancelOrder", "c");
  EXPECT_EQ(status(state, "c"), StatusSet{Failed});
  EXPECT_EQ(required_errors(state), Names{"noOrderToCancel"});
  EXPECT_EQ(state.errors.front().references.at("actionId"), "c");
}

TEST_F(Vda5050Model, HasNothingToCancelTwice) {  // 6.6.3.2: "or the previous order was canceled"
  start(figure_5());
  instant("cancelOrder", "c");
  stop();
  const Alternative& state = instant("cancelOrder", "again");
  EXPECT_EQ(status(state, "again"), StatusSet{Failed});
  EXPECT_EQ(status(state, "c"), StatusSet{Finished});
}

TEST_F(Vda5050Model, LeavesOpenHowASecondCancelEndsDuringTheFirst) {
  start(figure_5());
  enter(1);
  instant("cancelOrder", "c");
  EXPECT_EQ(status(instant("cancelOrder", "again"), "again"), (StatusSet{Running, Finished, Failed}));
  EXPECT_EQ(status(stop(), "again"), (StatusSet{Finished, Failed}));
}

TEST_F(Vda5050Model, AcceptsATemporaryNodeWhereItStandsAfterACancel) {  // 6.6.3.1, first option
  start(figure_5());
  enter(1);
  instant("cancelOrder", "c");
  stop({}, {4.0, 3.0});
  Order order = path("5678", 0, "temporary d");
  EXPECT_EQ(send(order).order_id, "1234") << "it does not stand on a node of this name";
  order.nodes[0].position = NodePosition{{4.0, 3.0}, 0.0};
  EXPECT_EQ(send(order).order_id, "5678");
}

TEST_F(Vda5050Model, AcceptsTheLastNodeWithALargeDeviationAfterACancel) {  // 6.6.3.1, second option
  start(figure_5());
  enter(1);
  instant("cancelOrder", "c");
  stop({}, {4.0, 3.0});
  Order order = path("5678", 0, "f d");
  order.nodes[0].position = NodePosition{{0.0, 0.0}, 4.9};
  EXPECT_EQ(send(order).order_id, "1234");
  order.nodes[0].position = NodePosition{{0.0, 0.0}, 5.1};
  EXPECT_EQ(send(order).order_id, "5678");
}

// ---- 6.2: blind driving

TEST_F(Vda5050Model, DrivesToTheEndOfTheBaseWithoutConnection) {  // 6.2
  start(figure_5());
  const Alternative& state = take(fact(Kind::ConnectionLost));
  EXPECT_EQ(state.drivable_edges, (Edges{1, 3}));
  EXPECT_FALSE(reach("d", 2).must_publish);
  EXPECT_EQ(reach("g", 4).drivable_edges, Edges{});
  take(fact(Kind::ConnectionRestored));
  EXPECT_TRUE(said.must_announce_online);  // 6.14
  EXPECT_EQ(nodes(all.front()), "b? h?") << "it keeps all the order information";
}

TEST_F(Vda5050Model, LosesWhatIsSentWhileItIsOffline) {  // 6.2: QoS 0
  start(figure_5());
  take(fact(Kind::ConnectionLost));
  EXPECT_EQ(send(figure_6()).order_update_id, 0U);
}

// ---- 6.10.2, 6.11 and 6.12: actions

// Figure 15: node n2 between edges e1 and e3.
Order figure_15(Blocking node_blocking) {
  Order order = path("o", 0, "f n2 n4");
  order.edges[0].actions = {action("e1action")};
  order.nodes[1].actions = {action("n2action", node_blocking)};
  order.edges[1].actions = {action("e3action")};
  return order;
}

TEST_F(Vda5050Model, PassesANodeWithActionsThatDoNotBlock) {  // Figure 15, middle
  start(figure_15(Blocking::None));
  EXPECT_EQ(status(all.front(), "n2action"), StatusSet{Waiting});
  EXPECT_EQ(status(begin("e1action"), "e1action"), StatusSet{Running});
  const Alternative& state = reach("n2", 2);
  EXPECT_EQ(status(state, "e1action"), StatusSet{Finished});
  EXPECT_EQ(status(state, "n2action"), (StatusSet{Initializing, Running}));
  EXPECT_EQ(status(state, "e3action"), (StatusSet{Initializing, Running}));
  EXPECT_EQ(edges(state), "n2-n4");
  EXPECT_EQ(state.drivable_edges, Edges{3});
  EXPECT_EQ(status(finish("n2action"), "n2action"), StatusSet{Finished});
}

TEST_F(Vda5050Model, StandsOnANodeWithABlockingAction) {  // Figure 15, right
  for (const Blocking blocking : {Blocking::Soft, Blocking::Hard}) {
    become(Version::V2_1_0, true);
    start(figure_15(blocking));
    begin("e1action");
    reach("n2", 2);
    const Alternative& standing = begin("n2action");
    EXPECT_EQ(status(standing, "n2action"), StatusSet{Running});
    EXPECT_EQ(status(standing, "e3action"), StatusSet{Waiting});
    EXPECT_EQ(standing.drivable_edges, Edges{});
    const Alternative& free = finish("n2action");
    EXPECT_EQ(free.drivable_edges, Edges{3});
    EXPECT_EQ(status(enter(3), "e3action"), (StatusSet{Initializing, Running})) << "after it begins moving again";
  }
}

TEST_F(Vda5050Model, ExecutesAHardActionAlone) {  // Figure 17
  Order order = path("o", 0, "f d");
  order.nodes[0].actions = {action("none"), action("hard", Blocking::Hard), action("soft", Blocking::Soft)};
  const Alternative& state = start(order);
  EXPECT_EQ(status(state, "none"), (StatusSet{Initializing, Running}));
  EXPECT_EQ(status(state, "hard"), (StatusSet{Waiting, Initializing})) << "the parallel list comes first";
  EXPECT_EQ(state.drivable_edges, Edges{}) << "the AGV stops driving before the list is executed";
  begin("none");
  EXPECT_FALSE(status(finish("none"), "hard").contains(Paused));
  EXPECT_TRUE(status(all.front(), "hard").contains(Running));
  EXPECT_EQ(status(begin("hard"), "soft"), (StatusSet{Waiting, Initializing}));
  EXPECT_TRUE(status(finish("hard"), "soft").contains(Running));
  begin("soft");
  EXPECT_EQ(finish("soft").drivable_edges, Edges{1});
}

TEST_F(Vda5050Model, ExecutesSoftActionsInParallel) {  // Table 3
  Order order = path("o", 0, "f d");
  order.nodes[0].actions = {action("one", Blocking::Soft), action("two", Blocking::Soft), action("three")};
  start(order);
  begin("one");
  begin("two");
  const Alternative& state = begin("three");
  for (const char* id : {"one", "two", "three"}) EXPECT_EQ(status(state, id), StatusSet{Running});
  finish("one");
  EXPECT_EQ(all.front().drivable_edges, Edges{});
  EXPECT_EQ(finish("two").drivable_edges, Edges{1}) << "a NONE action may run on while the AGV drives";
}

TEST_F(Vda5050Model, HoldsAHardActionBackWhileAnotherNodesActionRuns) {  // Table 3: "shall not [...] in parallel"
  Order order = path("o", 0, "f d g");
  order.nodes[0].actions = {action("music")};
  order.nodes[1].actions = {action("pick", Blocking::Hard, "pick")};
  start(order);
  begin("music");
  EXPECT_EQ(status(reach("d", 2), "pick"), (StatusSet{Waiting, Initializing}));
  EXPECT_TRUE(status(finish("music"), "pick").contains(Running));
}

TEST_F(Vda5050Model, ReportsAFailedAction) {  // Table 2, Figure 16
  Order order = path("o", 0, "f d");
  order.nodes[0].actions = {action("pick", Blocking::Hard, "pick")};
  start(order);
  begin("pick");
  const Alternative& state = fail("pick");
  EXPECT_EQ(status(state, "pick"), StatusSet{Failed});
  EXPECT_TRUE(state.must_publish);
}

TEST_F(Vda5050Model, KeepsActionStatesUntilANewOrder) {  // 6.10.6, actionStates
  Order order = path("o", 0, "f d");
  order.nodes[0].actions = {action("a")};
  start(order);
  begin("a");
  finish("a");
  instant("beep", "running");
  begin("running");
  instant("stateRequest", "over");
  reach("d", 2);
  EXPECT_EQ(status(all.front(), "a"), StatusSet{Finished});
  const Alternative& state = send(path("p", 0, "d g"));
  EXPECT_EQ(status(state, "a"), StatusSet{});
  EXPECT_EQ(status(state, "over"), StatusSet{});
  EXPECT_EQ(status(state, "running"), StatusSet{Running}) << "except for running instant actions";
}

TEST_F(Vda5050Model, AddsAnInstantActionToTheActionStates) {  // 6.9
  const Alternative& state = instant("beep", "i");
  EXPECT_EQ(status(state, "i"), (StatusSet{Initializing, Running}));
  EXPECT_TRUE(state.must_publish);
}

TEST_F(Vda5050Model, AnswersRequests) {  // 6.8.2
  const Alternative& state = instant("stateRequest", "s");
  EXPECT_EQ(status(state, "s"), StatusSet{Finished});
  EXPECT_TRUE(state.must_publish);
  EXPECT_FALSE(said.must_send_factsheet);
  EXPECT_EQ(status(instant("factsheetRequest", "f"), "f"), StatusSet{Finished});
  EXPECT_TRUE(said.must_send_factsheet);
}

// ---- 6.8: pause

TEST_F(Vda5050Model, DoesNotDriveWhilePaused) {  // 6.8.1: "No more AGV driving movements"; "Order is resumable"
  start(figure_5());
  const Alternative& told = instant("startPause", "p");
  EXPECT_EQ(status(told, "p"), (StatusSet{Running, Finished}));
  EXPECT_EQ(told.drivable_edges, Edges{});
  const Alternative& paused = pause(true);
  EXPECT_EQ(status(paused, "p"), StatusSet{Finished});
  EXPECT_EQ(paused.paused, std::set<bool>{true});
  EXPECT_EQ(nodes(paused), "d g b? h?");
  EXPECT_EQ(instant("stopPause", "q").drivable_edges, Edges{});
  const Alternative& free = pause(false);
  EXPECT_EQ(free.drivable_edges, (Edges{1, 3}));
  EXPECT_EQ(status(free, "q"), StatusSet{Finished});
}

TEST_F(Vda5050Model,
       LeavesOpenWhetherActionsPause) {  // 6.8.1 "Actions can continue", 6.8.2 "All actions will be paused"
  Order order = path("o", 0, "f d");
  order.nodes[0].actions = {action("wait", Blocking::Hard, "wait")};
  start(order);
  begin("wait");
  instant("startPause", "p");
  EXPECT_EQ(status(pause(true), "wait"), (StatusSet{Initializing, Running, Paused}));
  instant("stopPause", "q");
  EXPECT_EQ(status(pause(false), "wait"), StatusSet{Running}) << "all paused actions will be resumed";
}

TEST_F(Vda5050Model, AcceptsOrdersWhilePaused) {  // nothing in Figure 8 asks for a pause
  instant("startPause", "p");
  pause(true);
  Order order = figure_5();
  order.nodes[0].actions = {action("a")};
  const Alternative& state = start(order);
  EXPECT_EQ(state.order_id, "1234");
  EXPECT_EQ(state.drivable_edges, Edges{});
  EXPECT_TRUE(status(state, "a").contains(Waiting));
}

TEST_F(Vda5050Model, RequestsABaseOnlyWithNodesAhead) {  // 6.10.3
  EXPECT_FALSE(instant("stateRequest", "s").new_base_request_allowed);
  EXPECT_TRUE(start(figure_5()).new_base_request_allowed);
  instant("cancelOrder", "c");
  EXPECT_FALSE(stop().new_base_request_allowed);
}

}  // namespace
}  // namespace fleetproof::test::vda5050_model::vda5050_model_test
