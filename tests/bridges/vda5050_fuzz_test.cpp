// Damaged MQTT packets and VDA 5050 messages, the same each time: no reader crashes, hangs or grows, and what is read
// is written back to what is read again. FLEETPROOF_FUZZED=10000000 for releases.
#include <gmock/gmock.h>

#include <cstdlib>
#include <random>
#include <string>

#include "core/bridges/mqtt/broker.hpp"
#include "core/bridges/vda5050/vehicle_protocol.hpp"

namespace fleetproof::vda5050_fuzz_test {
namespace {

using namespace mqtt;

std::uint64_t wanted() {
  const char* text = std::getenv("FLEETPROOF_FUZZED");
  return text == nullptr ? 1'000'000 : std::strtoull(text, nullptr, 10);
}

std::vector<std::string> packets() {
  std::vector<std::string> bytes;
  for (const Packet& packet : std::initializer_list<Packet>{
           Connect{.client = "agv1", .keep_alive_s = 15, .will = Will{"c/agv1", "gone", 1, true}},
           Connect{.client = "b", .is_clean = false}, Connack{true, ConnectCode::Accepted},
           Publish{.topic = "v/agv1/state", .payload = "{\"headerId\": 1}"},
           Publish{.topic = "v/agv1/order", .payload = "x", .qos = 1, .retain = true, .id = 9}, Puback{9},
           Subscribe{2, {{"v/+/state", 1}, {"#", 0}}}, Suback{2, {1, kRefused}}, Unsubscribe{3, {"v/+/state"}},
           Unsuback{3}, Pingreq{}, Pingresp{}, Disconnect{}})
    bytes.push_back(encode(packet));
  return bytes;
}

// Bits flipped, bytes changed, added, taken out, and the ends of others put behind.
class Damage {
 public:
  explicit Damage(std::vector<std::string> samples) : samples_(std::move(samples)) {}
  std::string next() {
    std::string bytes = any();
    for (std::uint64_t times = draw(4); times > 0 && !bytes.empty(); --times) {
      const std::size_t at = draw(bytes.size());
      switch (draw(5)) {
        case 0:
          bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1U << draw(8)));
          break;
        case 1:
          bytes[at] = static_cast<char>(draw(256));
          break;
        case 2:
          bytes.insert(at, 1, static_cast<char>(draw(256)));
          break;
        case 3:
          bytes.erase(at, 1 + draw(4));
          break;
        default:
          bytes.resize(at);
          bytes += any();
      }
    }
    return bytes;
  }

 private:
  std::uint64_t draw(std::uint64_t below) { return draws_() % below; }
  const std::string& any() { return samples_[draw(samples_.size())]; }

  std::vector<std::string> samples_;
  std::mt19937_64 draws_{5050};
};

TEST(MqttFuzz, WhatIsReadIsWrittenBack) {
  Damage damage(packets());
  std::uint64_t read = 0, refused = 0;
  for (std::uint64_t i = 0; i < wanted(); ++i) {
    const std::string bytes = damage.next();
    PacketReader reader;
    reader.add(bytes);
    while (const auto packet = reader.next()) {
      ++read;
      const std::string written = encode(*packet);
      PacketReader again;
      again.add(written);
      const auto back = again.next();
      const auto* connect = std::get_if<Connect>(&*packet);
      const bool is_kept = connect == nullptr || (connect->level == 4 && !connect->has_user && !connect->has_password);
      if (is_kept && (!back || *back != *packet)) {
        FAIL() << "packet " << i << ": " << text_of(*packet) << ": " << again.error();
      }
    }
    refused += reader.error().empty() ? 0 : 1;
  }
  EXPECT_GT(read, wanted() / 4);
  EXPECT_GT(refused, wanted() / 5);
}

TEST(MqttFuzz, ABrokerLivesAndDoesNotGrow) {
  Damage damage(packets());
  std::uint64_t sent = 0, closed = 0;
  BrokerSettings settings;
  settings.most_sessions = settings.most_retained = settings.most_of_session = 50;
  Broker broker({[&](std::uint32_t, std::string_view bytes, std::string_view) { sent += bytes.size(); },
                 [&](std::uint32_t, std::string_view) { ++closed; }},
                settings);
  for (std::uint64_t i = 0; i < wanted() / 10; ++i) {
    const auto connection = static_cast<std::uint32_t>(i % 7);
    const auto now_ns = static_cast<std::int64_t>(i) * 10'000'000;
    if (i % 20 < 7) {
      broker.lost(connection);
      broker.opened(connection, now_ns);
      broker.received(connection, encode(Connect{.client = std::to_string(i % 90), .is_clean = i % 3 == 0}), now_ns);
    }
    broker.received(connection, damage.next(), now_ns);
    broker.tick(now_ns);
    if (i % 1000 == 0) {
      const std::string disk = broker.saved();
      EXPECT_LT(disk.size(), 5'000'000U);
      Broker next({[](auto...) {}, [](auto...) {}}, settings);
      EXPECT_TRUE(next.restore(disk)) << i;
      EXPECT_EQ(next.saved(), disk);
    }
  }
  EXPECT_GT(sent, 0U);
  EXPECT_GT(closed, wanted() / 100);
}

TEST(Vda5050Fuzz, AVehicleLivesAndTellsAStateThatCanBeRead) {
  using namespace bridges::vda5050;
  Order order{{1, "2026-01-01T00:00:00.00Z", "2.1.0", "fp", "agv1"}, "o1", 0, {}, {}, {}};
  order.nodes = {{"n1", 0, {}, true, {}, {}}, {"n2", 2, {}, true, {}, {{"beep", "a1", {}, BlockingType::Hard, {}}}}};
  Edge edge;
  edge.edge_id = "e1";
  edge.sequence_id = 1;
  edge.released = true;
  edge.start_node_id = "n1";
  edge.end_node_id = "n2";
  order.edges = {edge};
  const InstantActions cancel{order.header, {{"cancelOrder", "i1", {}, BlockingType::Hard, {}}}};
  const Version& version = versions().back();
  Damage damage({write_document(order, version), write_document(cancel, version)});
  VehicleSettings settings;
  settings.identity = {&version, "fp", "agv1", 0};
  settings.abilities.actions = {{"beep"}};
  VehicleProtocol vehicle(settings, {});
  vehicle.hear(ConnectionOpened{});
  vehicle.hear(StandsAt{"n1"});
  std::size_t longest = 0, drives = 0;
  for (std::uint64_t i = 0; i < wanted() / 20; ++i) {
    const std::string bytes = damage.next();
    vehicle.order_received(bytes);
    vehicle.instant_actions_received(bytes);
    drives += vehicle.driving_wish().edges.size();
    if (i % 50 == 0) vehicle.hear(StandsAt{"n1"});
    for (const Publication& one : vehicle.publish(static_cast<std::int64_t>(i))) {
      State state;
      std::string why;
      if (one.topic == Topic::State && i % 10 == 0) {
        EXPECT_TRUE(read_document(one.payload, version, state, why)) << why;
      }
      longest = std::max(longest, one.payload.size());
    }
  }
  EXPECT_GT(drives, 0U);
  EXPECT_LT(longest, 500'000U) << "what it remembers of refusals has an end";
}

}  // namespace
}  // namespace fleetproof::vda5050_fuzz_test
