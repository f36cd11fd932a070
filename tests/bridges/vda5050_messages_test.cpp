// What a vehicle of VDA 5050 publishes and when (sections 6.2 to 6.5, 6.10, 6.14, 6.15).
#include "tests/bridges/vda5050_bench.hpp"

namespace fleetproof::vda5050_messages_test {
namespace {

using namespace test::vda5050;
using testing::HasSubstr;

using Vda5050Messages = Vda5050Bench;

TEST_F(Vda5050Messages, ItComesOnlineRetainedWithQos1AndSaysItsState) {
  const std::vector<Publication> messages = published();
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].topic, Topic::Connection);
  EXPECT_EQ(messages[0].qos, 1);
  EXPECT_TRUE(messages[0].retained);
  EXPECT_THAT(messages[0].payload, HasSubstr(R"("connectionState":"ONLINE")"));
  EXPECT_EQ(messages[1].topic, Topic::State);
  EXPECT_EQ(messages[1].qos, 0);
  EXPECT_FALSE(messages[1].retained);
}

TEST_F(Vda5050Messages, LastWillAndFarewellAreRetainedWithQos1) {
  restart(settings(), false);
  const Publication will = vehicle().last_will(0);
  EXPECT_EQ(will.topic, Topic::Connection);
  EXPECT_EQ(will.qos, 1);
  EXPECT_TRUE(will.retained);
  EXPECT_THAT(will.payload, HasSubstr("CONNECTIONBROKEN"));
  hear(ConnectionOpened{});
  EXPECT_THAT(published()[0].payload, HasSubstr(R"("headerId":1,)"));
  const Publication farewell = vehicle().farewell(1);
  EXPECT_THAT(farewell.payload, HasSubstr("OFFLINE"));
  EXPECT_TRUE(farewell.retained);
  EXPECT_EQ(farewell.qos, 1);
}

TEST_F(Vda5050Messages, HeaderIdsCountUpForEachTopic) {
  published();
  send(action("factsheetRequest", "r1"));
  send(action("stateRequest", "r2"));
  const std::vector<Publication> messages = published();
  ASSERT_EQ(messages.size(), 3u);
  EXPECT_THAT(messages[0].payload, HasSubstr(R"("headerId":0,)"));  // factsheet
  EXPECT_THAT(messages[1].payload, HasSubstr(R"("headerId":1,)"));
  EXPECT_THAT(messages[2].payload, HasSubstr(R"("headerId":2,)"));
  EXPECT_THAT(messages[2].payload, HasSubstr(R"("timestamp":"2026-01-01T00:00:00.00Z","version":"2.1.0")"));
}

