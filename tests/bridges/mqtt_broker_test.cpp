#include "core/bridges/mqtt/broker.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>
#include <set>
#include <string>

#include "core/bridges/mqtt/client.hpp"
#include "core/bridges/mqtt/topics.hpp"
#include "tests/bridges/mqtt_bench.hpp"

namespace fleetproof::mqtt_broker_test {
namespace {

using namespace mqtt;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(MqttBroker, GivesEachMessageToThoseWhoWantIt) {
  BrokerBench bench;
  bench.connect(1, named("master"), {{"v/+/state", 1}});
  bench.connect(2, named("agv"), {{"v/agv/order", 0}});
  EXPECT_THAT(bench.heard(1), ElementsAre("CONNACK: accepted", "SUBACK: packet 1"));
  bench.say(2, message("v/agv/state", "s1"));
  bench.say(2, message("v/agv/state", "s2", 1));
  bench.say(1, message("v/agv/order", "o1", 1));
  EXPECT_THAT(bench.heard(1), ElementsAre("PUBLISH: v/agv/state, QoS 0, 2 bytes s1",
                                          "PUBLISH: v/agv/state, QoS 1, 2 bytes s2", "PUBACK: packet 1"));
  EXPECT_THAT(bench.heard(2), ElementsAre("CONNACK: accepted", "SUBACK: packet 1", "PUBACK: packet 1",
                                          "PUBLISH: v/agv/order, QoS 0, 2 bytes o1"))
      << "no more than what was granted";
  bench.say(1, Unsubscribe{5, {"v/+/state"}});
  bench.say(2, message("v/agv/state", "s3"));
  EXPECT_THAT(bench.heard(1), ElementsAre("UNSUBACK: packet 5"));
  bench.say(1, Pingreq{});
  EXPECT_THAT(bench.heard(1), ElementsAre("PINGRESP"));
}

TEST(MqttBroker, KeepsTheLastRetainedMessageOfATopic) {
  BrokerBench bench;
  bench.connect(1, named("agv"));
  bench.say(1, message("c/agv", "OFFLINE", 1, true));
  bench.say(1, message("c/agv", "ONLINE", 1, true));
  bench.say(1, message("c/other", "x", 0, true));
  bench.connect(2, named("master"), {{"c/#", 1}});
  EXPECT_THAT(bench.heard(2),
              ElementsAre("CONNACK: accepted", "SUBACK: packet 1", "PUBLISH: c/agv, QoS 1, retained, 6 bytes ONLINE",
                          "PUBLISH: c/other, QoS 0, retained, 1 bytes x"));
  bench.say(1, message("c/agv", "", 0, true));
  EXPECT_THAT(bench.heard(2), ElementsAre("PUBLISH: c/agv, QoS 0, 0 bytes ")) << "to who is there, as any message";
  bench.say(2, Subscribe{2, {{"c/agv", 1}}});
  EXPECT_THAT(bench.heard(2), ElementsAre("SUBACK: packet 2"));
}

TEST(MqttBroker, PublishesTheWillOfWhoIsGoneWithoutAWord) {
  BrokerBench bench;
  bench.connect(1, named("master"), {{"c/#", 1}});
  Connect agv = named("agv");
  agv.will = Will{"c/agv", "CONNECTIONBROKEN", 1, true};
  agv.keep_alive_s = 10;
  bench.heard(1);
  bench.connect(2, agv);
  bench.broker.lost(2);
  EXPECT_THAT(bench.heard(1), ElementsAre("PUBLISH: c/agv, QoS 1, 16 bytes CONNECTIONBROKEN"));
  bench.connect(3, agv);
  bench.say(3, Disconnect{});
  EXPECT_THAT(bench.heard(1), ElementsAre()) << "it said that it goes";
  bench.connect(4, agv);
  EXPECT_EQ(bench.broker.deadline_ns(), 15 * kSecond_ns);
  bench.now_ns = 14 * kSecond_ns;
  bench.say(4, Pingreq{});
  bench.broker.tick(15 * kSecond_ns);
  EXPECT_THAT(bench.heard(1), ElementsAre());
  bench.broker.tick(29 * kSecond_ns);
  EXPECT_THAT(bench.closed[4], HasSubstr("silent"));
  EXPECT_THAT(bench.heard(1), ElementsAre("PUBLISH: c/agv, QoS 1, 16 bytes CONNECTIONBROKEN"));
  bench.connect(5, agv);
  bench.say(5, Connack{});
  EXPECT_EQ(bench.heard(1).size(), 1U) << "and of who breaks the protocol";
}

TEST(MqttBroker, TheNewestOfTwoClientsWithOneNameStays) {
  BrokerBench bench;
  Connect agv = named("agv");
  agv.will = Will{"c/agv", "gone", 0, false};
  bench.connect(1, named("master"), {{"c/#", 0}});
  bench.heard(1);
  bench.connect(2, agv, {{"order", 0}});
  bench.connect(3, agv, {{"order", 0}});
  EXPECT_THAT(bench.closed[2], HasSubstr("its name"));
  EXPECT_THAT(bench.heard(1), ElementsAre("PUBLISH: c/agv, QoS 0, 4 bytes gone"));
  bench.heard(3);
  bench.say(1, message("order", "o"));
  EXPECT_THAT(bench.heard(3), ElementsAre("PUBLISH: order, QoS 0, 1 bytes o"));
  bench.broker.take_over("agv");
  EXPECT_THAT(bench.closed[3], HasSubstr("its name"));
  EXPECT_THAT(bench.broker.connected(), ElementsAre("master"));
}

TEST(MqttBroker, AKeptSessionHasAllThatItMissed) {
  BrokerBench bench;
  bench.connect(1, keeping("agv"), {{"order", 1}});
  bench.connect(2, named("master"));
  bench.say(2, message("order", "o1", 1));
  bench.heard(1);
  bench.broker.lost(1);
  bench.say(2, message("order", "o2", 1));
  bench.say(2, message("order", "o3"));
  bench.connect(3, keeping("agv"));
  EXPECT_THAT(bench.heard(3),
              ElementsAre("CONNACK: accepted, session present", "PUBLISH: order, QoS 1, again, 2 bytes o1",
                          "PUBLISH: order, QoS 1, 2 bytes o2"))
      << "at QoS 0, it is gone";
  bench.say(3, Puback{1});
  bench.say(3, Puback{2});
  bench.broker.lost(3);
  bench.connect(4, keeping("agv"));
  EXPECT_THAT(bench.heard(4), ElementsAre("CONNACK: accepted, session present"));
  bench.broker.lost(4);
  bench.connect(5, named("agv"));
  EXPECT_THAT(bench.heard(5), ElementsAre("CONNACK: accepted")) << "a clean one begins anew";
}

TEST(MqttBroker, RefusesByName) {
  BrokerBench bench;
  const auto refused = [&](std::uint32_t connection, const Packet& packet) {
    bench.say(connection, packet);
    return bench.closed[connection];
  };
  const auto of_connect = [&](std::uint32_t connection, Connect connect, const std::string& bytes = {}) {
    bench.broker.opened(connection, 0);
    bench.broker.received(connection, bytes.empty() ? encode(connect) : bytes, 0);
    return bench.closed[connection];
  };
  EXPECT_THAT(of_connect(1, {}, std::string("\x10\x0e\0\4MQTT\5\2\0\0\0\0\1a", 16)), HasSubstr("another version"));
  EXPECT_THAT(bench.heard(1), ElementsAre("CONNACK: refused, code 1"));  // [MQTT-3.1.2-2]
  EXPECT_THAT(of_connect(2, {}, std::string("\x10\x13\0\4MQTT\4\xc2\0\0\0\1a\0\1u\0\1p", 21)), HasSubstr("password"));
  EXPECT_THAT(bench.heard(2), ElementsAre("CONNACK: refused, code 5"));
  EXPECT_THAT(of_connect(3, keeping("")), HasSubstr("no name"));
  EXPECT_THAT(bench.heard(3), ElementsAre("CONNACK: refused, code 2"));  // [MQTT-3.1.3-9]
  bench.connect(4, named(""));
  EXPECT_THAT(bench.heard(4), ElementsAre("CONNACK: accepted")) << "the broker names it";
  EXPECT_THAT(refused(4, named("")), HasSubstr("second CONNECT"));
  bench.broker.opened(5, 0);
  EXPECT_THAT(refused(5, Pingreq{}), HasSubstr("first packet is no CONNECT"));
  bench.connect(6, named("a"));
  EXPECT_THAT(refused(6, Publish{.topic = "t", .qos = 2, .id = 1}), HasSubstr("QoS 2"));
  bench.connect(7, named("a"));
  EXPECT_THAT(refused(7, message("$SYS/x", "")), HasSubstr("topic of the server"));
  bench.connect(8, named("a"), {{"$SYS/#", 0}, {"t", 2}});
  bench.heard(8);
  bench.say(8, message("t", "x"));
  EXPECT_THAT(bench.heard(8), ElementsAre("PUBLISH: t, QoS 0, 1 bytes x"));
  bench.broker.received(8, "\xf0", 0);
  bench.broker.received(8, std::string("\0", 1), 0);
  EXPECT_THAT(bench.closed[8], HasSubstr("none of MQTT 3.1.1"));
  bench.broker.opened(9, 0);
  bench.broker.tick(30 * kSecond_ns);
  EXPECT_THAT(bench.closed[9], HasSubstr("no CONNECT"));
}

TEST(MqttBroker, FaultsDropMessagesAndCutConnections) {
  BrokerBench bench;
  bench.connect(1, named("a"), {{"#", 1}});
  bench.heard(1);
  bench.broker.drop_messages(2);
  for (const char* payload : {"1", "2", "3"}) bench.say(1, message("t", payload));
  EXPECT_THAT(bench.heard(1), ElementsAre("PUBLISH: t, QoS 0, 1 bytes 3"));
  bench.broker.drop_messages(1);
  bench.say(1, message("t", "4", 1));
  EXPECT_EQ(bench.heard(1).size(), 2U) << "at QoS 1, nothing is dropped";
  bench.broker.cut_all();
  EXPECT_EQ(bench.closed[1], "cut");
  EXPECT_THAT(bench.broker.connected(), ElementsAre());
}

TEST(MqttBroker, ItsDiskHasWhatOutlivesIt) {
  BrokerBench bench;
  bench.connect(1, keeping("agv"), {{"order", 1}, {"x/#", 0}});
  bench.connect(2, named("master"), {{"#", 1}});
  bench.say(2, message("c/agv", "ONLINE", 1, true));
  const auto before = bench.broker.changes();
  bench.say(2, message("other", "x"));
  EXPECT_EQ(bench.broker.changes(), before) << "nothing to write";
  bench.broker.lost(1);
  bench.say(2, message("order", "o1", 1));
  EXPECT_GT(bench.broker.changes(), before);
  const std::string disk = bench.broker.saved();
  BrokerBench next;
  ASSERT_TRUE(next.broker.restore(disk));
  EXPECT_EQ(next.broker.saved(), disk);
  next.connect(1, keeping("agv"));
  EXPECT_THAT(next.heard(1), ElementsAre("CONNACK: accepted, session present", "PUBLISH: order, QoS 1, 2 bytes o1"));
  next.connect(2, named("master"), {{"#", 1}});
  EXPECT_THAT(next.heard(2), testing::Contains("PUBLISH: c/agv, QoS 1, retained, 6 bytes ONLINE"));
  for (std::size_t size = 0; size < disk.size(); ++size)
    EXPECT_FALSE(BrokerBench().broker.restore(disk.substr(0, size)));
  std::string torn = disk;
  torn[torn.size() - 2] = '\x01';
  EXPECT_FALSE(BrokerBench().broker.restore(torn));
}

// ---- against a model that was written apart: who has to get which message, in drawn sequences

struct Model {
  struct Client {
    bool is_clean = true, is_there = false;
    std::map<std::string, int> filters{};
    std::vector<std::string> missed{};  // at QoS 1
  };
  std::map<std::string, Client> clients;
  std::map<std::string, std::pair<std::string, int>> retained;

