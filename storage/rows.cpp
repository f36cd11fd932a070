#include "storage/rows.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <array>
#include <bit>
#include <charconv>

#include "core/base/error.hpp"
#include "storage/schema.hpp"

namespace fleetproof {
namespace {

// Fills the parameters of a statement from left to right. Requires: texts and digests live until the statement has run,
// but for temporary texts, which are copied.
class Binder {
 public:
  explicit Binder(SQLite::Statement& statement, int first = 1) : statement_(statement), next_(first) {}

  Binder& operator<<(std::int64_t value) { return statement_.bind(next_++, value), *this; }
  // SQLite has only signed 64-bit integers; the bits stay the same.
  Binder& operator<<(std::uint64_t value) { return *this << std::bit_cast<std::int64_t>(value); }
  Binder& operator<<(std::uint32_t value) { return *this << std::int64_t{value}; }
  Binder& operator<<(bool value) { return *this << std::int64_t{value ? 1 : 0}; }
  Binder& operator<<(double value) { return statement_.bind(next_++, value), *this; }
  Binder& operator<<(const std::string& value) { return statement_.bindNoCopy(next_++, value), *this; }
  Binder& operator<<(std::string&& value) { return statement_.bind(next_++, value), *this; }
  Binder& operator<<(const char* value) { return statement_.bindNoCopy(next_++, value), *this; }
  template <class Value>
  Binder& operator<<(const PerFactor<Value>& factors) {
    for (const Value& value : factors.values) *this << value;
    return *this;
  }
  template <class Value>
  Binder& operator<<(const std::optional<Value>& value) {
    if (value) return *this << *value;
    statement_.bind(next_++);
    return *this;
  }
  // Names that an agent gives are bytes, not text.
  void bytes(const std::string& value) {
    statement_.bindNoCopy(next_++, static_cast<const void*>(value.data()), static_cast<int>(value.size()));
  }
  Binder& operator<<(const std::vector<std::uint64_t>& digests) {
    if constexpr (std::endian::native == std::endian::little) {  // the memory holds what is stored
      if (!digests.empty()) {
        statement_.bindNoCopy(next_++, static_cast<const void*>(digests.data()),
                              static_cast<int>(digests.size() * sizeof(std::uint64_t)));
        return *this;
      }
    }
    std::string bytes;
    for (const auto digest : digests) {
      for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(static_cast<std::uint8_t>(digest >> (8 * i))));
    }
    statement_.bind(next_++, static_cast<const void*>(bytes.data()), static_cast<int>(bytes.size()));
    return *this;
  }

 private:
  SQLite::Statement& statement_;
  int next_;
};

// Takes the columns of a row from left to right.
class Taker {
 public:
  explicit Taker(const SQLite::Statement& row) : row_(row) {}

  std::int64_t i64() { return next().getInt64(); }
  std::uint64_t u64() { return std::bit_cast<std::uint64_t>(i64()); }
  std::uint32_t u32() { return in_range(i64()); }
  bool flag() {
    const auto value = i64();
    if (value != 0 && value != 1) throw EngineError("a row holds a yes-or-no field with neither");
    return value == 1;
  }
  double real() { return next().getDouble(); }
  FactorValues factors() {
    FactorValues factors;
    for (double& value : factors.values) value = real();
    return factors;
  }
  PerFactor<std::optional<double>> named_factors() {
    PerFactor<std::optional<double>> named;
    for (auto& value : named.values) value = maybe_real();
    return named;
  }
  std::string text() { return next().getString(); }
  std::optional<std::int64_t> maybe_i64() {
    const auto column = next();
    if (column.isNull()) return std::nullopt;
    return column.getInt64();
  }
  std::optional<double> maybe_real() {
    const auto column = next();
    return column.isNull() ? std::nullopt : std::optional(column.getDouble());
  }
  std::optional<std::uint32_t> maybe_u32() {
    const auto value = maybe_i64();
    return value ? std::optional(in_range(*value)) : std::nullopt;
  }
  EntityId entity() {
    const auto value = maybe_u32();
    return value ? EntityId{*value} : EntityId{};
  }
  std::vector<std::uint64_t> digests() {
    const auto bytes = next().getString();
    if (bytes.size() % 8 != 0) throw EngineError("a row holds running digests of a broken length");
    std::vector<std::uint64_t> values(bytes.size() / 8);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      values[i / 8] |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * (i % 8));
    return values;
  }

 private:
  static std::uint32_t in_range(std::int64_t value) {
    if (value < 0 || value > 0xffffffffLL) throw EngineError("a row holds a number out of range");
    return static_cast<std::uint32_t>(value);
  }
  SQLite::Column next() { return row_.getColumn(next_++); }
  const SQLite::Statement& row_;
  int next_ = 0;
};

std::optional<std::int64_t> maybe(EntityId id) {
  return id.valid() ? std::optional<std::int64_t>(id.value) : std::nullopt;
}

std::string in_lines(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += word + "\n";
  return text;
}

std::vector<std::string> from_lines(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start < text.size();) {
    const auto end = std::min(text.find('\n', start), text.size());
    words.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return words;
}

