#include "core/agents/protocol_messages.hpp"

#include <cmath>

namespace fleetproof::agents {
namespace {

constexpr std::uint64_t kMark = 0xA6;  // first byte of all our messages
constexpr double kPerMetre = 1000.0;   // positions travel as millimetres
constexpr double kPerUnit = 32767.0;   // headings as 15-bit fractions

constexpr std::uint64_t kRequesting = 1, kWaiting = 2, kIdle = 4, kOutOfOrder = 8, kBlocked = 16;  // bits of the flags
constexpr std::uint64_t kEpochHasBoot = 32, kEchoHasBoot = 64;

std::uint64_t flags_of(const Message& message) {
  const Status& s = message.status;
  return (s.requesting ? kRequesting : 0U) | (s.waiting ? kWaiting : 0U) | (s.idle ? kIdle : 0U) |
         (s.out_of_order ? kOutOfOrder : 0U) | (s.blocked ? kBlocked : 0U) |
         (boot_of(s.epoch) > 0 ? kEpochHasBoot : 0U) | (boot_of(message.echo) > 0 ? kEchoHasBoot : 0U);
}

// Two's complement. A value that does not fit becomes the largest or smallest value that fits.
std::uint64_t rounded(double value) {
  return static_cast<std::uint64_t>(
      static_cast<std::int64_t>(std::floor(std::fmin(std::fmax(value, -2e9), 2e9) + 0.5)));
}

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::uint64_t take(std::uint32_t size) {
    if (rest_.size() < size) {
      failed_ = true;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::uint32_t i = 0; i < size; ++i) value |= std::to_integer<std::uint64_t>(rest_[i]) << (8 * i);
    rest_ = rest_.subspan(size);
    return value;
  }
  std::uint32_t take32() { return static_cast<std::uint32_t>(take(4)); }
  Epoch take_epoch(bool has_boot) {
    const std::uint32_t number = take32();
    return has_boot ? first_epoch(take32()) | number : number;
  }
  double take_metres() { return static_cast<std::int32_t>(take32()) / kPerMetre; }
  double take_fraction() { return static_cast<std::int16_t>(take(2)) / kPerUnit; }

  void take_path(Path& path) {
    path.station = static_cast<std::uint32_t>(take(2));
    const double x = take_fraction(), y = take_fraction();
    const Vec heading{x, y};
    const double norm = length(heading);
    if (!(norm > 0.99 && norm < 1.01)) return fail();
    path.heading = heading * (1.0 / norm);
    const std::uint64_t count = take(1);
    if (count > kPathLanesMax) return fail();
    for (std::uint64_t i = 0; i < count; ++i) path.append(static_cast<std::uint32_t>(take(2)));
  }

  void take_heard(HeardFrom& heard) {
    heard.first = static_cast<std::uint32_t>(take(2));
    heard.count = static_cast<std::uint32_t>(take(1));
    if (heard.count > HeardFrom::kMax) return fail();
    for (std::uint32_t i = 0; i < heard.count; ++i) heard.stamps_ms[i] = take32();
  }

  void fail() { failed_ = true; }
  bool complete() const { return !failed_ && rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
  bool failed_ = false;
};

}  // namespace

WireMessage::WireMessage(const Message& message) {
  const Status& status = message.status;
  put(kMark, 1);
  put(static_cast<std::uint64_t>(message.kind), 1);
  put(status.stamp_ms, 4);
  put(rounded(status.position_m.x * kPerMetre), 4);
  put(rounded(status.position_m.y * kPerMetre), 4);
  put(flags_of(message), 1);
  put_epoch(status.epoch);
  put_path(status.held);
  switch (message.kind) {
    case MessageKind::State:
      put(message.heard.first, 2);
      put(message.heard.count, 1);
      for (std::uint32_t i = 0; i < message.heard.count; ++i) put(message.heard.stamps_ms[i], 4);
      break;
    case MessageKind::Request:
      put(static_cast<std::uint64_t>(message.demand_ns), 8);
      put_path(message.request);
      break;
    case MessageKind::Grant:
    case MessageKind::Defer:
      put_epoch(message.echo);
      break;
  }
}

void WireMessage::put(std::uint64_t value, std::uint32_t size) {
  for (std::uint32_t i = 0; i < size; ++i) bytes_[size_++] = static_cast<std::byte>(value >> (8 * i));
}

void WireMessage::put_epoch(Epoch epoch) {
  put(number_of(epoch), 4);
  if (boot_of(epoch) > 0) put(boot_of(epoch), 4);
}

void WireMessage::put_path(const Path& path) {
  put(path.station, 2);
  put(rounded(path.heading.x * kPerUnit), 2);
  put(rounded(path.heading.y * kPerUnit), 2);
  put(path.count, 1);
  for (const std::uint32_t lane : path.lanes()) put(lane, 2);
}

std::optional<Message> decode(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  std::optional<Message> decoded(std::in_place);
  Message& message = *decoded;
  if (reader.take(1) != kMark) return std::nullopt;
  message.kind = static_cast<MessageKind>(reader.take(1));
  Status& status = message.status;
  status.stamp_ms = reader.take32();
  status.position_m.x = reader.take_metres();
  status.position_m.y = reader.take_metres();
  const std::uint64_t flags = reader.take(1);
  status.requesting = (flags & kRequesting) != 0;
  status.waiting = (flags & kWaiting) != 0;
  status.idle = (flags & kIdle) != 0;
  status.out_of_order = (flags & kOutOfOrder) != 0;
  status.blocked = (flags & kBlocked) != 0;
  status.epoch = reader.take_epoch((flags & kEpochHasBoot) != 0);
  reader.take_path(status.held);
  switch (message.kind) {
    case MessageKind::State:
      reader.take_heard(message.heard);
      break;
    case MessageKind::Request:
      message.demand_ns = static_cast<std::int64_t>(reader.take(8));
      reader.take_path(message.request);
      break;
    case MessageKind::Grant:
    case MessageKind::Defer:
      message.echo = reader.take_epoch((flags & kEchoHasBoot) != 0);
      break;
    default:
      return std::nullopt;
  }
  if (!reader.complete()) return std::nullopt;
  return decoded;
}

}  // namespace fleetproof::agents
