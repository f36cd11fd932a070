// Actions of VDA 5050: life cycle, blocking types, instant actions (sections 6.8, 6.9, 6.11, 6.12).
#include "tests/bridges/vda5050_bench.hpp"

namespace fleetproof::vda5050_actions_test {
namespace {

using namespace test::vda5050;
using testing::HasSubstr;

using Vda5050Actions = Vda5050Bench;

Action scan(const std::string& id, BlockingType blocking = BlockingType::None) { return action("scan", id, blocking); }
Action lift(const std::string& id) { return action("lift", id, BlockingType::Hard); }

// ---- life cycle

TEST_F(Vda5050Actions, AnActionWaitsIsTriggeredRunsAndFinishes) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b", {lift("1")}}}, 2));
  EXPECT_EQ(status("1"), "WAITING");
  drive_edge();
  EXPECT_EQ(status("1"), "INITIALIZING");
  EXPECT_EQ(wishes(), "Start 1");
  hear(ActionBegun{"1"});
  EXPECT_EQ(status("1"), "RUNNING");
  hear(ActionFinished{"1", "shelf 3"});
  EXPECT_EQ(status("1"), "FINISHED");
  EXPECT_EQ(state().action_states[0].result_description, "shelf 3");
  hear(ActionFailed{"1", "late"});  // it has ended
  EXPECT_EQ(status("1"), "FINISHED");
}

TEST_F(Vda5050Actions, AnActionThatFailsDoesNotEndTheOrder) {
  send(order("o1", 0, {{"a", {lift("1")}}, {"ab"}, {"b"}}, 2));
  hear(ActionBegun{"1"});
  EXPECT_EQ(driving(), "hold");
  hear(ActionFailed{"1", "no load here"});
  EXPECT_EQ(status("1"), "FAILED");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Actions, EveryActionOfBaseAndHorizonHasAState) {
  send(order("o1", 0, {{"a", {scan("1")}}, {"ab", {scan("2")}}, {"b", {scan("3")}}, {"bc", {scan("4")}}, {"c"}}, 1));
  EXPECT_EQ(state().action_states.size(), 4u);
  send(scan("5"));
  EXPECT_EQ(state().action_states.size(), 5u);
}

// ---- blocking types

TEST_F(Vda5050Actions, NoneLetsItDrive) {
  send(order("o1", 0, {{"a", {scan("1")}}, {"ab"}, {"b"}}, 2));
  EXPECT_EQ(wishes(), "Start 1");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Actions, SoftKeepsItFromDrivingAndLetsOthersRun) {
  send(order("o1", 0, {{"a", {scan("1", BlockingType::Soft), scan("2")}}, {"ab"}, {"b"}}, 2));
  EXPECT_EQ(wishes(), "Start 1, Start 2");
  EXPECT_EQ(driving(), "hold");
  finish("1");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Actions, HardRunsAloneAndInItsPlaceOfTheList) {
  send(order("o1", 0, {{"a", {scan("1"), scan("2", BlockingType::Soft), lift("3"), scan("4")}}, {"ab"}, {"b"}}, 2));
  EXPECT_EQ(wishes(), "Start 1, Start 2");
  finish("1");
  EXPECT_EQ(wishes(), "");
  finish("2");
  EXPECT_EQ(wishes(), "Start 3");
  EXPECT_EQ(status("4"), "WAITING");
  EXPECT_EQ(driving(), "hold");
  finish("3");
  EXPECT_EQ(wishes(), "Start 4");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Actions, HardWaitsForAnActionOfAnEarlierNode) {
  send(order("o1", 0, {{"a", {scan("1")}}, {"ab"}, {"b", {lift("2")}}, {"bc"}, {"c"}}, 3));
  hear(ActionBegun{"1"});
  drive_edge();
  EXPECT_EQ(wishes(), "Start 1");
  EXPECT_EQ(status("2"), "WAITING");
  EXPECT_EQ(driving(), "hold");
  hear(ActionFinished{"1", ""});
  EXPECT_EQ(wishes(), "Start 2");
}

TEST_F(Vda5050Actions, ItHasToStopAtANodeWithABlockingActionAhead) {
  send(order("o1", 0,
             {{"a"}, {"ab"}, {"b", {scan("1", BlockingType::Soft)}}, {"bc"}, {"c", {scan("2")}}, {"cd"}, {"d"}}, 4));
  EXPECT_EQ(driving(), "ab");
  begin_edge();
  hear(NodeReached{2});
  EXPECT_EQ(wishes(), "");  // it still rolls
  EXPECT_EQ(driving(), "hold");
  hear(Driving{false});
  EXPECT_EQ(wishes(), "Start 1");
  finish("1");
  EXPECT_EQ(driving(), "bc cd");
}

TEST_F(Vda5050Actions, AnInstantActionThatBlocksStopsTheVehicle) {
  send(order("o1", 0, way("abc"), 3));
  begin_edge();
  send(scan("i1", BlockingType::Soft));
  EXPECT_EQ(driving(), "hold");
  EXPECT_EQ(wishes(), "");
  hear(Driving{false});
  EXPECT_EQ(wishes(), "Start i1");
  finish("i1");
  EXPECT_EQ(driving(), "bc");
}

// ---- edges

TEST_F(Vda5050Actions, ActionsOfAnEdgeRunOnlyOnIt) {
  send(order("o1", 0, {{"a"}, {"ab", {scan("1")}}, {"b"}, {"bc", {scan("2")}}, {"c"}}, 3));
  EXPECT_EQ(status("1"), "WAITING");
  begin_edge();
  EXPECT_EQ(wishes(), "Start 1");
  hear(ActionBegun{"1"});
  hear(EdgeBegun{3});
  hear(NodeReached{2});
  EXPECT_EQ(status("1"), "FINISHED");
  EXPECT_EQ(wishes(), "End 1, Start 2");  // it moves all the time: it is on the next edge
  hear(Driving{false});
  hear(NodeReached{4});
  EXPECT_EQ(status("2"), "FINISHED");
}

TEST_F(Vda5050Actions, AnEdgeIsEnteredWhenItMovesOnBehindABlockingNode) {
  send(order("o1", 0, {{"a", {lift("1")}}, {"ab", {scan("2")}}, {"b"}}, 2));
  EXPECT_EQ(status("2"), "WAITING");
  finish("1");
  EXPECT_EQ(status("2"), "WAITING");
  begin_edge();
  EXPECT_EQ(status("2"), "INITIALIZING");
}

TEST_F(Vda5050Actions, ABlockingActionOfAnEdgeRunsAtItsBeginning) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b"}, {"bc", {scan("1", BlockingType::Soft)}}, {"c"}}, 3));
  EXPECT_EQ(driving(), "ab");
  drive_edge();
  EXPECT_EQ(wishes(), "Start 1");
  EXPECT_EQ(driving(), "hold");
  finish("1");
  EXPECT_EQ(driving(), "bc");
  drive_edge();
  EXPECT_EQ(state().last_node_id, "c");
}

