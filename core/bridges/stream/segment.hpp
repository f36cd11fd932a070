// The wire form of a stream: what one datagram carries of one connection.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/agents/byte_fields.hpp"

namespace fleetproof::stream {

// Which connection: participant, boot and count of who opened it, so that no late segment is taken for one of another
// connection, and the port that it was opened to.
struct ConnectionId {
  std::uint32_t opener = 0, boot = 0, count = 0;
  std::uint16_t port = 0;
  friend auto operator<=>(const ConnectionId&, const ConnectionId&) = default;
  void fields(auto& io) { io(opener, boot, count, port); }
};

// A segment has a number if it opens, carries bytes, or closes: these are acknowledged, and come again if they are not.
// Number 0 opens, at each end.
struct Segment {
  enum class Kind : std::uint8_t { Open, Data, Close, Ack, Reset };

  ConnectionId id;
  Kind kind = Kind::Ack;
  std::uint32_t number = 0;    // Ack and Reset: 0
  bool is_repeat = false;      // it was sent before
  std::uint32_t expected = 0;  // all numbers below have arrived; 0: nothing has, as in the first Open
  // One more than the number of a segment that has just arrived and is no repeat, so that its round trip can be
  // measured; 0: none. Real stacks have timestamps for that (RFC 7323).
  std::uint32_t measures = 0;
  std::vector<std::byte> bytes;

  bool has_number() const { return kind == Kind::Open || kind == Kind::Data || kind == Kind::Close; }
};

// With all else, a segment has at most 1 000 bytes, so that it fits into each datagram (FP_MESSAGE_BYTES_MAX).
inline constexpr std::size_t kSegmentBytes = 1000, kHeadBytes = 29, kMostBytes = kSegmentBytes - kHeadBytes;

std::vector<std::byte> encode(const Segment& segment);
// None: the datagram is no segment, or one that no end of a stream sends.
std::optional<Segment> decode(std::span<const std::byte> datagram);

}  // namespace fleetproof::stream
