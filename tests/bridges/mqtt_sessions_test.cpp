// What outlives a connection, and when one ends: corners of the standard that no ordinary exchange shows.
#include <gmock/gmock.h>

#include <string>

#include "core/bridges/mqtt/broker.hpp"
#include "tests/bridges/mqtt_bench.hpp"

namespace fleetproof::mqtt_sessions_test {
namespace {

using namespace mqtt;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kOneSecond_ns = 1'000'000'000;

// [MQTT-3.3.1-1], also over a restart of the broker: what is on its disk is what it has sent.
TEST(MqttSessions, AMessageThatWasSentIsSentAgainAsSuchByARestartedBroker) {
  BrokerBench bench;
  bench.connect(1, keeping("agv"), {{"order", 1}});
  bench.broker.lost(1);
  bench.connect(2, named("master"));
  bench.say(2, message("order", "o1", 1));
  const auto before = bench.broker.changes();
  const std::string disk_before = bench.broker.saved();
  bench.connect(3, keeping("agv"));
  EXPECT_THAT(bench.heard(3), Contains("PUBLISH: order, QoS 1, 2 bytes o1"));
  EXPECT_NE(bench.broker.saved(), disk_before);
  EXPECT_GT(bench.broker.changes(), before) << "so its owner writes the disk again";
  BrokerBench next;
  ASSERT_TRUE(next.broker.restore(bench.broker.saved()));
  next.connect(1, keeping("agv"));
  EXPECT_THAT(next.heard(1), Contains("PUBLISH: order, QoS 1, again, 2 bytes o1"));
}

// [MQTT-3.1.3-6]
TEST(MqttSessions, AClientWithoutANameGetsOneThatNobodyHas) {
  BrokerBench bench;
  bench.connect(1, named(""));
  const auto names = bench.broker.connected();
  ASSERT_EQ(names.size(), 1U);
  BrokerBench other;
  other.connect(1, named(names.front()));
  other.connect(2, named(""));
  EXPECT_FALSE(other.closed.contains(1)) << "nobody takes its connection over";
  EXPECT_EQ(other.broker.connected().size(), 2U);
}

// [MQTT-3.1.2-24]
TEST(MqttSessions, PartsOfAPacketDoNotKeepAConnectionAlive) {
  BrokerBench bench;
  bench.connect(1, {.client = "agv", .keep_alive_s = 10});
  const std::string packet = encode(message("t", "x"));
  bench.broker.received(1, packet.substr(0, 3), 14 * kOneSecond_ns);
  EXPECT_EQ(bench.broker.deadline_ns(), 15 * kOneSecond_ns);
  bench.broker.received(1, packet.substr(3), 14 * kOneSecond_ns);
  EXPECT_EQ(bench.broker.deadline_ns(), 29 * kOneSecond_ns);
  bench.broker.opened(2, 20 * kOneSecond_ns);
  bench.broker.tick(29 * kOneSecond_ns);
  EXPECT_THAT(bench.closed[1], HasSubstr("silent"));
  bench.broker.received(2, "\x10", 49 * kOneSecond_ns);
  bench.broker.tick(50 * kOneSecond_ns);
  EXPECT_THAT(bench.closed[2], HasSubstr("no CONNECT")) << "a byte now and then is no CONNECT";
}

TEST(MqttSessions, ADiskWithMoreOrLessThanItsHeadSaysIsRefused) {
  BrokerBench bench;
  bench.connect(1, keeping("agv"), {{"order", 1}});
  bench.say(1, message("c/agv", "ONLINE", 1, true));
  const std::string disk = bench.broker.saved();
  const std::string head = "fleetproof mqtt 1\n1 1 ";
  ASSERT_TRUE(disk.starts_with(head));
  const auto with_head = [&](const std::string& other) { return other + disk.substr(head.size()); };
  EXPECT_TRUE(BrokerBench().broker.restore(disk));
  EXPECT_FALSE(BrokerBench().broker.restore(with_head("fleetproof mqtt 1\n1 0 "))) << "a session more";
  EXPECT_FALSE(BrokerBench().broker.restore(with_head("fleetproof mqtt 1\n0 0 "))) << "messages, too";
  EXPECT_FALSE(BrokerBench().broker.restore(with_head("fleetproof mqtt 1\n1 2 "))) << "a session less";
  EXPECT_FALSE(BrokerBench().broker.restore(with_head("fleetproof mqtt 2\n1 1 "))) << "another version";
  std::string higher = disk;
  higher.replace(disk.find('\x33'), 1, "\x35");
  EXPECT_FALSE(BrokerBench().broker.restore(higher)) << "a message at QoS 2";
  BrokerBench kept;
  ASSERT_TRUE(kept.broker.restore(disk));
  EXPECT_FALSE(kept.broker.restore("fleetproof mqtt 1\n0 0 1\nx"));
  EXPECT_EQ(kept.broker.saved(), disk) << "what is refused changes nothing";
}

TEST(MqttSessions, WhatIsAboveALimitIsDroppedOrRefused) {
  BrokerBench bench({.most_of_session = 2, .most_sessions = 2, .most_retained = 1});
  bench.connect(1, keeping("agv"), {{"a", 1}, {"b", 1}, {"c", 1}});
  EXPECT_EQ(std::get<Suback>(*[&] {
              bench.out[1].next();
              return bench.out[1].next();
            }())
                .codes,
            (std::vector<std::uint8_t>{1, 1, kRefused}));
  bench.say(1, Subscribe{2, {{"a", 0}, {"a", 1}}});
  EXPECT_THAT(bench.heard(1), ElementsAre("SUBACK: packet 2")) << "one that it has is replaced";
  bench.broker.lost(1);
  bench.connect(2, named("master"));
  for (const char* payload : {"1", "2", "3"}) bench.say(2, message("a", payload, 1));
  bench.connect(3, named("other"));
  EXPECT_THAT(bench.heard(3), ElementsAre("CONNACK: refused, code 3"));
  bench.connect(4, keeping("agv"));
  EXPECT_THAT(bench.heard(4), ElementsAre("CONNACK: accepted, session present", "PUBLISH: a, QoS 1, 1 bytes 1",
                                          "PUBLISH: a, QoS 1, 1 bytes 2"))
      << "the newest are dropped";
  bench.say(2, message("x", "1", 0, true));
  bench.say(2, message("y", "1", 0, true));
  bench.say(2, message("x", "2", 0, true));
  bench.say(2, Subscribe{3, {{"x", 0}, {"y", 0}}});
  EXPECT_THAT(bench.heard(2), Contains("PUBLISH: x, QoS 0, retained, 1 bytes 2"));
  EXPECT_THAT(bench.heard(2), ElementsAre());
}

}  // namespace
}  // namespace fleetproof::mqtt_sessions_test
