#include "core/agents/central/messages.hpp"

#include <bit>
#include <cmath>

namespace fleetproof::agents::central {
namespace {

constexpr std::uint32_t kStateMark = 0xB1, kGrantMark = 0xB2;  // the first byte of a message
constexpr std::uint32_t kStandsFlag = 1, kOutOfOrderFlag = 2;  // flags of a state
constexpr double kFullBattery = 1e6;                           // as it travels
constexpr double kUnitLength = 1e-9;                           // a heading may be off by so much

// Little-endian fields of fixed size.
class Writer {
 public:
  template <class... Values>
  void put(Values... values) {
    (put_bytes(values, 4), ...);
  }
  void put_byte(std::uint32_t value) { put_bytes(value, 1); }
  void put_double(double value) { put_bytes(std::bit_cast<std::uint64_t>(value), 8); }
  std::vector<std::byte> bytes;

 private:
  void put_bytes(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
  }
};

// Behind the end it reads zeros, and `complete` is false.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class... Values>
  void take(Values&... values) {
    ((values = static_cast<std::uint32_t>(take_bytes(4))), ...);
  }
  std::uint32_t take_byte() { return static_cast<std::uint32_t>(take_bytes(1)); }
  double take_double() { return std::bit_cast<double>(take_bytes(8)); }
  bool complete() const { return enough_ && rest_.empty(); }

 private:
  std::uint64_t take_bytes(std::size_t count) {
    enough_ = enough_ && rest_.size() >= count;
    if (!enough_) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::to_integer<std::uint64_t>(rest_[i]) << (8 * i);
    rest_ = rest_.subspan(count);
    return value;
  }

  std::span<const std::byte> rest_;
  bool enough_ = true;
};

}  // namespace

std::vector<std::byte> encode(const State& state) {
  Writer out;
  out.put_byte(kStateMark);
  out.put_byte((state.stands ? kStandsFlag : 0U) | (state.out_of_order ? kOutOfOrderFlag : 0U));
  out.put(state.way.server_boot, state.way.agv_boot, state.station, state.load, state.known, state.done, state.number);
  out.put_double(state.heading.x);
  out.put_double(state.heading.y);
  out.put(static_cast<std::uint32_t>(state.battery * kFullBattery), state.first_order);
  out.put_byte(static_cast<std::uint32_t>(state.orders.size()));
  for (const Order& order : state.orders) out.put(order.id, order.from, order.to);
  return std::move(out.bytes);
}

std::optional<State> decode_state(std::span<const std::byte> bytes) {
  Reader in(bytes);
  State state;
  if (in.take_byte() != kStateMark) return std::nullopt;
  const std::uint32_t flags = in.take_byte();
  state.stands = (flags & kStandsFlag) != 0;
  state.out_of_order = (flags & kOutOfOrderFlag) != 0;
  in.take(state.way.server_boot, state.way.agv_boot, state.station, state.load, state.known, state.done, state.number);
  state.heading.x = in.take_double();
  state.heading.y = in.take_double();
  std::uint32_t battery = 0;
  in.take(battery, state.first_order);
  state.battery = battery / kFullBattery;
  state.orders.resize(in.take_byte());
  for (Order& order : state.orders) in.take(order.id, order.from, order.to);
  const bool is_unit = std::abs(length(state.heading) - 1.0) < kUnitLength;
  if (!in.complete() || !is_unit || state.done > state.known) return std::nullopt;
  return state;
}

std::vector<std::byte> encode(const Grant& grant) {
  Writer out;
  out.put_byte(kGrantMark);
  out.put(grant.way.server_boot, grant.way.agv_boot, grant.first, grant.orders);
  out.put_byte(static_cast<std::uint32_t>(grant.steps.size()));
  for (const Step& step : grant.steps) {
    out.put_byte(static_cast<std::uint32_t>(step.kind));
    out.put(step.what);
  }
  return std::move(out.bytes);
}

std::optional<Grant> decode_grant(std::span<const std::byte> bytes) {
  Reader in(bytes);
  Grant grant;
  if (in.take_byte() != kGrantMark) return std::nullopt;
  in.take(grant.way.server_boot, grant.way.agv_boot, grant.first, grant.orders);
  grant.steps.resize(in.take_byte());
  for (Step& step : grant.steps) {
    const std::uint32_t kind = in.take_byte();
    if (kind > static_cast<std::uint32_t>(Step::Kind::Charge)) return std::nullopt;
    step.kind = static_cast<Step::Kind>(kind);
    in.take(step.what);
  }
  if (!in.complete()) return std::nullopt;
  return grant;
}

}  // namespace fleetproof::agents::central
