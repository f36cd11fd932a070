#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "core/agents/path.hpp"
#include "core/agents/zone_set.hpp"

namespace fleetproof::agents {

enum class MessageKind : std::uint8_t { State = 1, Request, Grant, Defer, Join, Roll };
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
    case MessageKind::Join:
      return "JOIN";
    case MessageKind::Roll:
      return "ROLL";
  }
  return "?";
}

// The number of a request: the boot of the AGV's computer, then the number of the request since that boot, then the
// number of the attempt: each AGV that is asked has its own attempts. Numbers only grow and none is used twice, because
// the number of the boot survives a restart. Compare whole numbers, never modulo.
using Epoch = std::uint64_t;
inline constexpr Epoch kAttempts = 256;                                        // of one request
constexpr Epoch first_epoch(std::uint32_t boot) { return Epoch{boot} << 32; }  // before any request
constexpr Epoch next_request(Epoch epoch) { return (epoch / kAttempts + 1) * kAttempts; }
constexpr Epoch request_of(Epoch epoch) { return epoch / kAttempts * kAttempts; }  // its first attempt
constexpr std::uint32_t boot_of(Epoch epoch) { return static_cast<std::uint32_t>(epoch >> 32); }
constexpr std::uint32_t number_of(Epoch epoch) { return static_cast<std::uint32_t>(epoch); }

// What every message says about its sender, but for its ways.
struct Condition {
  std::uint32_t stamp_ms = 0;  // the sender's clock at the instant of sending
  Vec position_m;
  bool position_is_new = true;  // perceived at the instant of sending
  Epoch epoch = 0;              // of its newest request
  bool requesting = false;      // that request is still open
  bool blocked = false;         // an AGV stands and waits inside the hull of that request
  bool held_up = false;         // that request is young, and an AGV holds floor inside its hull
  bool waiting = false;         // it stands and can only wait for a lock
  bool idle = false;            // it is waiting and has no transport
  bool out_of_order = false;
  bool place_unknown = false;  // since a restart, it does not know what it covers; the held path does not say it
};
struct Status : Condition {
  Path held;   // the path whose hull it holds
  Path ahead;  // the way that it announces from there. On the wire only its lanes
};

// The part of a message that says what its sender holds and announces, and in which zones. Most messages repeat that of
// the message before.
struct WayBytes {
  // Station, heading, the numbers of lanes and zones, and these.
  static constexpr std::size_t kMax = 9 + 2 * std::size_t{kPathLanesMax} + 2 * std::size_t{ZoneSet::kMax};
  static_assert(kMax == 217);
  bool tell_zones = false;
  std::size_t size = 0;  // 0: none are known
  std::array<std::byte, kMax> bytes;

  // Requires: the bytes are those of a message that was read.
  void keep(std::span<const std::byte> of, bool with_zones) {
    tell_zones = with_zones;
    size = of.size();
    std::ranges::copy(of, bytes.begin());
  }
  // Whether a message that goes on like this says the same.
  bool begin(std::span<const std::byte> rest, bool with_zones) const {
    return size > 0 && with_zones == tell_zones && rest.size() >= size &&
           std::memcmp(rest.data(), bytes.data(), size) == 0;
  }
};

// The newest stamps that the sender has seen on messages of the AGVs first, first + 1, ...; 0: no message yet.
struct HeardFrom {
  static constexpr std::uint32_t kMax = 64;
  std::uint32_t first = 0, count = 0;
  std::array<std::uint32_t, kMax> stamps_ms;
};

// The AGVs whose consent the sender still needs for its request. The first ones have not answered, the others have
// deferred.
struct Asked {
  struct Entry {
    std::uint32_t agv;
    std::uint32_t attempt;  // the number of the epoch is that of the request and this
  };
  static constexpr std::uint32_t kMax = 64;
  std::uint32_t count = 0, unanswered = 0;
  std::array<Entry, kMax> list;

