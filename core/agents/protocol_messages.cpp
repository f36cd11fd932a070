#include "core/agents/protocol_messages.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace fleetproof::agents {
namespace {

constexpr std::uint64_t kMark = 0xA6;  // first byte of all our messages
constexpr double kPerMetre = 1000.0;   // positions travel as millimetres
constexpr double kPerUnit = 32767.0;   // headings as 15-bit fractions

constexpr std::uint64_t kRequesting = 1, kWaiting = 2, kIdle = 4, kOutOfOrder = 8, kBlocked = 16;  // bits of the flags
constexpr std::uint64_t kEpochHasBoot = 32, kEchoHasBoot = 64, kPositionIsNew = 128;
constexpr std::uint64_t kGranted = 1;  // of an answer; beside kEchoHasBoot
// Beside the kind.
constexpr std::uint64_t kTellsZones = 0x80, kWantsAnswer = 0x40, kPlaceUnknown = 0x20, kHeldUp = 0x10;
constexpr std::uint64_t kKindBits = 0x0f;
constexpr std::uint32_t kNobody = 0xffff;

std::uint64_t flags_of(const Message& message) {
  const Status& s = message.status;
  return (s.requesting ? kRequesting : 0U) | (s.waiting ? kWaiting : 0U) | (s.idle ? kIdle : 0U) |
         (s.out_of_order ? kOutOfOrder : 0U) | (s.blocked ? kBlocked : 0U) | (s.position_is_new ? kPositionIsNew : 0U) |
         (boot_of(s.epoch) > 0 ? kEpochHasBoot : 0U) | (boot_of(message.echo) > 0 ? kEchoHasBoot : 0U);
}

// Two's complement. A value that does not fit becomes the largest or smallest value that fits.
std::uint64_t rounded(double value) {
  return static_cast<std::uint64_t>(
      static_cast<std::int64_t>(std::floor(std::fmin(std::fmax(value, -2e9), 2e9) + 0.5)));
}

// To or from the byte order of the wire.
template <class Value>
Value little_endian(Value value) {
  if constexpr (std::endian::native == std::endian::big) {
    auto* const bytes = reinterpret_cast<std::byte*>(&value);
    std::reverse(bytes, bytes + sizeof(Value));
  }
  return value;
}

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const WayBytes& known) : rest_(bytes), known_(known) {}

  // False if these are not the bytes of a message.
  bool read(Message& message) {
    const std::span<const std::byte> begin = take_bytes(kConditionAt + kConditionBytes);
    if (begin.empty() || value_at<std::uint8_t>(begin, 0) != kMark) return false;
    const std::uint64_t kind = value_at<std::uint8_t>(begin, 1);
    message.kind = static_cast<MessageKind>(kind & kKindBits);
    message.wants_answer = (kind & kWantsAnswer) != 0;
    message.tells_zones = (kind & kTellsZones) != 0;
    message.status.place_unknown = (kind & kPlaceUnknown) != 0;
    message.status.held_up = (kind & kHeldUp) != 0;
    const std::uint64_t flags = read_condition(begin.subspan(kConditionAt), message.status);
    take_way(message);
    take_heard(message.heard);
    switch (message.kind) {
      case MessageKind::State:
        take_answers(message.answers);
        if (message.status.requesting) take_request(message);
        return complete();
      case MessageKind::Request:
        take_request(message);
        return complete();
      case MessageKind::Grant:
      case MessageKind::Defer:
        message.echo = take_epoch((flags & kEchoHasBoot) != 0);
        return complete();
      case MessageKind::Join:
        take_zones(message.about);
        message.roll.from = take<std::uint16_t>();
        return complete();
      case MessageKind::Roll:
        take_zones(message.about);
        take_roll(message.roll);
        return complete();
    }
    return false;
  }

 private:
  static constexpr std::size_t kEntryBytes = sizeof(std::uint16_t) + sizeof(std::uint8_t);  // of Asked
  // Each message begins with mark and kind, then stamp, position, flags and the number of the epoch.
  static constexpr std::size_t kConditionAt = 2, kConditionBytes = 17;

  template <class Value>
  static Value value_at(std::span<const std::byte> row, std::size_t at) {
    Value value;
    std::memcpy(&value, row.data() + at, sizeof(Value));
    return little_endian(value);
  }

  std::uint64_t read_condition(std::span<const std::byte> bytes, Condition& status) {
    status.stamp_ms = value_at<std::uint32_t>(bytes, 0);
    status.position_m = {metres_at(bytes, 4), metres_at(bytes, 8)};
    const std::uint64_t flags = value_at<std::uint8_t>(bytes, 12);
    status.requesting = (flags & kRequesting) != 0;
    status.waiting = (flags & kWaiting) != 0;
    status.idle = (flags & kIdle) != 0;
    status.out_of_order = (flags & kOutOfOrder) != 0;
    status.blocked = (flags & kBlocked) != 0;
    status.position_is_new = (flags & kPositionIsNew) != 0;
    status.epoch = value_at<std::uint32_t>(bytes, 13);
    if ((flags & kEpochHasBoot) != 0) status.epoch |= first_epoch(take<std::uint32_t>());
    return flags;
  }

  void take_way(Message& message) {
    message.repeats_way = known_.begin(rest_, message.tells_zones);
    if (message.repeats_way) {
      rest_ = rest_.subspan(known_.size);
      return;
    }
    const std::span<const std::byte> way = rest_;
    take_path(message.status.held);
    take_lanes(message.status.ahead, kPathLanesMax - message.status.held.count);
    if (message.tells_zones) take_zones(message.zones);
    message.way_bytes = way.first(way.size() - rest_.size());
  }

  template <class Value>
  Value take() {
    Value value{};
    if (rest_.size() < sizeof(Value)) {
      failed_ = true;
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof(Value));
    rest_ = rest_.subspan(sizeof(Value));
    return little_endian(value);
  }
  // Many values at once: the length is looked at only once.
  template <class Value>
  void take_row(Value* to, std::size_t count) {
    const std::span<const std::byte> row = take_bytes(count * sizeof(Value));
    if constexpr (std::endian::native == std::endian::little) {
      if (!row.empty()) std::memcpy(to, row.data(), row.size());
    } else {
      for (std::size_t at = 0; at < row.size(); at += sizeof(Value)) *to++ = value_at<Value>(row, at);
    }
  }
  // Empty if there are not so many.
  std::span<const std::byte> take_bytes(std::size_t count) {
    if (rest_.size() < count) {
      failed_ = true;
      return {};
    }
    const std::span<const std::byte> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  Epoch take_epoch(bool has_boot) {
    const auto number = take<std::uint32_t>();
    return has_boot ? first_epoch(take<std::uint32_t>()) | number : number;
  }
  static double metres_at(std::span<const std::byte> bytes, std::size_t at) {
    return static_cast<std::int32_t>(value_at<std::uint32_t>(bytes, at)) / kPerMetre;
  }
  double take_fraction() { return static_cast<std::int16_t>(take<std::uint16_t>()) / kPerUnit; }

  void take_path(Path& path) {
    path.station = take<std::uint16_t>();
    const double x = take_fraction(), y = take_fraction();
    const Vec heading{x, y};
    const double norm = length(heading);
    if (!(norm > 0.99 && norm < 1.01)) return fail();
    path.heading = heading * (1.0 / norm);
    take_lanes(path, kPathLanesMax);
  }

  void take_lanes(Path& path, std::uint32_t most) {
    const std::uint32_t count = take<std::uint8_t>();
    if (count > most) return fail();
    take_row(path.lane_ids.data(), count);
    path.count = failed_ ? 0 : count;
  }

  void take_heard(HeardFrom& heard) {
    heard.first = take<std::uint16_t>();
    heard.count = take<std::uint8_t>();
    if (heard.count > HeardFrom::kMax) return fail();
    take_row(heard.stamps_ms.data(), heard.count);
  }

  void take_request(Message& message) {
    message.demand_ns = static_cast<std::int64_t>(take<std::uint64_t>());
    take_path(message.request);
    const std::uint32_t count = take<std::uint8_t>(), unanswered = take<std::uint8_t>();
    if (count > Asked::kMax || unanswered > count) return fail();
    const std::span<const std::byte> row = take_bytes(count * kEntryBytes);
    for (std::size_t at = 0; at < row.size(); at += kEntryBytes) {
      const std::uint32_t attempt = std::to_integer<std::uint8_t>(row[at + sizeof(std::uint16_t)]);
      message.asked.list[at / kEntryBytes] = {value_at<std::uint16_t>(row, at), attempt};
    }
    message.asked.count = failed_ ? 0 : count;
    message.asked.unanswered = failed_ ? 0 : unanswered;
  }

  void take_answers(Answers& answers) {
    const std::uint64_t count = take<std::uint8_t>();
    if (count > Answers::kMax) return fail();
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto agv = take<std::uint16_t>();
      const std::uint64_t flags = take<std::uint8_t>();
      answers.add({agv, take_epoch((flags & kEchoHasBoot) != 0), (flags & kGranted) != 0});
    }
  }

  void take_zones(ZoneSet& zones) {
    const std::uint32_t count = take<std::uint8_t>();
    if (count > ZoneSet::kMax) return fail();
    const std::span<const std::byte> row = take_bytes(count * sizeof(std::uint16_t));
    for (std::size_t at = 0; at < row.size(); at += sizeof(std::uint16_t)) zones.add(value_at<std::uint16_t>(row, at));
  }

  void take_roll(Roll& roll) {
    roll.stamp_ms = take<std::uint32_t>();
    roll.from = take<std::uint16_t>();
    roll.next = take_number();
    const std::uint32_t count = take<std::uint8_t>();
    if (count > Roll::kMax) return fail();
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t agv = take<std::uint16_t>(), boot = take<std::uint32_t>();
      roll.list[i] = {agv, boot, take<std::uint32_t>()};
    }
    roll.count = failed_ ? 0 : count;
  }

  // Of an AGV, or FP_NONE.
  std::uint32_t take_number() {
    const std::uint32_t number = take<std::uint16_t>();
    return number == kNobody ? FP_NONE : number;
  }

  void fail() { failed_ = true; }
  bool complete() const { return !failed_ && rest_.empty(); }

  std::span<const std::byte> rest_;
  const WayBytes& known_;
  bool failed_ = false;
};

}  // namespace

