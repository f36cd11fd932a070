// Orders of VDA 5050: which are accepted, how they are driven, updated and cancelled (sections 6.6, 6.10).
#include <functional>

#include "tests/bridges/vda5050_bench.hpp"

namespace fleetproof::vda5050_orders_test {
namespace {

using namespace test::vda5050;
using testing::ElementsAre;
using testing::HasSubstr;

using Vda5050Orders = Vda5050Bench;

const Action kLift = action("lift", "lift1", BlockingType::Hard);

// ---- a new order

TEST_F(Vda5050Orders, AnOrderIsDrivenNodeByNode) {
  send(order("o1", 0, way("abc"), 3));
  EXPECT_EQ(nodes(), "bc");
  EXPECT_EQ(edges(), "ab bc");
  EXPECT_EQ(state().order_id, "o1");
  EXPECT_EQ(state().last_node_id, "a");
  EXPECT_EQ(driving(), "ab bc");
  drive_edge();
  EXPECT_EQ(nodes(), "c");
  EXPECT_EQ(edges(), "bc");
  EXPECT_EQ(state().last_node_id, "b");
  EXPECT_EQ(state().last_node_sequence_id, 2u);
  drive_edge();
  EXPECT_EQ(nodes(), "");
  EXPECT_EQ(driving(), "");
  EXPECT_EQ(errors(), "");
}

TEST_F(Vda5050Orders, NothingOfTheHorizonIsDriven) {
  send(order("o1", 0, way("abcd"), 2));
  EXPECT_EQ(nodes(), "b(c)(d)");
  EXPECT_EQ(edges(), "ab (bc) (cd)");
  EXPECT_EQ(driving(), "ab");
  drive_edge();
  EXPECT_EQ(driving(), "");
  EXPECT_EQ(nodes(), "(c)(d)");
}

TEST_F(Vda5050Orders, AnOrderOfOneNodeIsDoneAtOnce) {
  send(order("o1", 0, way("a"), 1));
  EXPECT_EQ(nodes(), "");
  send(order("o2", 0, way("ab"), 2));
  EXPECT_EQ(state().order_id, "o2");
}

TEST_F(Vda5050Orders, TheFirstNodeMustBeTriviallyReachable) {
  send(order("o1", 0, way("bc"), 2));
  EXPECT_EQ(errors(), "noRouteError");
  EXPECT_EQ(state().order_id, "");
}

TEST_F(Vda5050Orders, ANodeWithinItsDeviationRangeIsReached) {
  hear(Located{{true, 10.0, 5.0, 0.0, "m"}});
  Order near = order("o1", 0, way("bc"), 2);
  near.nodes[0].node_position = NodePosition{12.0, 5.0, {}, 1.99, {}, "m", {}};
  send(near);
  EXPECT_EQ(errors(), "noRouteError");
  near.nodes[0].node_position->allowed_deviation_xy = 2.0;
  near.nodes[0].node_position->map_id = "other floor";
  send(near);
  EXPECT_EQ(state().order_id, "");
  near.nodes[0].node_position->map_id = "m";
  send(near);
  EXPECT_EQ(state().order_id, "o1");
  EXPECT_EQ(state().last_node_id, "b");
  EXPECT_EQ(driving(), "bc");
}

TEST_F(Vda5050Orders, ATemporaryNodeWhereTheVehicleStandsIsReached) {
  hear(Located{{true, 10.0, 5.0, 0.0, "m"}});
  Order here = order("o1", 0, way("xb"), 2);
  here.nodes[0].node_position = NodePosition{10.05, 5.0, {}, {}, {}, "m", {}};
  send(here);
  EXPECT_EQ(state().order_id, "o1");
}

TEST_F(Vda5050Orders, ANewOrderIsRefusedWhileOneIsExecuted) {
  send(order("o1", 0, way("ab"), 2));
  send(order("o2", 0, way("ab"), 2));
  EXPECT_EQ(state().order_id, "o1");
  EXPECT_EQ(errors(), "orderError");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Orders, ANewOrderIsRefusedWhileAnActionOrAHorizonIsLeft) {
  send(order("o1", 0, {{"a", {kLift}}}, 1));
  send(order("o2", 0, way("a"), 1));
  EXPECT_EQ(state().order_id, "o1");
  finish("lift1");
  send(order("o2", 0, way("ab"), 1));
  EXPECT_EQ(state().order_id, "o2");
  send(order("o3", 0, way("a"), 1));
  EXPECT_EQ(state().order_id, "o2");
}

TEST_F(Vda5050Orders, ANewOrderReplacesTheStatesOfTheFormerOne) {
  send(order("o1", 0, {{"a", {kLift}}}, 1));
  finish("lift1");
  EXPECT_EQ(status("lift1"), "FINISHED");
  send(action("stateRequest", "i1"));
  send(action("scan", "i2"));
  send(order("o2", 0, {{"a", {action("scan", "scan1")}}}, 1));
  EXPECT_EQ(status("lift1"), "unknown");
  EXPECT_EQ(status("i1"), "unknown");
  EXPECT_EQ(status("i2"), "INITIALIZING");  // an instant action that still runs
}

TEST_F(Vda5050Orders, MalformedOrdersAreValidationErrors) {
  const std::vector<std::function<void(Order&)>> spoilers = {
      [](Order& o) { o.order_id = ""; },
      [](Order& o) { o.nodes.clear(); },
      [](Order& o) { o.edges.pop_back(); },
      [](Order& o) { o.edges.push_back(o.edges.back()); },
      [](Order& o) { o.edges[0].start_node_id = "c"; },
      [](Order& o) { o.edges[1].end_node_id = "a"; },
      [](Order& o) { o.nodes[1].sequence_id = 3; },
      [](Order& o) { o.nodes[1].sequence_id = 0; },
      [](Order& o) { o.nodes[0].released = false; },
      [](Order& o) { o.nodes[1].released = false; },
      [](Order& o) { o.edges[1].released = true; },
      [](Order& o) { o.nodes[2].released = true, o.nodes[1].released = o.edges[0].released = false; },
      [](Order& o) { o.nodes[1].actions = o.nodes[2].actions = {action("scan", "same")}; },
  };
  for (std::size_t i = 0; i < spoilers.size(); ++i) {
    restart(settings());
    Order wrong = order("o1", 0, way("abc"), 2);
    spoilers[i](wrong);
    send(wrong);
    EXPECT_EQ(errors(), "validationError") << i;
    EXPECT_EQ(state().order_id, "") << i;
  }
}

TEST_F(Vda5050Orders, TextThatIsNoOrderIsAValidationErrorUntilAnOrderIsAccepted) {
  for (const char* text : {"", "{", "[]", "null", "{\"orderId\":7}", "\xff"}) send_order_text(text);
  EXPECT_THAT(errors(), HasSubstr("validationError"));
  pass_seconds(100);
  EXPECT_THAT(errors(), HasSubstr("validationError"));
  EXPECT_EQ(state().errors[0].error_level, ErrorLevel::Warning);
  send(order("o1", 0, way("ab"), 2));
  EXPECT_EQ(errors(), "");
}

TEST_F(Vda5050Orders, ActionsThatItCannotCarryOutAreOrderErrorsAndNotFailedActions) {
  send(order("o1", 0, {{"a", {action("dance", "dance1")}}}, 1));
  EXPECT_EQ(errors(), "orderError");
  EXPECT_EQ(status("dance1"), "unknown");
  EXPECT_THAT(state().errors[0].error_references, testing::Contains(Reference{"actionId", "dance1"}));
  send(order("o1", 0, {{"a"}, {"ab", {kLift}}, {"b"}}, 2));  // lift: on nodes only
  EXPECT_EQ(errors(), "orderError orderError");
  EXPECT_EQ(state().order_id, "");
}

TEST_F(Vda5050Orders, FieldsThatItCannotUseAreOrderErrorsWithTheFieldAsReference) {
  Order fast = order("o1", 0, way("ab"), 2);
  fast.edges[0].max_speed = 0.5;
  send(fast);
  EXPECT_EQ(errors(), "orderError");
  EXPECT_THAT(state().errors[0].error_references, testing::Contains(Reference{"order.edges.maxSpeed", "ab"}));
  Order curved = order("o1", 0, way("ab"), 2);
  curved.edges[0].trajectory = Trajectory{1.0, {0, 0, 1, 1}, {{0, 0, {}}, {1, 1, {}}}};
  send(curved);
  Order zoned = order("o1", 0, way("ab"), 2);
  zoned.zone_set_id = "z";
  send(zoned);
  EXPECT_EQ(errors(), "orderError orderError orderError");
  EXPECT_EQ(state().order_id, "");
}

TEST_F(Vda5050Orders, ANodeOnAMapThatIsNotEnabledOnTheVehicleIsRefused) {
  VehicleSettings with_map = settings();
  with_map.abilities.maps = {{"m", "1", {}, MapStatus::Enabled}, {"roof", "1", {}, MapStatus::Disabled}};
  restart(with_map);
  Order elsewhere = order("o1", 0, way("ab"), 2);
  elsewhere.nodes[1].node_position = NodePosition{0, 0, {}, {}, {}, "cellar", {}};
  send(elsewhere);
  elsewhere.nodes[1].node_position->map_id = "roof";
  send(elsewhere);
  EXPECT_EQ(errors(), "orderError orderError");
  elsewhere.nodes[1].node_position->map_id = "m";
  send(elsewhere);
  EXPECT_EQ(state().order_id, "o1");
  EXPECT_EQ(state().maps->size(), 2u);
}

TEST_F(Vda5050Orders, AnOrderThatIsTooLargeIsRefused) {
  VehicleSettings small = settings();
  small.abilities.most_nodes = 2;
  small.abilities.longest_id = 4;
  restart(small);
  send(order("o1", 0, way("abc"), 3));
  EXPECT_EQ(errors(), "orderError");
  send(order("order1", 0, way("ab"), 2));
  EXPECT_EQ(state().order_id, "");
}

TEST_F(Vda5050Orders, ErrorsAboutOrdersSayWhichMessageWasWrong) {
  send(order("o1", 7, way("b"), 1));
  EXPECT_THAT(state().errors.at(0).error_references,
              testing::IsSupersetOf({Reference{"topic", "order"}, Reference{"headerId", "0"},
                                     Reference{"orderId", "o1"}, Reference{"orderUpdateId", "7"}}));
}

TEST_F(Vda5050Orders, ManyRefusedMessagesDoNotMakeTheStateGrow) {
  VehicleSettings small = settings();
  small.most_action_states = 50;
  restart(small);
  for (std::uint32_t i = 0; i < 100; ++i) send(order("o1", i, way("b"), 1));
  EXPECT_EQ(state().errors.size(), 32u);
  send(action("scan", "scan1"));
  for (int i = 0; i < 100; ++i) send(action("stateRequest", "i" + std::to_string(i)));
  EXPECT_EQ(state().action_states.size(), 50u);
  EXPECT_EQ(status("scan1"), "INITIALIZING");
  EXPECT_EQ(status("i99"), "FINISHED");
}

// ---- updates

TEST_F(Vda5050Orders, AnUpdateIsStitchedToTheLastNodeOfTheBase) {
  send(order("o1", 0, way("abcd"), 2));
  begin_edge();
  send(order("o1", 1, way("bcd"), 2, 2));
  EXPECT_EQ(state().order_update_id, 1u);
  EXPECT_EQ(nodes(), "bc(d)");
  EXPECT_EQ(edges(), "ab bc (cd)");
  EXPECT_EQ(driving(), "bc");
}

TEST_F(Vda5050Orders, AnUpdateReplacesTheHorizonWithItsActions) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b"}, {"bc"}, {"c", {action("scan", "scan1")}}}, 2));
  EXPECT_EQ(status("scan1"), "WAITING");
  send(order("o1", 1, {{"b"}, {"bd"}, {"d", {action("scan", "scan2")}}}, 1, 2));
  EXPECT_EQ(nodes(), "b(d)");
  EXPECT_EQ(edges(), "ab (bd)");
  EXPECT_EQ(status("scan1"), "unknown");
  EXPECT_EQ(status("scan2"), "WAITING");
}

TEST_F(Vda5050Orders, AnUpdateMayReleaseTheHorizonWithTheSameActions) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b", {action("scan", "scan1")}}}, 1));
  send(order("o1", 1, {{"a"}, {"ab"}, {"b", {action("scan", "scan1")}}}, 2));
  EXPECT_EQ(errors(), "");
  EXPECT_EQ(nodes(), "b");
  EXPECT_EQ(status("scan1"), "WAITING");
}