  // Requires: all that have not answered are added first. False if the list is full.
  bool add(const Entry& entry, bool has_deferred = false) {
    if (count == kMax) return false;
    list[count++] = entry;
    if (!has_deferred) unanswered = count;
    return true;
  }
  std::span<const Entry> all() const { return {list.data(), count}; }
  // Null if this AGV is not asked.
  const Entry* of(std::uint32_t agv) const {
    const auto entry = std::ranges::find(all(), agv, &Entry::agv);
    return entry == all().end() ? nullptr : &*entry;
  }
  bool has_deferred(const Entry& entry) const { return &entry >= list.data() + unanswered; }
};

// What the sender answered to open requests.
struct Answers {
  struct Answer {
    std::uint32_t agv;  // the one that asked
    Epoch echo;         // the epoch of the answered request
    bool granted;
  };
  static constexpr std::uint32_t kMax = 24;
  std::uint32_t count = 0;
  std::array<Answer, kMax> list;

  bool add(const Answer& answer) {
    if (count == kMax) return false;
    list[count++] = answer;
    return true;
  }
  std::span<const Answer> all() const { return {list.data(), count}; }
};

// An AGV that announces a zone, and the newest message that is known of it: those of a boot are ordered by stamps.
struct RollEntry {
  std::uint32_t agv, boot, stamp_ms;
  friend bool operator==(const RollEntry&, const RollEntry&) = default;
};
// Of the messages of one AGV.
constexpr bool is_older(const RollEntry& a, const RollEntry& b) {
  return a.boot < b.boot || (a.boot == b.boot && a.stamp_ms < b.stamp_ms);
}

// Of some zones, by ascending number of the AGVs from `from` on.
struct Roll {
  static constexpr std::uint32_t kMax = 64;
  std::uint32_t stamp_ms = 0;  // of the message of the applicant that is known
  std::uint32_t from = 0;
  std::uint32_t next = 0;  // the rest begins with this AGV; FP_NONE: there is no more
  std::uint32_t count = 0;
  std::array<RollEntry, kMax> list;
  std::span<const RollEntry> all() const { return {list.data(), count}; }
};

struct Message {
  Message() {}  // leaves the lists as they are: setting them to zero would cost more than reading a message

  MessageKind kind = MessageKind::State;
  Status status;
  // Of a message that was read: it says the same as a message before about its ways and zones, and these are not filled
  // in; otherwise their bytes, as long as those of the message last.
  bool repeats_way = false;
  std::span<const std::byte> way_bytes;
  // State, if the status says that a request is open, and Request
  std::int64_t demand_ns = 0;  // since when the sender has wanted to go on
  Path request;                // the path to lock, from the end of the held path. Its epoch is status.epoch
  Asked asked;
  HeardFrom heard;  // in a message to one AGV: only of that one
  // State
  Answers answers;
  // Grant, Defer
  Epoch echo = 0;  // the epoch of the answered request
  // In a fleet that is divided into zones: those that the sender announces; whether it waits for an acknowledgement.
  bool tells_zones = false, wants_answer = false;
  ZoneSet zones;
  // Join, Roll
  ZoneSet about;  // the zones whose roll is asked for or shown
  Roll roll;      // in a Join, only where it begins

  bool has_request() const { return kind == MessageKind::Request || (kind == MessageKind::State && status.requesting); }
};

// A message as bytes: little-endian fields of fixed size. The boot of an epoch is written only if it is not the first.
// Requires: stations and lanes have numbers below 65 536.
class WireMessage {
 public:
  explicit WireMessage(const Message& message);
  std::span<const std::byte> bytes() const { return {bytes_.data(), size_}; }

 private:
  template <class Value>
  void put(std::uint64_t value);
  template <class Value>
  void put_row(std::span<const Value> values);
  void put_epoch(Epoch epoch);
  void put_path(const Path& path);
  void put_lanes(const Path& path);
  void put_heard(const HeardFrom& heard);
  void put_request(const Message& message);
  void put_answers(const Answers& answers);
  void put_zones(const ZoneSet& zones);
  void put_roll(const Roll& roll);

  std::array<std::byte, 1024> bytes_;
  std::size_t size_ = 0;
};

// The message, if the bytes are exactly one message. The caller must check that the paths exist on its map. What it
// repeats of `known` is not filled in.
std::optional<Message> decode(std::span<const std::byte> bytes, const WayBytes& known = {});

}  // namespace fleetproof::agents