template <class Value>
void WireMessage::put(std::uint64_t value) {
  const Value little = little_endian(static_cast<Value>(value));
  std::memcpy(bytes_.data() + size_, &little, sizeof(Value));
  size_ += sizeof(Value);
}

// Many values at once.
template <class Value>
void WireMessage::put_row(std::span<const Value> values) {
  std::byte* to = bytes_.data() + size_;
  if constexpr (std::endian::native == std::endian::little) {
    if (!values.empty()) std::memcpy(to, values.data(), values.size_bytes());
  } else {
    for (const Value value : values) {
      const Value little = little_endian(value);
      std::memcpy(to, &little, sizeof(Value));
      to += sizeof(Value);
    }
  }
  size_ += values.size_bytes();
}

// The longest message: a STATE with an open request, in a fleet that is not divided. A message that tells zones has no
// room for answers.
constexpr std::size_t kHeadBytes = 23, kBytesOfPath = 7, kEpochBytes = 8;
constexpr std::size_t kLongestState = kHeadBytes + (kBytesOfPath + 1 + 2 * std::size_t{kPathLanesMax}) +  // one claim
                                      (3 + 4 * HeardFrom::kMax) + (1 + (3 + kEpochBytes) * Answers::kMax) +
                                      (8 + kBytesOfPath + 2 * std::size_t{kPathLanesMax} + 2 + 3 * Asked::kMax);