TEST_F(Vda5050Orders, AnUpdateMayDeleteTheHorizon) {
  send(order("o1", 0, way("abc"), 2));
  send(order("o1", 1, way("b"), 1, 2));
  EXPECT_EQ(nodes(), "b");
  EXPECT_EQ(state().order_update_id, 1u);
}

TEST_F(Vda5050Orders, TheStitchingNodeKeepsItsFirstInstructions) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b", {action("scan", "scan1")}}}, 2));
  send(order("o1", 1, {{"b", {action("scan", "scan2")}}, {"bc"}, {"c"}}, 2, 2));
  EXPECT_EQ(status("scan1"), "WAITING");
  EXPECT_EQ(status("scan2"), "unknown");
  drive_edge();
  EXPECT_EQ(wishes(), "Start scan1");
}

TEST_F(Vda5050Orders, AnUpdateThatDoesNotBeginAtTheDecisionPointIsRefused) {
  send(order("o1", 0, way("abc"), 2));
  send(order("o1", 1, way("cd"), 2, 4));   // the end of the horizon
  send(order("o1", 2, way("abc"), 3, 0));  // the base again
  send(order("o1", 3, way("bc"), 2, 4));   // another pass over the same node
  EXPECT_EQ(errors(), "orderUpdateError orderUpdateError orderUpdateError");
  EXPECT_EQ(state().order_update_id, 0u);
  EXPECT_EQ(nodes(), "b(c)");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Orders, AnUpdateContinuesACompletedOrderWhereItEnded) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b", {action("scan", "scan1")}}}, 2));
  drive_edge();
  finish("scan1");
  send(order("o1", 1, way("abc"), 3, 0));
  EXPECT_EQ(errors(), "orderUpdateError");
  send(order("o1", 2, way("bc"), 2, 2));
  EXPECT_EQ(errors(), "");
  EXPECT_EQ(nodes(), "c");
  EXPECT_EQ(status("scan1"), "FINISHED");  // its states are kept
  wishes();
  EXPECT_EQ(driving(), "bc");
}