TEST_F(Vda5050Actions, AnActionThatCouldNotStartOnItsEdgeFails) {
  send(order("o1", 0, {{"a", {scan("1")}}, {"ab", {scan("2")}}, {"b"}}, 2));
  send(action("startPause", "p1"));
  hear(EdgeBegun{1});
  hear(Driving{true});
  hear(Driving{false});
  hear(NodeReached{2});
  EXPECT_EQ(status("2"), "FAILED");
}

// ---- pause

TEST_F(Vda5050Actions, PauseStopsVehicleAndActionsAndIsReportedWhenItStands) {
  send(order("o1", 0, {{"a", {scan("1")}}, {"ab"}, {"b"}, {"bc"}, {"c"}}, 3));
  hear(ActionBegun{"1"});
  begin_edge();
  wishes();
  send(action("startPause", "p1"));
  EXPECT_EQ(status("p1"), "RUNNING");
  EXPECT_FALSE(*state().paused);
  EXPECT_EQ(driving(), "hold");
  EXPECT_EQ(wishes(), "Pause 1");
  EXPECT_EQ(status("1"), "PAUSED");
  hear(Driving{false});
  EXPECT_EQ(status("p1"), "FINISHED");
  EXPECT_TRUE(*state().paused);
  send(action("stopPause", "p2"));
  EXPECT_EQ(status("p2"), "FINISHED");
  EXPECT_EQ(wishes(), "Resume 1");
  EXPECT_EQ(status("1"), "RUNNING");
  EXPECT_FALSE(*state().paused);
  EXPECT_EQ(driving(), "bc");
  EXPECT_EQ(nodes(), "bc");  // the order is as it was
}

TEST_F(Vda5050Actions, NothingStartsDuringAPause) {
  send(action("startPause", "p1"));
  EXPECT_EQ(status("p1"), "FINISHED");
  send(order("o1", 0, {{"a", {scan("1")}}, {"ab"}, {"b"}}, 2));
  EXPECT_EQ(state().order_id, "o1");
  EXPECT_EQ(wishes(), "");
  EXPECT_EQ(driving(), "hold");
  send(action("startPause", "p2"));
  EXPECT_EQ(status("p2"), "FINISHED");
  send(action("stopPause", "p3"));
  EXPECT_EQ(wishes(), "Start 1");
  EXPECT_EQ(driving(), "ab");
}