static_assert(kLongestState <= 1024);

WireMessage::WireMessage(const Message& message) {
  const Status& status = message.status;
  put<std::uint8_t>(kMark);
  put<std::uint8_t>(static_cast<std::uint64_t>(message.kind) | (message.tells_zones ? kTellsZones : 0U) |
                    (message.wants_answer ? kWantsAnswer : 0U) | (status.place_unknown ? kPlaceUnknown : 0U) |
                    (status.held_up ? kHeldUp : 0U));
  put<std::uint32_t>(status.stamp_ms);
  put<std::uint32_t>(rounded(status.position_m.x * kPerMetre));
  put<std::uint32_t>(rounded(status.position_m.y * kPerMetre));
  put<std::uint8_t>(flags_of(message));
  put_epoch(status.epoch);
  put_path(status.held);
  put_lanes(status.ahead);
  if (message.tells_zones) put_zones(message.zones);
  put_heard(message.heard);
  switch (message.kind) {
    case MessageKind::State:
      put_answers(message.answers);
      if (status.requesting) put_request(message);
      break;
    case MessageKind::Request:
      put_request(message);
      break;
    case MessageKind::Grant:
    case MessageKind::Defer:
      put_epoch(message.echo);
      break;
    case MessageKind::Join:
      put_zones(message.about);
      put<std::uint16_t>(message.roll.from);
      break;
    case MessageKind::Roll:
      put_zones(message.about);
      put_roll(message.roll);
      break;
  }
}

