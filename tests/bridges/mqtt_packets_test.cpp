// Packets of MQTT 3.1.1 as bytes. In brackets: the numbers of the standard's normative statements.
#include "core/bridges/mqtt/packets.hpp"

#include <gmock/gmock.h>

#include <string>
#include <string_view>

#include "core/bridges/mqtt/topics.hpp"

namespace fleetproof::mqtt_packets_test {
namespace {

using namespace mqtt;
using namespace std::string_literals;

// All packets of the bytes, given at once or one byte at a time, and then the error.
std::pair<std::vector<Packet>, std::string> read(std::string_view bytes, std::size_t piece = std::string::npos) {
  PacketReader reader;
  std::vector<Packet> packets;
  for (std::size_t at = 0; at < bytes.size(); at += std::min(piece, bytes.size())) {
    reader.add(bytes.substr(at, piece));
    while (auto packet = reader.next()) packets.push_back(std::move(*packet));
  }
  return {packets, reader.error()};
}
std::string error_of(std::string_view bytes) {
  EXPECT_EQ(read(bytes), read(bytes, 1)) << "in pieces";
  return read(bytes).second;
}

const std::vector<Packet> kSamples = {
    Connect{.client = "agv1"},
    Connect{.client = "", .keep_alive_s = 15},
    Connect{.client = "a", .is_clean = false, .keep_alive_s = 65535, .will = Will{"t/c", "gone"s, 1, true}},
    Connack{true, ConnectCode::Accepted},
    Connack{false, ConnectCode::NotAuthorized},
    Publish{.topic = "a/b", .payload = ""},
    Publish{.topic = "a/b", .payload = std::string(200'000, '\0'), .qos = 1, .retain = true, .is_again = true, .id = 7},
    Publish{.topic = "ä/€/𝄞", .payload = "{}", .qos = 2, .id = 65535},
    Puback{1},
    Subscribe{2, {{"a/+/c", 0}, {"#", 1}, {"b", 2}}},
    Suback{2, {0, 1, 2, kRefused}},
    Unsubscribe{3, {"a/#", "+"}},
    Unsuback{3},
    Pingreq{},
    Pingresp{},
    Disconnect{}};

TEST(MqttPackets, AreReadAsTheyWereWritten) {
  std::string bytes;
  for (const Packet& packet : kSamples) {
    EXPECT_EQ(read(encode(packet)).first, std::vector<Packet>{packet}) << text_of(packet);
    bytes += encode(packet);
  }
  EXPECT_EQ(read(bytes), std::pair(kSamples, ""s));
  EXPECT_EQ(read(bytes, 1), std::pair(kSamples, ""s));
  EXPECT_EQ(read(bytes, 3).first.size(), kSamples.size());
  EXPECT_EQ(read(bytes.substr(0, bytes.size() - 1)).second, "") << "the rest may come";
}

// As the figures of the standard have them.
TEST(MqttPackets, HaveTheBytesOfTheStandard) {
  EXPECT_EQ(encode(Connect{.client = "A", .keep_alive_s = 10}), "\x10\x0d\0\4MQTT\4\2\0\x0a\0\1A"s);
  EXPECT_EQ(encode(Publish{.topic = "a/b", .payload = "x", .qos = 1, .id = 10}), "\x32\x08\0\3a/b\0\x0ax"s);
  EXPECT_EQ(encode(Puback{0x1234}), "\x40\x02\x12\x34"s);
  EXPECT_EQ(encode(Subscribe{10, {{"a/b", 1}}}), "\x82\x08\0\x0a\0\3a/b\1"s);
  EXPECT_EQ(encode(Suback{10, {0, kRefused}}), "\x90\x04\0\x0a\0\x80"s);
  EXPECT_EQ(encode(Pingreq{}), "\xc0\0"s);
  EXPECT_EQ(encode(Disconnect{}), "\xe0\0"s);
  EXPECT_EQ(encode(Publish{.topic = "t", .payload = std::string(321 - 3, 'x')}).substr(0, 3), "\x30\xc1\x02"s)
      << "a length of 321 bytes";
}

struct Wrong {
  std::string bytes, error;
};

TEST(MqttPackets, WhatTheStandardForbidsIsNamed) {
  const std::string head = "\0\4MQTT\4"s;
  const auto connect = [&](const std::string& rest) {
    return "\x10"s + static_cast<char>(head.size() + rest.size()) + head + rest;
  };
  for (const Wrong& wrong :
       {Wrong{"\x82\x08\0\0\0\3a/b\1"s, "SUBSCRIBE has packet identifier 0"},                  // [MQTT-2.3.1-1]
        {"\x40\x02\0\0"s, "PUBACK has packet identifier 0"},                                   // [MQTT-2.3.1-1]
        {"\x80\x08\0\x0a\0\3a/b\1"s, "SUBSCRIBE has reserved flags set"},                      // [MQTT-3.8.1-1]
        {"\xc1\0"s, "PINGREQ has reserved flags set"},                                         // [MQTT-2.2.2-2]
        {"\xe0\x01x"s, "DISCONNECT has bytes behind its end"},                                 //
        {"\x36\x05\0\1a\0\1"s, "PUBLISH has QoS 3"},                                           // [MQTT-3.3.1-4]
        {"\x38\x03\0\1a"s, "PUBLISH repeats a message of QoS 0"},                              // [MQTT-3.3.1-2]
        {"\x30\x04\0\2a#"s, "PUBLISH has a topic that is empty or has a wildcard in it"},      // [MQTT-3.3.2-2]
        {"\x30\x02\0\0"s, "PUBLISH has a topic that is empty or has a wildcard in it"},        // [MQTT-4.7.3-1]
        {"\x30\x04\0\2a\0"s, "PUBLISH has a text that is no UTF-8, or has U+0000 in it"},      // [MQTT-1.5.3-2]
        {"\x30\x05\0\3\xed\xa0\x80"s, "PUBLISH has a text that is no UTF-8, or has U+0000"},   // [MQTT-1.5.3-1]
        {"\x30\x04\0\2\xc0\x80"s, "PUBLISH has a text that is no UTF-8"},                      //
        {"\x30\x02\0\x09"s, "PUBLISH ends too early"},                                         //
        {"\x82\x02\0\x0a"s, "SUBSCRIBE ends too early"},                                       // [MQTT-3.8.3-3]
        {"\x82\x08\0\x0a\0\3a/b\3"s, "SUBSCRIBE asks for a QoS above 2"},                      // [MQTT-3-8.3-4]
        {"\x82\x08\0\x0a\0\3a#b\1"s, "SUBSCRIBE has a topic filter that is empty, or has a"},  // [MQTT-4.7.1-2]
        {"\xa2\x02\0\x0a"s, "UNSUBSCRIBE ends too early"},                                     // [MQTT-3.10.3-2]
        {"\x20\x02\x02\0"s, "CONNACK has reserved flags set"},                                 //
        {"\x20\x02\1\2"s, "CONNACK refuses and has a session"},                                // [MQTT-3.2.2-4]
        {"\x50\x02\0\1"s, "PUBREC belongs to QoS 2, which is not offered"},                    //
        {"\x62\x02\0\1"s, "PUBREL belongs to QoS 2, which is not offered"},                    //
        {"\0\0"s, "a packet of type 0 is none of MQTT 3.1.1"},                                 //
        {"\xf0\0"s, "a packet of type 15 is none of MQTT 3.1.1"},                              //
        {"\x30\xff\xff\xff\xff\x01"s, "a length of more than four bytes"},                     // 2.2.3
        {"\x30\xff\xff\xff\x7f"s, "a packet of 268435460 bytes; the most is 262144"},          //
        {connect("\3\0\0\0\1a"s), "CONNECT has its reserved flag set"},                        // [MQTT-3.1.2-3]
        {connect("\x0a\0\0\0\1a"s), "CONNECT has a wrong QoS of its will"},                    // [MQTT-3.1.2-13]
        {connect("\x1e\0\0\0\1a\0\1t\0\0"s), "CONNECT has a wrong QoS of its will"},           // [MQTT-3.1.2-14]
        {connect("\x22\0\0\0\1a"s), "CONNECT retains a will that it does not have"},           // [MQTT-3.1.2-15]
        {connect("\x42\0\0\0\1a\0\1p"s), "CONNECT has a password without a user"},             // [MQTT-3.1.2-22]
        {"\x10\x0e\0\6MQIsdp\3\2\0\0\0\0"s, "CONNECT asks for the protocol \"MQIsdp\""},       // [MQTT-3.1.2-1]
        {"\x16\3\1\2\0"s, "the client speaks TLS, which is not offered"},                      //
        {"GET /mqtt HTTP/1.1\r\n"s, "the client speaks HTTP (WebSockets), which is not offered"}}) {
    EXPECT_THAT(error_of(wrong.bytes), testing::StartsWith(wrong.error));
    EXPECT_TRUE(read(wrong.bytes).first.empty()) << wrong.error;
    EXPECT_TRUE(read(wrong.bytes + encode(Pingreq{})).first.empty()) << "nothing is read behind it: " << wrong.error;
  }
}

// What a broker refuses with a return code is read.
TEST(MqttPackets, OfOtherVersionsAndWithPasswordsAreRead) {
  const auto five = read("\x10\x0e\0\4MQTT\5\2\0\0\0\0\1a"s).first;
  ASSERT_EQ(five.size(), 1U);
  EXPECT_EQ(std::get<Connect>(five.front()).level, 5);
  const auto known = read("\x10\x13\0\4MQTT\4\xc2\0\0\0\1a\0\1u\0\1p"s).first;
  ASSERT_EQ(known.size(), 1U);
  EXPECT_TRUE(std::get<Connect>(known.front()).has_user);
  EXPECT_TRUE(std::get<Connect>(known.front()).has_password);
}

TEST(MqttPackets, AreNamedForPeople) {
  EXPECT_EQ(text_of(Publish{.topic = "uagv/v2/fp/agv2/order", .payload = std::string(412, 'x')}),
            "PUBLISH: uagv/v2/fp/agv2/order, QoS 0, 412 bytes");
  EXPECT_EQ(text_of(Publish{.topic = "c", .payload = "x", .qos = 1, .retain = true, .is_again = true, .id = 3}),
            "PUBLISH: c, QoS 1, retained, again, 1 bytes");
  EXPECT_EQ(text_of(Subscribe{1, {{"a", 0}, {"b", 0}}}), "SUBSCRIBE: a and 1 more");
  EXPECT_LE(text_of(Connect{.client = std::string(1000, '\n')}).size(), 120U);
}

TEST(MqttTopics, MatchAsTheStandardSays) {  // section 4.7
  const auto match = [](std::string_view filter, std::string_view topic) { return matches(filter, topic); };
  EXPECT_TRUE(match("sport/tennis/player1/#", "sport/tennis/player1"));
  EXPECT_TRUE(match("sport/tennis/player1/#", "sport/tennis/player1/score/wimbledon"));
  EXPECT_TRUE(match("sport/#", "sport"));
  EXPECT_TRUE(match("#", "a/b"));
  EXPECT_TRUE(match("sport/tennis/+", "sport/tennis/player1"));
  EXPECT_FALSE(match("sport/tennis/+", "sport/tennis/player1/ranking"));
  EXPECT_FALSE(match("sport/+", "sport"));
  EXPECT_TRUE(match("sport/+", "sport/"));
  EXPECT_TRUE(match("+/+", "/finance"));
  EXPECT_TRUE(match("/+", "/finance"));
  EXPECT_FALSE(match("+", "/finance"));
  EXPECT_TRUE(match("+/tennis/#", "a/tennis"));
  EXPECT_FALSE(match("#", "$SYS/x"));
  EXPECT_FALSE(match("+/monitor/Clients", "$SYS/monitor/Clients"));
  EXPECT_TRUE(match("$SYS/#", "$SYS/monitor"));
  EXPECT_FALSE(match("a", "A")) << "case counts: [MQTT-4.7.3]";
  EXPECT_FALSE(match("a/b", "a"));
  EXPECT_FALSE(match("a", "a/b"));
  for (const char* filter : {"#", "+", "a/#", "a/+/b", "/", "+/tennis/#", " "})
    EXPECT_TRUE(is_filter(filter)) << filter;
  for (const char* filter : {"", "a#", "a/#/b", "a+", "a/+b", "##"}) EXPECT_FALSE(is_filter(filter)) << filter;
  for (const char* topic : {"a", "/", "a b", "$x"}) EXPECT_TRUE(is_topic(topic)) << topic;
  for (const char* topic : {"", "a/+", "#"}) EXPECT_FALSE(is_topic(topic)) << topic;
}

}  // namespace
}  // namespace fleetproof::mqtt_packets_test
