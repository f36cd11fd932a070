// A million damaged packets, the same each time; FLEETPROOF_PACKETS says how many instead.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "tests/bridges/mqtt_bench.hpp"
#include "tests/fuzz/mqtt_verdict.hpp"

namespace fleetproof::mqtt_hostile_test {
namespace {

using namespace mqtt;

class DrawnStreams {
 public:
  explicit DrawnStreams(std::uint64_t seed) : draws_(seed) {}

  // Packets that follow each other, mostly behind a CONNECT, and mostly damaged.
  std::string stream() {
    std::string bytes;
    if (below(4) > 0) bytes = encode(Connect{.client = text(), .is_clean = below(2) == 0});
    for (std::size_t packets = 1 + below(8); packets > 0; --packets) bytes += encode(packet());
    for (std::size_t changes = below(3); changes > 0; --changes) damage(bytes);
    return bytes;
  }
  void damage(std::string& bytes) {
    if (bytes.empty()) return;
    const std::size_t at = below(bytes.size());
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:
        bytes.erase(at, 1 + below(4));
        break;
      case 3:
        bytes.insert(at, 1 + below(3), static_cast<char>(below(256)));
        break;
      case 4:
        bytes.resize(at);
        break;
      default:  // a part of it again
        bytes.insert(at, bytes.substr(below(bytes.size()), below(30)));
    }
  }
  std::size_t below(std::size_t end) { return static_cast<std::size_t>(draws_() % end); }

 private:
  std::string text() {
    constexpr const char* kTexts[] = {"a", "a/b", "order", "v/1/state", "", "$SYS/x", "\xc3\xa4/\xe2\x82\xac", "/"};
    return kTexts[below(std::size(kTexts))];
  }
  std::string filter() {
    constexpr const char* kFilters[] = {"#", "+", "a/+", "v/+/state", "order", "a/#", "$SYS/#", "+/b"};
    return kFilters[below(std::size(kFilters))];
  }
  std::string topic() {
    const std::string drawn = text();
    return drawn.empty() ? "t" : drawn;
  }
  std::string payload() { return std::string(below(12) == 0 ? below(600) : below(12), static_cast<char>(below(256))); }
  std::uint16_t id() { return static_cast<std::uint16_t>(1 + below(below(8) == 0 ? 65535 : 4)); }
  std::uint8_t qos() { return static_cast<std::uint8_t>(below(3)); }
  Publish publish() {
    Publish publish{.topic = topic(), .payload = payload(), .qos = qos(), .retain = below(3) == 0};
    publish.is_again = publish.qos > 0 && below(3) == 0;
    publish.id = publish.qos > 0 ? id() : std::uint16_t{0};
    return publish;
  }
  Connect connect() {
    Connect connect{.client = text(), .is_clean = below(2) == 0, .keep_alive_s = id()};
    if (below(2) == 0) connect.will = Will{topic(), payload(), qos(), below(2) == 0};
    return connect;
  }
  Packet packet() {
    switch (below(14)) {
      case 0:
        return connect();
      case 1:
        return Connack{below(2) == 0, ConnectCode::Accepted};
      case 2:
        return Connack{false, static_cast<ConnectCode>(below(6))};
      case 3:
        return Puback{id()};
      case 4:
        return Subscribe{id(), {{filter(), qos()}, {topic(), qos()}}};
      case 5:
        return Subscribe{id(), {{filter(), qos()}}};
      case 6:
        return Suback{id(), {0, 1, kRefused}};
      case 7:
        return Unsubscribe{id(), {filter(), topic()}};
      case 8:
        return Unsuback{id()};
      case 9:
        return below(4) == 0 ? Packet(Disconnect{}) : Packet(Pingreq{});
      case 10:
        return Pingresp{};
      default:
        return publish();
    }
  }

  std::mt19937_64 draws_;
};

std::string as_hex(const std::string& bytes) {
  std::string hex;
  for (const char c : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    hex += kDigits[static_cast<unsigned char>(c) >> 4U];
    hex += kDigits[static_cast<unsigned char>(c) & 15U];
  }
  return hex;
}

TEST(MqttHostile, AMillionPacketsAreReadOrRefused) {
  const char* wanted = std::getenv("FLEETPROOF_PACKETS");
  const std::size_t most = wanted == nullptr ? 1'000'000 : std::strtoull(wanted, nullptr, 10);
  DrawnStreams drawn(3);
  std::size_t streams = 0, refused = 0;
  for (std::size_t packets = 0; packets < most && !HasFailure(); ++streams) {
    const std::string stream = drawn.stream();
    std::size_t read = 0;
    EXPECT_EQ(fuzz::wrong_with_packets(stream, read), "") << as_hex(stream);
    EXPECT_EQ(fuzz::wrong_with_answers(stream), "") << as_hex(stream);
    const bool is_refused = !fuzz::read_packets(stream, 0).error.empty();
    packets += read + (is_refused ? 1 : 0);
    refused += is_refused ? 1 : 0;
  }
  EXPECT_GT(refused, streams / 5) << "damage is light";
  EXPECT_LT(refused, streams * 4 / 5) << "damage is heavy";
}

TEST(MqttHostile, DamagedDisksAreRestoredOrRefused) {
  BrokerBench bench;
  bench.connect(1, keeping("agv1"), {{"order", 1}, {"v/+/state", 0}});
  bench.connect(2, keeping("agv2"), {{"#", 1}});
  bench.say(1, message("c/agv1", "ONLINE", 1, true));
  bench.say(1, message("order", "o1", 1));
  bench.broker.lost(1);
  const std::string disk = bench.broker.saved();
  DrawnStreams drawn(5);
  std::size_t accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string damaged = disk;
    for (std::size_t changes = 1 + drawn.below(2); changes > 0; --changes) drawn.damage(damaged);
    bool is_accepted = false;
    EXPECT_EQ(fuzz::wrong_with_disk(damaged, is_accepted), "") << as_hex(damaged);
    accepted += is_accepted ? 1 : 0;
  }
  EXPECT_GT(accepted, 0U) << "a payload may be another one";
  EXPECT_LT(accepted, 10'000U);
}

// Bytes that wait for the rest of a packet stay below the largest packet.
TEST(MqttHostile, NothingIsCollectedForAPacketThatIsTooLarge) {
  PacketReader reader(1000);
  reader.add(std::string("\x30\xe9\x07", 3));  // 1 001 bytes follow
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.error(), "a packet of 1004 bytes; the most is 1000");
  for (int i = 0; i < 100; ++i) reader.add(std::string(1000, 'x'));
  EXPECT_EQ(reader.left(), 3U);
}

}  // namespace
}  // namespace fleetproof::mqtt_hostile_test
