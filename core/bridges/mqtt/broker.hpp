// An MQTT 3.1.1 broker as a pure state machine: bytes of connections in, bytes of connections out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/bridges/mqtt/packets.hpp"

namespace fleetproof::mqtt {

struct BrokerSettings {
  std::size_t most_packet_bytes = std::size_t{1} << 18U;
  // Kept at most: messages and subscriptions of one session (up to 65 535), sessions, retained messages. A message
  // above is dropped, so the oldest stay; a subscription or a session above is refused.
  std::size_t most_of_session = 1000, most_sessions = 1000, most_retained = 10'000;
  std::int64_t connect_within_ns = 30'000'000'000;  // from the opening of a connection to its CONNECT
};

// What the broker does to connections, each under the number that its owner gave it. `text`: for people.
struct Wires {
  std::function<void(std::uint32_t connection, std::string_view bytes, std::string_view text)> send;
  std::function<void(std::uint32_t connection, std::string_view reason)> close;
};

// Sessions clean and kept, QoS 0 and 1, retained messages, last wills, keep alive, wildcards. Refused by name: MQTT 5
// and 3.1, QoS 2, users and passwords, TLS, WebSockets, topics of the server ($SYS).
class Broker {
 public:
  Broker(Wires wires, BrokerSettings settings = {}) : wires_(std::move(wires)), settings_(settings) {}

  // Requires: the number is that of no open connection.
  void opened(std::uint32_t connection, std::int64_t now_ns);
  void received(std::uint32_t connection, std::string_view bytes, std::int64_t now_ns);
  // The connection is gone: its will is published.
  void lost(std::uint32_t connection);
  void tick(std::int64_t now_ns);
  // When `tick` has to be called at the latest.
  std::optional<std::int64_t> deadline_ns() const;

  // Retained messages and kept sessions, and back. Text that was not written by `saved` is refused, and changes
  // nothing. Requires: no connection is open.
  std::string saved() const;
  bool restore(std::string_view text);
  // Counts what `saved` would tell: equal numbers, equal texts.
  std::uint64_t changes() const { return changes_; }

  // Faults. Of messages at QoS 0 that arrive now, so many are dropped.
  void drop_messages(std::uint64_t count) { to_drop_ = count; }
  // Closes the connection of each client without a word to it.
  void cut_all();
  // A client with this name of another one connects, and is gone at once.
  void take_over(const std::string& client);
  std::vector<std::string> connected() const;  // names of clients

 private:
  struct Session {
    bool is_clean = true;
    std::optional<std::uint32_t> connection{};
    std::map<std::string, std::uint8_t> subscriptions{};  // by filter: the QoS
    std::deque<Publish> unacknowledged{};                 // of QoS 1, in order
    std::uint16_t last_id = 0;
  };
  struct Link {
    PacketReader reader;
    std::string client{};  // once it is connected
    bool is_connected = false;
    std::optional<Will> will{};
    std::uint16_t keep_alive_s = 0;
    std::int64_t heard_ns = 0;  // opened, or the last whole packet
  };

  void handle(std::uint32_t connection, Link& link, const Packet& packet, std::int64_t now_ns);
  void connect(std::uint32_t connection, Link& link, const Connect& connect, std::int64_t now_ns);
  void take(std::uint32_t connection, const Publish& publish);
  void subscribe(std::uint32_t connection, Link& link, const Subscribe& subscribe);
  void unsubscribe(std::uint32_t connection, Link& link, const Unsubscribe& unsubscribe);
  void acknowledge(const Link& link, std::uint16_t id);
  std::string free_name();  // for a client without one
  void retain(const Publish& publish);
  void route(const Publish& publish);
  void deliver(Session& session, Publish publish);
  // Ends a connection at this end; its will is published unless it had said that it goes.
  void end(std::uint32_t connection, std::string_view reason);
  void send(std::uint32_t connection, const Packet& packet);
  std::optional<std::int64_t> silent_at_ns(const Link& link) const;

  Wires wires_;
  BrokerSettings settings_;
  std::map<std::uint32_t, Link> links_;
  std::map<std::string, Session> sessions_;  // by client
  std::map<std::string, Publish> retained_;  // by topic
  std::uint64_t changes_ = 0, to_drop_ = 0, nameless_ = 0;
};

}  // namespace fleetproof::mqtt