  std::vector<std::string> got(const std::string& name) { return std::exchange(heard[name], {}); }
  void publish(const std::string& topic, const std::string& payload, int qos) {
    for (auto& [name, client] : clients) {
      int most = -1;
      for (const auto& [filter, granted] : client.filters) {
        const bool is_wanted = filter == topic || filter == "#" || (filter == "t/+" && topic.starts_with("t/"));
        if (is_wanted) most = std::max(most, granted);
      }
      if (most < 0) continue;
      if (client.is_there) heard[name].push_back(topic + "=" + payload);
      if (!client.is_there && std::min(most, qos) == 1) client.missed.push_back(topic + "=" + payload);
    }
  }
  std::map<std::string, std::vector<std::string>> heard;
};

TEST(MqttBroker, AgreesWithAModelOnDrawnSequences) {
  std::mt19937_64 draws(7);
  const auto draw = [&](std::size_t below) { return static_cast<std::size_t>(draws() % below); };
  const std::vector<std::string> names = {"a", "b", "c"}, topics = {"t/1", "t/2", "u"},
                                 filters = {"t/1", "t/+", "#", "u"};
  std::size_t messages = 0;
  for (int sequence = 0; sequence < 300; ++sequence) {
    BrokerBench bench;
    Model model;
    std::map<std::string, std::uint32_t> connection;
    std::uint32_t last = 0;
    for (int step = 0; step < 60; ++step) {
      const std::string name = names[draw(3)], topic = topics[draw(3)], payload = std::to_string(step);
      Model::Client& client = model.clients[name];
      const std::size_t what = draw(8);
      if (what == 0) {  // connects, perhaps while it is connected
        const bool is_clean = draw(2) == 0;
        if (is_clean || client.is_clean) client = {};
        client.is_clean = is_clean;
        client.is_there = true;
        auto& heard = model.heard[name];
        heard.insert(heard.end(), client.missed.begin(), client.missed.end());
        client.missed.clear();
        bench.connect(connection[name] = ++last, {.client = name, .is_clean = is_clean});
      } else if (client.is_there && what == 1) {
        bench.broker.lost(connection[name]);
        client.is_there = false;
        if (client.is_clean) client = {};
      } else if (client.is_there && what <= 3) {
        const std::string filter = filters[draw(4)];
        const int qos = static_cast<int>(draw(2));
        client.filters[filter] = qos;
        bench.say(connection[name], Subscribe{1, {{filter, static_cast<std::uint8_t>(qos)}}});
        for (const auto& [kept, value] : model.retained) {
          if (matches(filter, kept)) model.heard[name].push_back(kept + "=" + value.first);
        }
      } else if (client.is_there) {
        const int qos = static_cast<int>(draw(2));
        const bool retain = draw(4) == 0;
        if (retain) model.retained[topic] = {payload, qos};
        model.publish(topic, payload, qos);
        bench.say(connection[name], message(topic, payload, static_cast<std::uint8_t>(qos), retain));
      }
      for (const auto& [who, which] : connection) {
        std::vector<std::string> got;
        while (const auto packet = bench.out[which].next()) {
          const auto* publish = std::get_if<Publish>(&*packet);
          if (publish == nullptr) continue;
          got.push_back(publish->topic + "=" + publish->payload);
          if (publish->qos == 1) bench.say(which, Puback{publish->id});
        }
        messages += got.size();
        EXPECT_EQ(got, model.got(who)) << sequence << " " << step << " " << who;
      }
    }
  }
  EXPECT_GT(messages, 3000U);
}

// ---- the client

TEST(MqttClient, ConnectsSubscribesAndSaysAgainWhatIsNotAcknowledged) {
  ClientBench bench;
  Client& client = bench.client;
  client.publish(message("state", "lost"), {}, 0);
  client.publish(message("connection", "ONLINE", 1, true), {}, 0);
  client.opened(0);
  EXPECT_THAT(bench.said(), ElementsAre("CONNECT: agv"));
  EXPECT_FALSE(client.is_connected());
  client.received(encode(Connack{}), 1);
  EXPECT_TRUE(client.take_connected());
  EXPECT_FALSE(client.take_connected());
  EXPECT_THAT(bench.said(), ElementsAre("SUBSCRIBE: order", "PUBLISH: connection, QoS 1, retained, 6 bytes"));
  client.received(encode(Suback{2, {0}}), 2);
  client.publish(message("state", "s"), {}, 2);
  client.lost();
  client.opened(3);
  client.received(encode(Connack{}), 4);
  EXPECT_THAT(bench.said(), ElementsAre("PUBLISH: state, QoS 0, 1 bytes", "CONNECT: agv", "SUBSCRIBE: order",
                                        "PUBLISH: connection, QoS 1, retained, again, 6 bytes"));
  client.received(encode(Puback{1}), 5);
  client.lost();
  client.opened(6);
  client.received(encode(Connack{}), 7);
  EXPECT_THAT(bench.said(), ElementsAre("CONNECT: agv", "SUBSCRIBE: order"));
  client.received(encode(message("order", "o", 1)) + encode(message("order", "p")), 8);
  EXPECT_THAT(bench.said(), ElementsAre("PUBACK: packet 1"));
  const auto messages = client.take_messages();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].payload + messages[1].payload, "op");
}

