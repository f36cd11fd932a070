#include "core/outcome.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/error.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kEncodingVersion = 2;

// The order of the fields in the encoding. Append only, together with a new version.
constexpr std::array kFlags{&Outcome::violation, &Outcome::contact, &Outcome::stuck, &Outcome::crash, &Outcome::hang, &Outcome::indeterminate, &Outcome::engine_error};
constexpr std::array kCounters{
    &Counters::events,         &Counters::activations,   &Counters::agent_calls,         &Counters::messages_sent,        &Counters::receptions,
    &Counters::receptions_lost, &Counters::out_of_range, &Counters::delay_sum_ns,        &Counters::drives,               &Counters::turns,
    &Counters::refused_calls,  &Counters::transports_released, &Counters::transports_done, &Counters::distance_um,        &Counters::safe_mode_ns,
    &Counters::contacts,       &Counters::distance_evaluations, &Counters::perimeter_checks,
    &Counters::lost_in_outage, &Counters::lost_by_interference, &Counters::duplicates};
static_assert(sizeof(Counters) == kCounters.size() * sizeof(std::uint64_t), "every counter is in the encoding");

class ByteSink {
 public:
  void u8(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
  void u32(std::uint32_t value) { little_endian(value, 4); }
  void u64(std::uint64_t value) { little_endian(value, 8); }
  void i64(std::int64_t value) { u64(std::bit_cast<std::uint64_t>(value)); }
  void text(std::string_view value) {
    u32(static_cast<std::uint32_t>(value.size()));
    bytes_.append(value);
  }
  std::string take() { return std::move(bytes_); }

 private:
  void little_endian(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) u8(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  std::string bytes_;
};

class ByteSource {
 public:
  explicit ByteSource(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(little_endian(4)); }
  std::uint64_t u64() { return little_endian(8); }
  std::int64_t i64() { return std::bit_cast<std::int64_t>(u64()); }
  bool flag() {
    const auto value = u8();
    if (value > 1) throw EngineError("an encoded outcome is damaged: a yes-or-no field holds neither");
    return value == 1;
  }
  // A count of items of `item_bytes` each: checked against what is left, so that damaged bytes cannot ask for terabytes.
  std::size_t count(std::size_t item_bytes) {
    const std::size_t value = u32();
    if (value > bytes_.size() / item_bytes) throw EngineError("an encoded outcome is damaged: it ends too early");
    return value;
  }
  std::string text() {
    const auto length = count(1);
    std::string value(bytes_.substr(0, length));
    bytes_.remove_prefix(length);
    return value;
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::uint64_t little_endian(std::size_t count) {
    if (bytes_.size() < count) throw EngineError("an encoded outcome is damaged: it ends too early");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
    bytes_.remove_prefix(count);
    return value;
  }
  std::string_view bytes_;
};

constexpr std::size_t kViolationBytes = 2 * 4 + 7 * 8 + 1;

void put(ByteSink& sink, const Violation& v) {
  sink.u32(v.a.value);
  sink.u32(v.b.value);
  sink.i64(to_ns(v.first));
  sink.i64(to_ns(v.last));
  sink.i64(to_ns(v.closest_at));
  sink.i64(v.min_clearance_um);
  sink.i64(v.relative_speed_um_s);
  sink.i64(v.x_um);
  sink.i64(v.y_um);
  sink.u8(v.contact ? 1 : 0);
}

Violation get_violation(ByteSource& source) {
  Violation v;
  v.a = EntityId{source.u32()};
  v.b = EntityId{source.u32()};
  v.first = at_ns(source.i64());
  v.last = at_ns(source.i64());
  v.closest_at = at_ns(source.i64());
  v.min_clearance_um = source.i64();
  v.relative_speed_um_s = source.i64();
  v.x_um = source.i64();
  v.y_um = source.i64();
  v.contact = source.flag();
  return v;
}

}  // namespace

const char* name_of(OutcomeClass c) {
  switch (c) {
    case OutcomeClass::EngineError: return "engine_error";
    case OutcomeClass::Contact: return "contact";
    case OutcomeClass::Violation: return "violation";
    case OutcomeClass::Crash: return "crash";
    case OutcomeClass::Hang: return "hang";
    case OutcomeClass::Indeterminate: return "indeterminate";
    case OutcomeClass::Stuck: return "stuck";
    case OutcomeClass::Clean: return "clean";
  }
  invariant_violated("an outcome class has a name");
}

OutcomeClass Outcome::outcome_class() const {
  if (engine_error) return OutcomeClass::EngineError;
  if (contact) return OutcomeClass::Contact;
  if (violation) return OutcomeClass::Violation;
  if (crash) return OutcomeClass::Crash;
  if (hang) return OutcomeClass::Hang;
  if (indeterminate) return OutcomeClass::Indeterminate;
  if (stuck) return OutcomeClass::Stuck;
  return OutcomeClass::Clean;
}

std::string encode(const Outcome& outcome) {
  ByteSink sink;
  sink.u32(kEncodingVersion);
  for (const auto flag : kFlags) sink.u8(outcome.*flag ? 1 : 0);
  sink.u8(outcome.min_clearance_um ? 1 : 0);
  if (outcome.min_clearance_um) sink.i64(*outcome.min_clearance_um);
  for (const auto counter : kCounters) sink.u64(outcome.counters.*counter);
  sink.u64(outcome.simulated_ns);
  sink.u32(outcome.agv_count);
  sink.u64(outcome.digest);
  sink.u32(static_cast<std::uint32_t>(outcome.running_digests.size()));
  for (const auto digest : outcome.running_digests) sink.u64(digest);
  sink.text(outcome.message);
  sink.u32(static_cast<std::uint32_t>(outcome.violations.size()));
  for (const auto& violation : outcome.violations) put(sink, violation);
  return sink.take();
}

Outcome decode_outcome(std::string_view bytes) {
  ByteSource source(bytes);
  if (source.u32() != kEncodingVersion) throw EngineError("an encoded outcome is of another version, or is no outcome at all");
  Outcome outcome;
  for (const auto flag : kFlags) outcome.*flag = source.flag();
  if (source.flag()) outcome.min_clearance_um = source.i64();
  for (const auto counter : kCounters) outcome.counters.*counter = source.u64();
  outcome.simulated_ns = source.u64();
  outcome.agv_count = source.u32();
  outcome.digest = source.u64();
  outcome.running_digests.resize(source.count(sizeof(std::uint64_t)));
  for (auto& digest : outcome.running_digests) digest = source.u64();
  outcome.message = source.text();
  const auto violations = source.count(kViolationBytes);
  for (std::size_t i = 0; i < violations; ++i) outcome.violations.push_back(get_violation(source));
  if (!source.empty()) throw EngineError("an encoded outcome is damaged: bytes follow its end");
  return outcome;
}

void file_violations(Outcome& outcome, std::vector<Violation> violations) {
  std::ranges::sort(violations, {}, [](const Violation& v) { return std::tuple(v.first, v.a, v.b); });
  for (const auto& violation : violations) {
    outcome.violation = true;
    outcome.contact = outcome.contact || violation.contact;
    outcome.min_clearance_um = std::min(outcome.min_clearance_um.value_or(violation.min_clearance_um), violation.min_clearance_um);
  }
  outcome.violations = std::move(violations);
}

}  // namespace fleetproof