// "38 73 103": an assessor reads it with any tool.
std::string numbers_text(const std::vector<std::uint64_t>& numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}

std::vector<std::uint64_t> numbers_of(const std::string& text) {
  std::vector<std::uint64_t> numbers;
  const char* const end = text.data() + text.size();
  for (const char* next = text.data(); next != end;) {
    const auto [stop, error] = std::from_chars(next, end, numbers.emplace_back());
    if (error != std::errc{} || (stop != end && *stop != ' ')) throw EngineError("a gate holds a broken table");
    next = stop == end ? end : stop + 1;
  }
  return numbers;
}

template <HasWords Enum>
Enum word_to(const std::string& word) {
  if (const auto value = value_of<Enum>(word)) return *value;
  throw EngineError(fmt::format("a gate holds the unknown word \"{}\"", word));
}

}  // namespace

void bind_campaign(SQLite::Statement& insert, const CampaignRecord& campaign, std::uint64_t plan_checksum) {
  Binder(insert) << std::uint32_t{1} << campaign.name << campaign.kind << campaign.seed << campaign.replicates
                 << campaign.plan_json << campaign.plan_hash << campaign.engine.version
                 << campaign.engine.program_sha256 << campaign.engine.compiler << campaign.engine.flags
                 << campaign.engine.libraries << in_lines(campaign.required_probes) << campaign.sampling
                 << in_lines(campaign.held_streams) << campaign.held_replicate << campaign.exempt_purposes
                 << campaign.exempt_radius_m << in_lines(campaign.exempt_pairs) << in_lines(campaign.plugin_agents)
                 << plan_checksum << campaign.chunk_runs;
}

void bind_recording(SQLite::Statement& insert, std::uint64_t run_index, const std::string& calls,
                    std::uint64_t checksum) {
  Binder to(insert);
  to << run_index;
  to.bytes(calls);
  to << checksum;
}

void bind_cell(SQLite::Statement& insert, const CellRecord& cell) {
  Binder(insert) << cell.index << cell.agent << cell.layout << cell.fleet_size << cell.lowest << cell.highest;
}

void bind_gate(SQLite::Statement& insert, const GateRecord& gate) {
  Binder(insert) << gate.index << gate.name << gate.agent << name_of(gate.kind) << name_of(gate.end_point)
                 << name_of(gate.region) << gate.limit << gate.confidence << gate.min_transports_per_agv_hour
                 << gate.requirement << gate.where.layout << name_of(gate.unit) << name_of(gate.method) << gate.decides
                 << numbers_text(gate.table.passes_from) << numbers_text(gate.table.refuted_up_to)
                 << gate.where.fleet_size << gate.where.factors;
}

void bind_run(SQLite::Statement& insert, const RunRecord& run, std::uint64_t checksum) {
  const auto& o = run.outcome;
  Binder to(insert);
  to << run.run_index << run.cell << run.replicate << run.scenario_digest << run.factors;
  to << name_of(o.outcome_class());
  to << o.violation << o.contact << o.stuck << o.crash << o.hang << o.indeterminate << o.engine_error;
  to << o.min_clearance_um << o.simulated_ns << o.agv_count << o.digest << o.running_digests << o.message;
  for (const auto& counter : kCounters) to << o.counters.*counter.member;
  to << checksum;
}

void bind_violation(SQLite::Statement& insert, int first, std::uint64_t run_index, std::size_t ordinal,
                    const Violation& v) {
  Binder(insert, first) << run_index << std::uint64_t{ordinal} << v.a.value << v.b.value << to_ns(v.first)
                        << to_ns(v.last) << to_ns(v.closest_at) << v.min_clearance_um << v.relative_speed_um_s
                        << v.normal_speed_um_s << v.x_um << v.y_um << v.contact;
}

void bind_incident(SQLite::Statement& insert, int first, std::uint64_t run_index, std::size_t ordinal,
                   const Incident& i) {
  Binder(insert, first) << run_index << std::uint64_t{ordinal} << static_cast<std::uint32_t>(i.kind) << maybe(i.a)
                        << maybe(i.b) << to_ns(i.first) << to_ns(i.last) << i.value;
}

void bind_probe(SQLite::Statement& insert, int first, std::uint64_t run_index, std::size_t ordinal,
                const ProbeCount& probe) {
  Binder to(insert, first);
  to << run_index << std::uint64_t{ordinal} << static_cast<std::uint32_t>(probe.source);
  to.bytes(probe.name);
  to << probe.count;
}

void bind_audit(SQLite::Statement& insert, const AuditRecord& audit) {
  Binder(insert) << audit.run_index << audit.checksum;
}

void bind_chunk(SQLite::Statement& insert, const ChunkRecord& chunk) {
  Binder(insert) << chunk.chunk << chunk.run_count << chunk.digest;
}