TEST_F(Vda5050Messages, AStateIsSentEvery30SecondsAtTheLatest) {
  published();
  pass_seconds(29);
  EXPECT_EQ(topics(), "");
  EXPECT_EQ(vehicle().next_deadline_ns(), 30'000'000'000);
  pass_seconds(1);
  EXPECT_EQ(topics(), "state");
  pass_seconds(29);
  hear(Driving{true});
  EXPECT_EQ(topics(), "state");
  pass_seconds(29);
  EXPECT_EQ(topics(), "");
  pass_seconds(1);
  EXPECT_EQ(topics(), "state");
}

TEST_F(Vda5050Messages, EveryEventOfTheListTriggersOneState) {
  send(order("o1", 0, {{"a"}, {"ab"}, {"b", {action("scan", "1")}}, {"bc"}, {"c"}}, 2));
  EXPECT_EQ(topics(), "connection state state");
  const auto states_of = [&](const Fact& fact) {
    hear(fact);
    return topics();
  };
  EXPECT_EQ(states_of(Driving{true}), "state");
  EXPECT_EQ(states_of(Driving{true}), "");
  EXPECT_EQ(states_of(NodeReached{2}), "state");
  EXPECT_EQ(states_of(NodeReached{2}), "");
  EXPECT_EQ(states_of(ActionBegun{"1"}), "state");
  EXPECT_EQ(states_of(ActionFinished{"1", ""}), "state");
  EXPECT_EQ(states_of(LoadsAre{{{"17", {}, {}, {}}}}), "state");
  EXPECT_EQ(states_of(ErrorRaised{{"outOfOrder", {}, "broken", {}, ErrorLevel::Fatal}}), "state");
  EXPECT_EQ(states_of(ErrorRaised{{"outOfOrder", {}, "broken", {}, ErrorLevel::Fatal}}), "");
  EXPECT_EQ(states_of(ErrorCleared{"outOfOrder"}), "state");
  EXPECT_EQ(states_of(ModeSet{OperatingMode::Semiautomatic}), "state");
  EXPECT_EQ(states_of(ModeSet{OperatingMode::Semiautomatic}), "");
  EXPECT_EQ(states_of(BatteryIs{{50.0, true}}), "state");
  EXPECT_EQ(states_of(BatteryIs{{49.0, true}}), "");
  EXPECT_EQ(states_of(SafetyIs{{EmergencyStop::Autoack, true}}), "state");
  EXPECT_EQ(states_of(Located{{true, 1.0, 2.0, 0.5, "m"}}), "");
  send(order("o1", 1, way("bc"), 2, 2));
  EXPECT_EQ(topics(), "state");
}

TEST_F(Vda5050Messages, TheStateSaysWhatTheBodySays) {
  hear(LoadsAre{{{"17", {}, {}, {}}}});
  hear(BatteryIs{{42.5, true}});
  hear(Located{{true, 1.0, -2.0, 0.5, "m"}});
  hear(ErrorRaised{{"outOfOrder", {}, "broken", {}, ErrorLevel::Fatal}});
  const State now = state();
  EXPECT_EQ(now.loads->at(0).load_id, "17");
  EXPECT_EQ(now.battery_state.battery_charge, 42.5);
  EXPECT_EQ(now.agv_position->y, -2.0);
  EXPECT_EQ(errors(), "outOfOrder");
  hear(LoadsAre{{}});
  EXPECT_EQ(state().loads->size(), 0u);  // an empty array, for it knows that it is unloaded
}

TEST_F(Vda5050Messages, AnErrorOfTheBodyOutlivesANewOrder) {
  hear(ErrorRaised{{"outOfOrder", {}, {}, {}, ErrorLevel::Fatal}});
  send(order("o1", 0, way("ab"), 2));
  EXPECT_EQ(errors(), "outOfOrder");
}

TEST_F(Vda5050Messages, WithoutAConnectionNothingIsPublished) {
  hear(ConnectionLost{});
  published();
  hear(Driving{true});
  pass_seconds(100);
  EXPECT_EQ(topics(), "");
  EXPECT_GT(vehicle().next_deadline_ns(), 1'000'000'000'000);
  hear(ConnectionOpened{});
  EXPECT_EQ(topics(), "connection state");
}

TEST_F(Vda5050Messages, Version2_0HasNoFieldsOf2_1) {
  VehicleSettings old = settings();
  old.identity.version = find_version("2.0");
  old.abilities.maps = {{"m", "1", {}, MapStatus::Enabled}};
  restart(old);
  published();
  send(action("factsheetRequest", "r1"));
  send(order("o1", 0, way("ab"), 2));
  EXPECT_EQ(state().order_id, "o1");
  for (const Publication& message : published()) {
    EXPECT_THAT(message.payload, HasSubstr(R"("version":"2.0.0")"));
    EXPECT_THAT(message.payload, testing::Not(HasSubstr("\"maps\"")));
  }
}

TEST_F(Vda5050Messages, TheFactsheetIsPublishedAsItWasGiven) {
  Factsheet sheet;
  sheet.type_specification.series_name = "lifter";
  sheet.protocol_features.optional_parameters = {{"order.nodes.nodePosition", Support::Supported}};
  VehicleProtocol vehicle(settings(), sheet);
  vehicle.hear(ConnectionOpened{});
  vehicle.publish(0);
  const InstantActions request{{0, "2026-01-01T00:00:00.00Z", "2.1.0", "fp", "agv1"},
                               {action("factsheetRequest", "r1")}};
  vehicle.instant_actions_received(write_document(request, *find_version("2.1")));
  const std::vector<Publication> messages = vehicle.publish(0);
  EXPECT_THAT(test::broken_rules(messages.at(0).payload, "factsheet", "2.1.0"), testing::IsEmpty());
  EXPECT_THAT(messages[0].payload, HasSubstr("\"lifter\""));
  EXPECT_THAT(messages[0].payload, HasSubstr("order.nodes.nodePosition"));
}

}  // namespace
}  // namespace fleetproof::vda5050_messages_test
