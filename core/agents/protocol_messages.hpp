#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/agents/path.hpp"

namespace fleetproof::agents {

enum class MessageKind : std::uint8_t { State = 1, Request, Grant, Defer };
constexpr const char* name_of(MessageKind kind) {
  switch (kind) {
    case MessageKind::State:
      return "STATE";
    case MessageKind::Request:
      return "REQUEST";
    case MessageKind::Grant:
      return "GRANT";
    case MessageKind::Defer:
      return "DEFER";
  }
  return "?";
}

// The number of a request: the boot of the AGV's computer, then the number of the request since that boot. Numbers only
// grow and none is used twice, because the number of the boot survives a restart. Compare whole numbers, never modulo.
using Epoch = std::uint64_t;
constexpr Epoch first_epoch(std::uint32_t boot) { return Epoch{boot} << 32; }  // before any request
constexpr std::uint32_t boot_of(Epoch epoch) { return static_cast<std::uint32_t>(epoch >> 32); }
constexpr std::uint32_t number_of(Epoch epoch) { return static_cast<std::uint32_t>(epoch); }

// What every message says about its sender.
struct Status {
  std::uint32_t stamp_ms = 0;  // the sender's clock at the instant of sending
  Vec position_m;
  Epoch epoch = 0;          // the epoch of its newest request
  bool requesting = false;  // that request is still open
  bool blocked = false;     // an AGV stands and waits inside the hull of that request
  bool waiting = false;     // it stands and can only wait for a lock
  bool idle = false;        // it is waiting and has no transport
  bool out_of_order = false;
  Path held;  // the path whose hull it holds
};

// The newest stamps that the sender has seen on messages of the AGVs first, first + 1, ...; 0: no message yet.
struct HeardFrom {
  static constexpr std::uint32_t kMax = 128;
  std::uint32_t first = 0, count = 0;
  std::array<std::uint32_t, kMax> stamps_ms;
};

struct Message {
  MessageKind kind = MessageKind::State;
  Status status;
  HeardFrom heard;             // State
  std::int64_t demand_ns = 0;  // Request: since when the sender has wanted to go on
  Path request;                // Request: the path to lock, from the end of the held path. Its epoch is status.epoch
  Epoch echo = 0;              // Grant, Defer: the epoch of the answered request
};

// A message as bytes: little-endian fields of fixed size. The boot of an epoch is written only if it is not the first.
// Requires: stations and lanes have numbers below 65 536.
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

// The message, if the bytes are exactly one message. The caller must check that the paths exist on its map.
std::optional<Message> decode(std::span<const std::byte> bytes);

}  // namespace fleetproof::agents