CampaignRecord read_campaign(const SQLite::Statement& row) {
  Taker from(row);
  CampaignRecord campaign;
  from.i64();
  campaign.name = from.text();
  campaign.kind = from.text();
  campaign.seed = from.u64();
  campaign.replicates = from.u64();
  campaign.plan_json = from.text();
  campaign.plan_hash = from.u64();
  campaign.engine.version = from.text();
  campaign.engine.program_sha256 = from.text();
  campaign.engine.compiler = from.text();
  campaign.engine.flags = from.text();
  campaign.engine.libraries = from.text();
  campaign.required_probes = from_lines(from.text());
  campaign.sampling = from.text();
  campaign.held_streams = from_lines(from.text());
  campaign.held_replicate = from.u64();
  campaign.exempt_purposes = from.text();
  campaign.exempt_radius_m = from.real();
  campaign.exempt_pairs = from_lines(from.text());
  campaign.plugin_agents = from_lines(from.text());
  from.u64();  // the checksum of the plan
  campaign.chunk_runs = from.u64();
  return campaign;
}

std::uint64_t read_plan_checksum(const SQLite::Statement& row) {
  return std::bit_cast<std::uint64_t>(row.getColumn("plan_checksum").getInt64());
}

CellRecord read_cell(const SQLite::Statement& row) {
  Taker from(row);
  CellRecord cell;
  cell.index = from.u32();
  cell.agent = from.text();
  cell.layout = from.text();
  cell.fleet_size = from.u32();
  cell.lowest = from.factors();
  cell.highest = from.factors();
  return cell;
}

GateRecord read_gate(const SQLite::Statement& row) {
  Taker from(row);
  GateRecord gate;
  gate.index = from.u32();
  gate.name = from.text();
  gate.agent = from.text();
  gate.kind = word_to<GateKind>(from.text());
  gate.end_point = word_to<EndPoint>(from.text());
  gate.region = word_to<Region>(from.text());
  gate.limit = from.real();
  gate.confidence = from.real();
  gate.min_transports_per_agv_hour = from.real();
  gate.requirement = from.text();
  gate.where.layout = from.text();
  gate.unit = word_to<GateUnit>(from.text());
  gate.method = word_to<GateMethod>(from.text());
  gate.decides = from.flag();
  gate.table.passes_from = numbers_of(from.text());
  gate.table.refuted_up_to = numbers_of(from.text());
  gate.where.fleet_size = from.maybe_u32();
  gate.where.factors = from.named_factors();
  return gate;
}

StoredRun read_run(const SQLite::Statement& row) {
  Taker from(row);
  StoredRun stored;
  auto& run = stored.run;
  auto& o = run.outcome;
  run.run_index = from.u64();
  run.cell = from.u32();
  run.replicate = from.u64();
  run.scenario_digest = from.u64();
  run.factors = from.factors();
  stored.outcome_class = from.text();
  for (const auto flag : {&Outcome::violation, &Outcome::contact, &Outcome::stuck, &Outcome::crash, &Outcome::hang,
                          &Outcome::indeterminate, &Outcome::engine_error}) {
    o.*flag = from.flag();
  }
  o.min_clearance_um = from.maybe_i64();
  o.simulated_ns = from.u64();
  o.agv_count = from.u32();
  o.digest = from.u64();
  o.running_digests = from.digests();
  o.message = from.text();
  for (const auto& counter : kCounters) o.counters.*counter.member = from.u64();
  stored.checksum = from.u64();
  return stored;
}

Violation read_violation(const SQLite::Statement& row) {
  Taker from(row);
  Violation v;
  from.i64();  // run_index
  from.i64();  // ordinal
  v.a = EntityId{from.u32()};
  v.b = EntityId{from.u32()};
  v.first = at_ns(from.i64());
  v.last = at_ns(from.i64());
  v.closest_at = at_ns(from.i64());
  v.min_clearance_um = from.i64();
  v.relative_speed_um_s = from.i64();
  v.normal_speed_um_s = from.i64();
  v.x_um = from.i64();
  v.y_um = from.i64();
  v.contact = from.flag();
  return v;
}

Incident read_incident(const SQLite::Statement& row) {
  Taker from(row);
  Incident incident;
  from.i64();  // run_index
  from.i64();  // ordinal
  const auto kind = from.u32();
  if (!is_incident_kind(kind)) throw EngineError(fmt::format("an incident holds the unknown kind {}", kind));
  incident.kind = static_cast<IncidentKind>(kind);
  incident.a = from.entity();
  incident.b = from.entity();
  incident.first = at_ns(from.i64());
  incident.last = at_ns(from.i64());
  incident.value = from.i64();
  return incident;
}

ProbeCount read_probe(const SQLite::Statement& row) {
  Taker from(row);
  ProbeCount probe;
  from.i64();  // run_index
  from.i64();  // ordinal
  probe.source = from.flag() ? ProbeSource::Agent : ProbeSource::World;
  probe.name = from.text();
  probe.count = from.u64();
  return probe;
}

AuditRecord read_audit(const SQLite::Statement& row) {
  Taker from(row);
  AuditRecord audit;
  audit.run_index = from.u64();
  audit.checksum = from.u64();
  return audit;
}

ChunkRecord read_chunk(const SQLite::Statement& row) {
  Taker from(row);
  ChunkRecord chunk;
  chunk.chunk = from.u64();
  chunk.run_count = from.u64();
  chunk.digest = from.u64();
  return chunk;
}

}  // namespace fleetproof
