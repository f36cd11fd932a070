#include "core/agents/central/messages.hpp"

#include <bit>
#include <cmath>

namespace fleetproof::agents::central {
namespace {

constexpr std::uint32_t kStateMark = 0xB1, kGrantMark = 0xB2, kRecordMark = 0xB3;
constexpr double kUnitLength = 1e-9;  // a heading may be off by so much

// Little-endian fields of fixed size. Writer and Reader have the same calls, so that a message has one list of fields.
class Writer {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (put(values), ...);
  }
  void mark(std::uint32_t mark) { put_bytes(mark, 1); }
  std::vector<std::byte> bytes;

 private:
  void put_bytes(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
  }
  void put(std::uint32_t value) { put_bytes(value, 4); }
  void put(bool value) { put_bytes(value ? 1 : 0, 1); }
  void put(double value) { put_bytes(std::bit_cast<std::uint64_t>(value), 8); }
  void put(Step::Kind kind) { put_bytes(static_cast<std::uint64_t>(kind), 1); }
  template <class Item>
  void put(std::vector<Item>& items) {
    put(static_cast<std::uint32_t>(items.size()));
    for (Item& item : items) fields_of(*this, item);
  }
  template <class Group>
  void put(Group& group) {
    fields_of(*this, group);
  }
};

// Behind the end, or after a value that is not possible, it reads zeros, and `complete` is false.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }
  void mark(std::uint32_t mark) { require(take_bytes(1) == mark); }
  bool complete() const { return possible_ && rest_.empty(); }

 private:
  void require(bool condition) { possible_ = possible_ && condition; }
  std::uint64_t take_bytes(std::size_t count) {
    require(rest_.size() >= count);
    if (!possible_) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::to_integer<std::uint64_t>(rest_[i]) << (8 * i);
    rest_ = rest_.subspan(count);
    return value;
  }
  void take(std::uint32_t& value) { value = static_cast<std::uint32_t>(take_bytes(4)); }
  void take(bool& value) { value = take_bytes(1) != 0; }
  void take(double& value) { value = std::bit_cast<double>(take_bytes(8)); }
  void take(Step::Kind& kind) {
    const std::uint64_t number = take_bytes(1);
    require(number <= static_cast<std::uint64_t>(Step::Kind::Charge));
    if (possible_) kind = static_cast<Step::Kind>(number);
  }
  template <class Item>
  void take(std::vector<Item>& items) {
    std::uint32_t count = 0;
    take(count);
    require(count <= rest_.size());
    items.resize(possible_ ? count : 0);
    for (Item& item : items) fields_of(*this, item);
  }
  template <class Group>
  void take(Group& group) {
    fields_of(*this, group);
  }

  std::span<const std::byte> rest_;
  bool possible_ = true;
};

template <class Io>
void fields_of(Io& io, WayNumber& way) {
  io(way.server_boot, way.agv_boot);
}
template <class Io>
void fields_of(Io& io, Order& order) {
  io(order.id, order.from, order.to);
}
template <class Io>
void fields_of(Io& io, Step& step) {
  io(step.kind, step.what);
}
template <class Io>
void fields_of(Io& io, Goal& goal) {
  io(goal.station, goal.step);
}
template <class Io>
void fields_of(Io& io, State& state) {
  io.mark(kStateMark);
  io(state.way, state.stands, state.station, state.heading.x, state.heading.y, state.load, state.known, state.done);
  io(state.number, state.battery, state.out_of_order, state.has_work, state.first_order, state.orders);
}
template <class Io>
void fields_of(Io& io, Grant& grant) {
  io.mark(kGrantMark);
  io(grant.way, grant.first, grant.steps, grant.orders, grant.has_work);
}
template <class Io>
void fields_of(Io& io, AgvRecord& record) {
  io.mark(kRecordMark);
  io(record.state, record.grant, record.goals, record.charging);
}

template <class Message>
std::vector<std::byte> encoded(Message message) {
  Writer out;
  fields_of(out, message);
  return std::move(out.bytes);
}
template <class Message>
std::optional<Message> decoded(std::span<const std::byte> bytes) {
  Reader in(bytes);
  Message message;
  fields_of(in, message);
  return in.complete() ? std::optional(std::move(message)) : std::nullopt;
}

}  // namespace

std::vector<std::byte> encode(const State& state) { return encoded(state); }
std::vector<std::byte> encode(const Grant& grant) { return encoded(grant); }
std::vector<std::byte> encode(const AgvRecord& record) { return encoded(record); }

std::optional<State> decode_state(std::span<const std::byte> bytes) {
  std::optional<State> state = decoded<State>(bytes);
  const bool is_possible = state && std::abs(length(state->heading) - 1.0) < kUnitLength && state->done <= state->known;
  return is_possible ? state : std::nullopt;
}
std::optional<Grant> decode_grant(std::span<const std::byte> bytes) { return decoded<Grant>(bytes); }
std::optional<AgvRecord> decode_record(std::span<const std::byte> bytes) { return decoded<AgvRecord>(bytes); }

}  // namespace fleetproof::agents::central