TEST_F(Vda5050Orders, ALowerUpdateIsRefusedAndTheOrderGoesOn) {
  send(order("o1", 5, way("abc"), 2));
  send(order("o1", 4, way("bc"), 2, 2));
  EXPECT_EQ(errors(), "orderUpdateError");
  EXPECT_EQ(state().errors[0].error_level, ErrorLevel::Warning);
  EXPECT_EQ(state().order_update_id, 5u);
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Orders, TheSameUpdateAgainIsIgnoredAndAnswered) {
  send(order("o1", 0, way("abc"), 2));
  drive_edge();
  published();
  send(order("o1", 0, way("abc"), 2));
  EXPECT_EQ(errors(), "");
  EXPECT_EQ(nodes(), "(c)");
  EXPECT_EQ(topics(), "state");
}

TEST_F(Vda5050Orders, ALoopDistinguishesNodesByTheirSequence) {
  send(order("o1", 0, way("aba"), 3));
  EXPECT_EQ(nodes(), "ba");
  hear(NodeReached{4});  // not the next one
  EXPECT_EQ(nodes(), "ba");
  drive_edge();
  drive_edge();
  EXPECT_EQ(state().last_node_sequence_id, 4u);
  send(order("o1", 1, way("ab"), 2, 0));  // the first pass
  EXPECT_EQ(errors(), "orderUpdateError");
}