TEST(MqttClient, NoticesThatItsBrokerIsSilent) {
  ClientBench bench;
  bench.client.opened(0);
  EXPECT_EQ(bench.client.deadline_ns(), 10 * kSecond_ns);
  bench.client.tick(10 * kSecond_ns);
  EXPECT_EQ(bench.closed, "no CONNACK");
  bench.client.opened(20 * kSecond_ns);
  bench.client.received(encode(Connack{}), 20 * kSecond_ns);
  EXPECT_EQ(bench.client.deadline_ns(), 30 * kSecond_ns);
  bench.said();
  bench.client.tick(30 * kSecond_ns);
  EXPECT_THAT(bench.said(), ElementsAre("PINGREQ"));
  bench.client.received(encode(Pingresp{}), 31 * kSecond_ns);
  bench.client.tick(40 * kSecond_ns);
  bench.client.tick(50 * kSecond_ns);
  EXPECT_EQ(bench.closed, "no answer to PINGREQ");
}

TEST(MqttClient, EndsAConnectionThatIsNoBrokers) {
  for (const auto& [packet, error] : std::vector<std::pair<Packet, std::string>>{
           {Pingresp{}, "the broker says something before CONNACK"},
           {Connack{false, ConnectCode::NotAuthorized}, "the broker refuses: code 5"}}) {
    ClientBench bench;
    bench.client.opened(0);
    bench.client.received(encode(packet), 1);
    EXPECT_EQ(bench.closed, error);
  }
  for (const auto& [packet, error] : std::vector<std::pair<Packet, std::string>>{
           {Connack{}, "the broker says CONNACK twice"},
           {Pingreq{}, "the broker sends what only a client sends"},
           {Publish{.topic = "t", .qos = 2, .id = 1}, "the broker sends a message at QoS 2"}}) {
    ClientBench bench;
    bench.client.opened(0);
    bench.client.received(encode(Connack{}) + encode(packet), 1);
    EXPECT_EQ(bench.closed, error);
    EXPECT_FALSE(bench.client.is_connected());
  }
}

}  // namespace
}  // namespace fleetproof::mqtt_broker_test
