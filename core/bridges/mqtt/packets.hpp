// The packets of MQTT 3.1.1 (OASIS), as far as fleets use them, and how they are read from a stream of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fleetproof::mqtt {

// What a broker publishes for a client that is gone without a DISCONNECT.
struct Will {
  std::string topic, payload;
  std::uint8_t qos = 0;
  bool retain = false;
  friend bool operator==(const Will&, const Will&) = default;
};

struct Connect {
  std::uint8_t level = 4;  // of the protocol: 4 is MQTT 3.1.1
  std::string client;
  bool is_clean = true;
  std::uint16_t keep_alive_s = 0;
  std::optional<Will> will{};
  bool has_user = false, has_password = false;  // refused, so they are not kept
  friend bool operator==(const Connect&, const Connect&) = default;
};
enum class ConnectCode : std::uint8_t { Accepted, WrongLevel, WrongClient, NotNow, WrongPassword, NotAuthorized };
struct Connack {
  bool session_present = false;
  ConnectCode code = ConnectCode::Accepted;
  friend bool operator==(const Connack&, const Connack&) = default;
};
struct Publish {
  std::string topic{}, payload{};
  std::uint8_t qos = 0;
  bool retain = false, is_again = false;
  std::uint16_t id = 0;  // QoS 0 has none
  friend bool operator==(const Publish&, const Publish&) = default;
};
struct Puback {
  std::uint16_t id = 0;
  friend bool operator==(const Puback&, const Puback&) = default;
};
struct Filter {
  std::string text;
  std::uint8_t qos = 0;
  friend bool operator==(const Filter&, const Filter&) = default;
};
struct Subscribe {
  std::uint16_t id = 0;
  std::vector<Filter> filters;
  friend bool operator==(const Subscribe&, const Subscribe&) = default;
};
inline constexpr std::uint8_t kRefused = 0x80;
struct Suback {
  std::uint16_t id = 0;
  std::vector<std::uint8_t> codes;  // the QoS that is granted, or kRefused
  friend bool operator==(const Suback&, const Suback&) = default;
};
struct Unsubscribe {
  std::uint16_t id = 0;
  std::vector<std::string> filters;
  friend bool operator==(const Unsubscribe&, const Unsubscribe&) = default;
};
struct Unsuback {
  std::uint16_t id = 0;
  friend bool operator==(const Unsuback&, const Unsuback&) = default;
};
struct Pingreq {
  friend bool operator==(const Pingreq&, const Pingreq&) = default;
};
struct Pingresp {
  friend bool operator==(const Pingresp&, const Pingresp&) = default;
};
struct Disconnect {
  friend bool operator==(const Disconnect&, const Disconnect&) = default;
};

using Packet = std::variant<Connect, Connack, Publish, Puback, Subscribe, Suback, Unsubscribe, Unsuback, Pingreq,
                            Pingresp, Disconnect>;

// Requires: texts and payload fit (65 535 bytes a text, 268 435 455 bytes behind the length).
std::string encode(const Packet& packet);
// For people: "PUBLISH: uagv/v2/fp/agv2/order, QoS 0, 412 bytes".
std::string text_of(const Packet& packet);

// Reads packets from bytes that come in any pieces. Once something is wrong, it reads nothing more.
class PacketReader {
 public:
  // `most_bytes`: of one packet.
  explicit PacketReader(std::size_t most_bytes = std::size_t{1} << 18U) : most_bytes_(most_bytes) {}

  void add(std::string_view bytes);
  // None: there is no further whole packet, or something is wrong.
  std::optional<Packet> next();
  // A sentence about what is wrong; empty: nothing is.
  const std::string& error() const { return error_; }
  // How many bytes are not read yet.
  std::size_t left() const { return bytes_.size() - read_; }

 private:
  // How long the next packet is, its first byte and its length included; none: not known yet, or wrong.
  std::optional<std::size_t> next_size();

  std::size_t most_bytes_;
  std::string bytes_;
  std::size_t read_ = 0;  // of these
  bool is_first_ = true;
  std::string error_;
};

}  // namespace fleetproof::mqtt