TEST_F(Vda5050Orders, AnActionIdThatIsInUseIsRefused) {
  send(order("o1", 0, {{"a", {action("scan", "scan1")}}}, 1));
  send(order("o1", 1, {{"a"}, {"ab"}, {"b", {action("scan", "scan1")}}}, 2));
  EXPECT_EQ(errors(), "validationError");
  EXPECT_EQ(state().order_update_id, 0u);
}

TEST_F(Vda5050Orders, ItAsksForABaseBeforeItHasToBrake) {
  send(order("o1", 0, way("abcd"), 3));
  EXPECT_FALSE(*state().new_base_request);
  drive_edge();
  EXPECT_TRUE(*state().new_base_request);
  send(order("o1", 1, way("cd"), 2, 4));
  EXPECT_FALSE(*state().new_base_request);  // the order ends there
}

// ---- blind driving

TEST_F(Vda5050Orders, WithoutAConnectionItDrivesToTheEndOfTheBaseAndStops) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b", {kLift}}, {"bc"}, {"c"}, {"cd"}, {"d"}}, 3));
  published();
  hear(ConnectionLost{});
  drive_edge();
  EXPECT_EQ(wishes(), "Start lift1");
  finish("lift1");
  drive_edge();
  EXPECT_EQ(driving(), "");
  EXPECT_EQ(published().size(), 0u);
  hear(ConnectionOpened{});
  EXPECT_EQ(topics(), "connection state");
  EXPECT_EQ(state().last_node_id, "c");
  EXPECT_EQ(status("lift1"), "FINISHED");
  send(order("o1", 1, way("cd"), 2, 4));
  EXPECT_EQ(driving(), "cd");
}

