// A broker, a client, and what they say.
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/bridges/mqtt/broker.hpp"
#include "core/bridges/mqtt/client.hpp"

namespace fleetproof::mqtt {

// A broker and what it says on its connections.
struct BrokerBench {
  explicit BrokerBench(BrokerSettings settings = {})
      : broker({[this](std::uint32_t c, std::string_view bytes, std::string_view) { out[c].add(bytes); },
                [this](std::uint32_t c, std::string_view reason) { closed[c] = reason; }},
               settings) {}

  void say(std::uint32_t connection, const Packet& packet) { broker.received(connection, encode(packet), now_ns); }
  // All packets that came since, as people read them; of messages, what is in them, too.
  std::vector<std::string> heard(std::uint32_t connection) {
    std::vector<std::string> texts;
    while (const auto packet = out[connection].next()) {
      const auto* publish = std::get_if<Publish>(&*packet);
      texts.push_back(publish == nullptr ? text_of(*packet) : text_of(*packet) + " " + publish->payload);
      if (publish != nullptr && publish->qos == 1) last_id = publish->id;
    }
    EXPECT_EQ(out[connection].error(), "");
    return texts;
  }
  void connect(std::uint32_t connection, const Connect& connect, const std::vector<Filter>& filters = {}) {
    broker.opened(connection, now_ns);
    say(connection, connect);
    if (!filters.empty()) say(connection, Subscribe{1, filters});
  }

  std::map<std::uint32_t, PacketReader> out;
  std::map<std::uint32_t, std::string> closed;
  std::int64_t now_ns = 0;
  std::uint16_t last_id = 0;  // of a message at QoS 1
  Broker broker;
};

inline Connect named(const std::string& name) { return {.client = name}; }
inline Connect keeping(const std::string& name) { return {.client = name, .is_clean = false}; }
inline Publish message(const std::string& topic, const std::string& payload, std::uint8_t qos = 0,
                       bool retain = false) {
  return {.topic = topic, .payload = payload, .qos = qos, .retain = retain, .id = std::uint16_t{qos}};
}

// A client and what it says.
struct ClientBench {
  explicit ClientBench(ClientSettings settings = {.name = "agv", .keep_alive_s = 10, .filters = {{"order", 0}}})
      : client({[this](std::string_view bytes, std::string_view) { out.add(bytes); },
                [this](std::string_view reason) { closed = reason; }},
               std::move(settings)) {}

  std::vector<std::string> said() {
    std::vector<std::string> texts;
    while (const auto packet = out.next()) texts.push_back(text_of(*packet));
    return texts;
  }

  PacketReader out;
  std::string closed;
  Client client;
};

}  // namespace fleetproof::mqtt