void WireMessage::put_request(const Message& message) {
  put<std::uint64_t>(static_cast<std::uint64_t>(message.demand_ns));
  put_path(message.request);
  put<std::uint8_t>(message.asked.count);
  put<std::uint8_t>(message.asked.unanswered);
  for (const Asked::Entry& entry : message.asked.all()) {
    put<std::uint16_t>(entry.agv);
    put<std::uint8_t>(entry.attempt);
  }
}

void WireMessage::put_answers(const Answers& answers) {
  put<std::uint8_t>(answers.count);
  for (const Answers::Answer& answer : answers.all()) {
    put<std::uint16_t>(answer.agv);
    put<std::uint8_t>((answer.granted ? kGranted : 0U) | (boot_of(answer.echo) > 0 ? kEchoHasBoot : 0U));
    put_epoch(answer.echo);
  }
}

void WireMessage::put_zones(const ZoneSet& zones) {
  put<std::uint8_t>(zones.size());
  put_row(zones.all());
}

void WireMessage::put_roll(const Roll& roll) {
  put<std::uint32_t>(roll.stamp_ms);
  put<std::uint16_t>(roll.from);
  put<std::uint16_t>(roll.next == FP_NONE ? kNobody : roll.next);
  put<std::uint8_t>(roll.count);
  for (const RollEntry& entry : roll.all()) {
    put<std::uint16_t>(entry.agv);
    put<std::uint32_t>(entry.boot);
    put<std::uint32_t>(entry.stamp_ms);
  }
}

void WireMessage::put_epoch(Epoch epoch) {
  put<std::uint32_t>(number_of(epoch));
  if (boot_of(epoch) > 0) put<std::uint32_t>(boot_of(epoch));
}

void WireMessage::put_path(const Path& path) {
  put<std::uint16_t>(path.station);
  put<std::uint16_t>(rounded(path.heading.x * kPerUnit));
  put<std::uint16_t>(rounded(path.heading.y * kPerUnit));
  put_lanes(path);
}

void WireMessage::put_lanes(const Path& path) {
  put<std::uint8_t>(path.count);
  put_row(path.lanes());
}

void WireMessage::put_heard(const HeardFrom& heard) {
  put<std::uint16_t>(heard.first);
  put<std::uint8_t>(heard.count);
  put_row(std::span<const std::uint32_t>(heard.stamps_ms.data(), heard.count));
}

std::optional<Message> decode(std::span<const std::byte> bytes, const WayBytes& known) {
  std::optional<Message> decoded(std::in_place);  // the only one that is returned, so that nothing is copied
  if (!Reader(bytes, known).read(*decoded)) decoded.reset();
  return decoded;
}

}  // namespace fleetproof::agents