// ---- cancelOrder

TEST_F(Vda5050Orders, ACancelledOrderIsGoneAndItsIdsStay) {
  send(order("o1", 3, {{"a", {action("scan", "scan1"), kLift}}, {"ab"}, {"b"}, {"bc"}, {"c"}}, 2));
  EXPECT_EQ(wishes(), "Start scan1");
  hear(ActionBegun{"scan1"});
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(status("x1"), "FINISHED");
  EXPECT_EQ(status("scan1"), "FAILED");  // it ran and could be interrupted
  EXPECT_EQ(status("lift1"), "FAILED");  // it was scheduled
  EXPECT_EQ(wishes(), "Cancel scan1");
  EXPECT_EQ(nodes() + edges(), "");
  EXPECT_EQ(driving(), "");
  EXPECT_EQ(state().order_id, "o1");
  EXPECT_EQ(state().order_update_id, 3u);
}

TEST_F(Vda5050Orders, CancelWaitsForAnActionThatCannotBeInterrupted) {
  send(order("o1", 0, {{"a", {kLift}}, {"ab"}, {"b"}}, 2));
  hear(ActionBegun{"lift1"});
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(status("x1"), "RUNNING");
  EXPECT_EQ(status("lift1"), "RUNNING");
  EXPECT_EQ(nodes(), "");
  hear(ActionFinished{"lift1", "done"});
  EXPECT_EQ(status("lift1"), "FINISHED");
  EXPECT_EQ(status("x1"), "FINISHED");
}

TEST_F(Vda5050Orders, CancelBetweenNodesEndsAtTheNextNode) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b", {kLift}}, {"bc"}, {"c"}}, 3));
  begin_edge();
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(status("x1"), "RUNNING");
  EXPECT_EQ(nodes(), "b");
  EXPECT_EQ(edges(), "");
  EXPECT_EQ(status("lift1"), "FAILED");
  hear(NodeReached{2});
  EXPECT_EQ(status("x1"), "RUNNING");  // it still moves
  hear(Driving{false});
  EXPECT_EQ(status("x1"), "FINISHED");
  EXPECT_EQ(state().last_node_id, "b");
  EXPECT_EQ(nodes(), "");
  EXPECT_EQ(wishes(), "");
}

TEST_F(Vda5050Orders, CancelKeepsTheNodesToWhichItDrivesInAnyCase) {
  send(order("o1", 0, way("abcd"), 4));
  begin_edge();
  hear(EdgeBegun{3});
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(nodes(), "bc");
  EXPECT_EQ(driving(), "");
  hear(NodeReached{2});
  hear(Driving{false});
  EXPECT_EQ(status("x1"), "RUNNING");
  hear(Driving{true});
  hear(Driving{false});
  hear(NodeReached{4});
  EXPECT_EQ(status("x1"), "FINISHED");
  EXPECT_EQ(state().last_node_id, "c");
}

// A body need not say EdgeBegun: motion away from the node says as much.
TEST_F(Vda5050Orders, AnEdgeOnWhichItDrivesHasBegun) {
  send(order("o1", 0, way("abc"), 3));
  hear(Driving{true});
  EXPECT_EQ(driving(), "bc");
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(status("x1"), "RUNNING");
  EXPECT_EQ(nodes(), "b");
}

