// One client of an MQTT 3.1.1 broker, as a pure state machine.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/bridges/mqtt/packets.hpp"

namespace fleetproof::mqtt {

struct ClientSettings {
  std::string name;
  bool is_clean = true;
  std::uint16_t keep_alive_s = 15;
  std::optional<Will> will{};
  std::vector<Filter> filters{};              // subscribed to after each connect
  std::int64_t patience_ns = 10'000'000'000;  // for CONNACK and PINGRESP
};

// What the client does to its connection. `text`: for people.
struct Wire {
  std::function<void(std::string_view bytes, std::string_view text)> send;
  std::function<void(std::string_view reason)> close;
};

class Client {
 public:
  Client(Wire wire, ClientSettings settings) : wire_(std::move(wire)), settings_(std::move(settings)) {}

  // Of the connection to the broker.
  void opened(std::int64_t now_ns);
  void received(std::string_view bytes, std::int64_t now_ns);
  void lost();
  void tick(std::int64_t now_ns);
  std::optional<std::int64_t> deadline_ns() const;

  // Of connections that are opened from now on.
  void set_will(Will will) { settings_.will = std::move(will); }

  bool is_connected() const { return state_ == State::Connected; }
  // True once for each connect: the broker has accepted it, and the filters were sent.
  bool take_connected() { return std::exchange(has_connected_, false); }
  // At QoS 1, it is sent again until the broker has it, also over connections. At QoS 0, it is lost without one.
  // `text`: for people, instead of the name of the packet.
  void publish(Publish publish, std::string_view text, std::int64_t now_ns);
  // Messages that came, in order.
  std::vector<Publish> take_messages() { return std::exchange(messages_, {}); }

 private:
  enum class State : std::uint8_t { Away, Connecting, Connected };
  struct Unacknowledged {
    Publish publish;
    std::string text;
  };

  void handle(const Packet& packet, std::int64_t now_ns);
  void welcome(const Connack& connack, std::int64_t now_ns);
  void send(const Packet& packet, std::int64_t now_ns, std::string_view text = {});
  void end(std::string_view reason);
  std::uint16_t next_id();

  Wire wire_;
  ClientSettings settings_;
  State state_ = State::Away;
  bool has_connected_ = false;
  PacketReader reader_;
  std::int64_t sent_ns_ = 0;                    // the last packet
  std::optional<std::int64_t> answer_by_ns_{};  // CONNACK or PINGRESP
  std::uint16_t last_id_ = 0;
  std::deque<Unacknowledged> unacknowledged_;
  std::vector<Publish> messages_;
};

}  // namespace fleetproof::mqtt