TEST_F(Vda5050Actions, AnActionThatCannotBePausedGoesOn) {
  send(order("o1", 0, {{"a", {lift("1")}}}, 1));
  hear(ActionBegun{"1"});
  send(action("startPause", "p1"));
  EXPECT_EQ(status("1"), "RUNNING");
  EXPECT_EQ(status("p1"), "FINISHED");
  hear(ActionFinished{"1", ""});
  EXPECT_EQ(status("1"), "FINISHED");
}

TEST_F(Vda5050Actions, StopPauseOvertakesAPauseThatIsStillStopping) {
  send(order("o1", 0, way("ab"), 2));
  begin_edge();
  send(action("startPause", "p1"));
  send(action("stopPause", "p2"));
  EXPECT_EQ(status("p1"), "FAILED");
  EXPECT_EQ(status("p2"), "FINISHED");
  hear(Driving{false});
  EXPECT_FALSE(*state().paused);
}

TEST_F(Vda5050Actions, AnOrderCanBeCancelledDuringAPause) {
  send(order("o1", 0, {{"a", {scan("1")}}, {"ab"}, {"b"}}, 2));
  hear(ActionBegun{"1"});
  send(action("startPause", "p1"));
  send(action("cancelOrder", "x1"));
  EXPECT_EQ(status("1"), "FAILED");
  EXPECT_EQ(status("x1"), "FINISHED");
  EXPECT_TRUE(*state().paused);
}

// ---- other instant actions

TEST_F(Vda5050Actions, StateRequestIsAnsweredAtOnce) {
  published();
  send(action("stateRequest", "r1"));
  EXPECT_EQ(status("r1"), "FINISHED");
  EXPECT_EQ(topics(), "state");
}

TEST_F(Vda5050Actions, FactsheetRequestPublishesTheFactsheetRetained) {
  published();
  send(action("factsheetRequest", "r1"));
  const std::vector<Publication> messages = published();
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].topic, Topic::Factsheet);
  EXPECT_TRUE(messages[0].retained);
  EXPECT_EQ(status("r1"), "FINISHED");
}

TEST_F(Vda5050Actions, AnInstantActionThatItCannotCarryOutFailsWithAnError) {
  for (const char* type : {"logReport", "downloadMap", "enableMap", "deleteMap", "detectObject", "lift"}) {
    send(action(type, type));
    EXPECT_EQ(status(type), "FAILED");
    EXPECT_THAT(state().errors.back().error_references, testing::Contains(Reference{"actionId", type}));
  }
}

TEST_F(Vda5050Actions, InitPositionIsDoneOnlyIfItChangesNothing) {
  hear(Located{{true, 1.0, 2.0, 0.0, "m"}});
  const auto init = [&](const std::string& id, const std::string& x, const std::string& node) {
    send(action("initPosition", id, BlockingType::Hard,
                std::vector<ActionParameter>{{"x", x, false},
                                             {"y", "2", false},
                                             {"theta", "0.0", false},
                                             {"mapId", "m", true},
                                             {"lastNodeId", node, true}}));
    return status(id);
  };
  EXPECT_EQ(init("1", "1.0", "a"), "FINISHED");
  EXPECT_EQ(init("2", "1.0", "b"), "FAILED");
  EXPECT_EQ(init("3", "9", "a"), "FAILED");
  EXPECT_EQ(init("4", "\"1\"", "a"), "FAILED");
  send(action("initPosition", "5"));
  EXPECT_EQ(status("5"), "FAILED");
  EXPECT_EQ(state().last_node_id, "a");
  send(order("o1", 0, way("ab"), 2));
  EXPECT_EQ(init("6", "1.0", "a"), "FAILED");
}

TEST_F(Vda5050Actions, AnInstantActionOfTheBodyIsStarted) {
  send(scan("i1"));
  EXPECT_EQ(wishes(), "Start i1");
  send(scan("i1"));  // sent again
  EXPECT_EQ(wishes(), "");
  finish("i1");
  EXPECT_EQ(status("i1"), "FINISHED");
}

TEST_F(Vda5050Actions, TextThatIsNoInstantActionIsAValidationError) {
  for (const char* text : {"", "{}", "[[", R"({"actions":[]})"}) {
    vehicle().instant_actions_received(text);
    pass_seconds(0);
  }
  EXPECT_THAT(errors(), HasSubstr("validationError"));
  EXPECT_THAT(state().errors[0].error_references, testing::Contains(Reference{"topic", "instantActions"}));
}

}  // namespace
}  // namespace fleetproof::vda5050_actions_test
