#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/agents/path.hpp"

namespace fleetproof::agents {

enum class MessageKind : std::uint8_t { State = 1, Request, Grant, Defer };

// A numbered request of one AGV: how often its computer has restarted, then which of its requests since. Numbers grow
// and none comes twice, as that of the boot outlives a restart; compared whole, never modulo.
using Epoch = std::uint64_t;
constexpr Epoch first_epoch(std::uint32_t boot) { return Epoch{boot} << 32; }  // before any request
constexpr std::uint32_t boot_of(Epoch epoch) { return static_cast<std::uint32_t>(epoch >> 32); }
constexpr std::uint32_t number_of(Epoch epoch) { return static_cast<std::uint32_t>(epoch); }

// What every message tells about its sender.
struct Status {
  std::uint32_t stamp_ms = 0;  // the sender's clock when it sent this
  Vec position_m;
  Epoch epoch = 0;          // of its newest request
  bool requesting = false;  // that request is still open
  bool blocked = false;     // somebody stands in the way of that request, and waits
  bool waiting = false;     // it stands with nothing left to do that needs no lock
  bool idle = false;        // it waits and has no transport
  bool out_of_order = false;
  Path held;  // whose hull it holds
};

// The newest stamps its sender has seen on messages of AGVs first, first + 1, ...: 0 for none.
struct HeardFrom {
  static constexpr std::uint32_t kMax = 128;
  std::uint32_t first = 0, count = 0;
  std::array<std::uint32_t, kMax> stamps_ms;
};

struct Message {
  MessageKind kind = MessageKind::State;
  Status status;
  HeardFrom heard;             // State
  std::int64_t demand_ns = 0;  // Request: since when it has wanted to go on
  Path request;    // Request: what it wants to lock, from the end of what it holds. Its epoch is status.epoch
  Epoch echo = 0;  // Grant, Defer: epoch of the request that is answered
};

// A message as bytes: little-endian fields of fixed size, and the boot of an epoch only if it is not the first.
// Stations and lanes must have numbers below 65 536.
class WireMessage {
 public:
  explicit WireMessage(const Message& message);
  std::span<const std::byte> bytes() const { return {bytes_.data(), size_}; }

 private:
  void put(std::uint64_t value, std::uint32_t size);
  void put_epoch(Epoch epoch);
  void put_path(const Path& path);

  std::array<std::byte, 1024> bytes_;
  std::size_t size_ = 0;
};

// Nothing unless the bytes are exactly one message. Whether its paths exist on the map is for the reader to ask.
std::optional<Message> decode(std::span<const std::byte> bytes);

}  // namespace fleetproof::agents
