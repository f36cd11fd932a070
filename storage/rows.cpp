#include "storage/rows.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <array>
#include <bit>

#include "core/base/error.hpp"
#include "core/outcome/run_result.hpp"
#include "storage/row_fields.hpp"

namespace fleetproof {
namespace {

std::optional<std::int64_t> maybe(EntityId id) {
  return id.valid() ? std::optional<std::int64_t>(id.value) : std::nullopt;
}

}  // namespace

std::uint64_t unsigned_of(const SQLite::Statement& row, int column) {
  return std::bit_cast<std::uint64_t>(row.getColumn(column).getInt64());
}

void bind_recording(Insert& insert, std::uint64_t run_index, const std::string& calls, std::uint64_t checksum) {
  Binder to(insert);
  to << run_index;
  to.bytes(calls);
  to << checksum;
}

void bind_run(Insert& insert, const RunRecord& run, std::uint64_t checksum) {
  const auto& o = run.outcome;
  Binder to(insert);
  to << run.run_index << run.cell << run.replicate << run.scenario_digest << run.factors;
  to << name_of(o.outcome_class());
  for (const RunEnd& end : kRunEnds) to << o.*end.flag;
  const JudgedOutcome ends = judged(o);
  to << ends.failed << ends.unknown;
  to << o.min_clearance_um << o.simulated_ns << o.agv_count << o.digest << o.running_digests << o.message;
  for (const auto& counter : kCounters) to << o.counters.*counter.member;
  to << checksum;
}

void bind_violation(Insert& insert, int first, const Violation& v) {
  Binder(insert, first) << v.a.value << v.b.value << to_ns(v.first) << to_ns(v.last) << to_ns(v.closest_at)
                        << v.min_clearance_um << v.relative_speed_um_s << v.normal_speed_um_s << v.x_um << v.y_um
                        << v.contact;
}

void bind_incident(Insert& insert, int first, const Incident& i) {
  Binder(insert, first) << static_cast<std::uint32_t>(i.kind) << maybe(i.a) << maybe(i.b) << to_ns(i.first)
                        << to_ns(i.last) << i.value;
}

void bind_probe(Insert& insert, int first, const ProbeCount& probe) {
  Binder to(insert, first);
  to << static_cast<std::uint32_t>(probe.source);
  to.bytes(probe.name);
  to << probe.count;
}

void bind_audit(Insert& insert, const AuditRecord& audit) {
  Binder to(insert);
  to << audit.run_index << audit.checksum;
  const auto put = [&](auto value) { to << (audit.outcome ? std::optional(value(*audit.outcome)) : std::nullopt); };
  put([](const AuditedOutcome& o) { return o.judged.failed; });
  put([](const AuditedOutcome& o) { return o.judged.unknown; });
  for (const auto number : kAuditNumbers) put([&](const AuditedOutcome& o) { return o.*number; });
}

void bind_chunk(Insert& insert, const ChunkRecord& chunk) {
  Binder(insert) << chunk.chunk << chunk.run_count << chunk.digest;
}

void bind_folded(Insert& insert, const FoldedRow& row, std::uint64_t checksum) {
  Binder to(insert);
  to << row.place << row.cell << row.runs << row.transports_done << row.simulated_ns << row.agv_count
     << row.min_clearance_um;
  to.bytes(row.content);
  to << checksum;
}

void read_run(const Row& row, StoredRun& into) {
  Taker from(row);
  auto& run = into.run;
  auto& o = run.outcome;
  run.run_index = from.u64();
  run.cell = from.u32();
  run.replicate = from.u64();
  run.scenario_digest = from.u64();
  run.factors = from.factors();
  from.text(into.outcome_class);
  for (const RunEnd& end : kRunEnds) o.*end.flag = from.flag();
  into.judged.failed = from.u32();
  into.judged.unknown = from.u32();
  o.min_clearance_um = from.maybe_i64();
  o.simulated_ns = from.u64();
  o.agv_count = from.u32();
  o.digest = from.u64();
  from.digests(o.running_digests);
  from.text(o.message);
  std::array<std::int64_t, kCounters.size()> counters{};
  from.numbers(counters);
  for (std::size_t i = 0; i < counters.size(); ++i)
    o.counters.*kCounters[i].member = std::bit_cast<std::uint64_t>(counters[i]);
  into.checksum = from.u64();
}

Violation read_violation(const Row& row) {
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

Incident read_incident(const Row& row) {
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

void read_probe(const Row& row, ProbeCount& into) {
  Taker from(row);
  from.i64();  // run_index
  from.i64();  // ordinal
  into.source = from.flag() ? ProbeSource::Agent : ProbeSource::World;
  from.text(into.name);
  into.count = from.u64();
}

AuditRecord read_audit(const Row& row) {
  Taker from(row);
  AuditRecord audit;
  audit.run_index = from.u64();
  audit.checksum = from.u64();
  const auto failed = from.maybe_u32(), unknown = from.maybe_u32();
  if (!failed || !unknown) return audit;
  AuditedOutcome& outcome = audit.outcome.emplace();
  outcome.judged = {*failed, *unknown};
  for (const auto number : kAuditNumbers) outcome.*number = from.u64();
  return audit;
}

std::pair<FoldedRow, std::uint64_t> read_folded(const Row& row) {
  Taker from(row);
  FoldedRow folded;
  folded.place = from.u64();
  folded.cell = from.u32();
  folded.runs = from.u64();
  folded.transports_done = from.u64();
  folded.simulated_ns = from.u64();
  folded.agv_count = from.u32();
  folded.min_clearance_um = from.maybe_i64();
  folded.content = from.text();
  const std::uint64_t checksum = from.u64();
  return {std::move(folded), checksum};
}

ChunkRecord read_chunk(const Row& row) {
  Taker from(row);
  ChunkRecord chunk;
  chunk.chunk = from.u64();
  chunk.run_count = from.u64();
  chunk.digest = from.u64();
  return chunk;
}

}  // namespace fleetproof