TEST_F(Vda5050Orders, AVehicleThatStopsBetweenNodesStopsAtOnceWhenCancelled) {
  VehicleSettings agile = settings();
  agile.stops_between_nodes = true;
  restart(agile);
  send(order("o1", 0, way("abc"), 3));
  begin_edge();
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(driving(), "hold");
  EXPECT_EQ(status("x1"), "RUNNING");
  hear(Driving{false});
  EXPECT_EQ(status("x1"), "FINISHED");
  EXPECT_EQ(nodes() + edges(), "");
  EXPECT_EQ(state().last_node_id, "a");
  // Both ways to go on: the last node with a large deviation, or a temporary node where it stands.
  send(order("o2", 0, way("ab"), 2));
  EXPECT_EQ(state().order_id, "o1");
  hear(Located{{true, 3.0, 0.0, 0.0, "m"}});
  Order next = order("o2", 0, way("ab"), 2);
  next.nodes[0].node_position = NodePosition{0.0, 0.0, {}, 5.0, {}, "m", {}};
  send(next);
  EXPECT_EQ(state().order_id, "o2");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Orders, ANewOrderIsAcceptedAfterTheCancelAndNotDuringIt) {
  send(order("o1", 0, way("abc"), 2));
  begin_edge();
  send(action("cancelOrder", "x1"));
  send(order("o2", 0, way("bc"), 2));
  send(order("o1", 1, way("bc"), 2, 2));
  EXPECT_EQ(errors(), "orderError orderUpdateError");
  EXPECT_EQ(state().order_id, "o1");
  hear(Driving{false});
  hear(NodeReached{2});
  send(order("o2", 0, way("bc"), 2));
  EXPECT_EQ(state().order_id, "o2");
  EXPECT_EQ(errors(), "");
  EXPECT_EQ(driving(), "bc");
}

TEST_F(Vda5050Orders, CancelWithoutAnOrderFailsWithAWarning) {
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(status("x1"), "FAILED");
  EXPECT_EQ(errors(), "noOrderToCancel");
  EXPECT_EQ(state().errors[0].error_level, ErrorLevel::Warning);
  EXPECT_THAT(state().errors[0].error_references, testing::Contains(Reference{"actionId", "x1"}));
}

TEST_F(Vda5050Orders, CancelOfACancelledOrDoneOrderFails) {
  send(order("o1", 0, way("ab"), 2));
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(status("x1"), "FINISHED");
  send(action("cancelOrder", "x2"));
  EXPECT_EQ(status("x2"), "FAILED");
  send(order("o2", 0, way("a"), 1));
  send(action("cancelOrder", "x3"));
  EXPECT_EQ(status("x3"), "FAILED");
}

TEST_F(Vda5050Orders, TwoCancelsOfOneOrderEndTogether) {
  send(order("o1", 0, way("ab"), 2));
  begin_edge();
  send(action("cancelOrder", "x1"));
  send(action("cancelOrder", "x2"));
  send(action("cancelOrder", "x1"));  // sent again: nothing new
  EXPECT_EQ(status("x2"), "RUNNING");
  hear(Driving{false});
  hear(NodeReached{2});
  EXPECT_EQ(status("x1") + status("x2"), "FINISHEDFINISHED");
  EXPECT_EQ(errors(), "");
}

// ---- operating mode

TEST_F(Vda5050Orders, ManualModeClearsTheOrderAndRefusesOrders) {
  send(order("o1", 0, {{"a", {kLift}}, {"ab"}, {"b"}}, 2));
  hear(ModeSet{OperatingMode::Manual});
  EXPECT_EQ(nodes() + edges(), "");
  EXPECT_EQ(driving(), "hold");  // the action that had begun still runs
  finish("lift1");
  send(order("o2", 0, way("ab"), 2));
  EXPECT_EQ(errors(), "orderError");
  hear(ModeSet{OperatingMode::Automatic});
  send(order("o2", 0, way("ab"), 2));
  EXPECT_EQ(state().order_id, "o2");
  hear(ModeSet{OperatingMode::Semiautomatic});
  EXPECT_EQ(driving(), "ab");
  hear(ModeSet{OperatingMode::Service});
  EXPECT_EQ(driving(), "");
  EXPECT_EQ(nodes(), "b");
}

}  // namespace
}  // namespace fleetproof::vda5050_orders_test
