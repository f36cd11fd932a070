#include "core/outcome/outcome.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "core/base/error.hpp"
#include "core/outcome/outcome_bytes.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kViolationBytes = 2 * 4 + 8 * 8 + 1;

void put(ByteSink& sink, const Violation& v, std::uint32_t version) {
  sink.u32(v.a.value);
  sink.u32(v.b.value);
  sink.i64(to_ns(v.first));
  sink.i64(to_ns(v.last));
  sink.i64(to_ns(v.closest_at));
  sink.i64(v.min_clearance_um);
  sink.i64(v.relative_speed_um_s);
  if (version > kEncodingWithoutNormalSpeed) sink.i64(v.normal_speed_um_s);
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
  v.normal_speed_um_s = source.i64();
  v.x_um = source.i64();
  v.y_um = source.i64();
  v.contact = source.flag();
  return v;
}

constexpr std::size_t kIncidentBytes = 3 * 4 + 3 * 8;
constexpr std::size_t kShortestProbeBytes = 1 + 4 + 8;

void put(ByteSink& sink, const Incident& incident) {
  sink.u32(static_cast<std::uint32_t>(incident.kind));
  sink.u32(incident.a.value);
  sink.u32(incident.b.value);
  sink.i64(to_ns(incident.first));
  sink.i64(to_ns(incident.last));
  sink.i64(incident.value);
}

Incident get_incident(ByteSource& source) {
  const auto kind = source.u32();
  if (!is_incident_kind(kind)) source.fail("it holds an incident of no known kind");
  Incident incident;
  incident.kind = static_cast<IncidentKind>(kind);
  incident.a = EntityId{source.u32()};
  incident.b = EntityId{source.u32()};
  incident.first = at_ns(source.i64());
  incident.last = at_ns(source.i64());
  incident.value = source.i64();
  return incident;
}

void put(ByteSink& sink, const ProbeCount& probe) {
  sink.u8(static_cast<std::uint8_t>(probe.source));
  sink.text(probe.name);
  sink.u64(probe.count);
}

ProbeCount get_probe(ByteSource& source) {
  ProbeCount probe;
  probe.source = source.flag() ? ProbeSource::Agent : ProbeSource::World;
  probe.name = source.text();
  probe.count = source.u64();
  return probe;
}

void sort(std::vector<Incident>& incidents) {
  std::ranges::sort(incidents, {},
                    [](const Incident& i) { return std::tuple(i.first, i.kind, i.a, i.b, i.last, i.value); });
}

// The earliest incident of each kind, then the other accusations, then all others. Requires: they are sorted.
std::vector<Incident> weightiest_first(const std::vector<Incident>& sorted) {
  std::set<IncidentKind> met;
  std::array<std::vector<Incident>, 3> by_weight;
  for (const Incident& incident : sorted) {
    const bool is_first = met.insert(incident.kind).second;
    by_weight[is_first ? 0 : accuses(incident.kind) ? 1 : 2].push_back(incident);
  }
  std::vector<Incident> all;
  for (const auto& incidents : by_weight) all.insert(all.end(), incidents.begin(), incidents.end());
  return all;
}

}  // namespace

ViolationLevel level_of(const Violation& violation) {
  if (!violation.contact) return ViolationLevel::SafetyDistance;
  return violation.relative_speed_um_s > kHazardousSpeed_um_s ? ViolationLevel::HazardousContact
                                                              : ViolationLevel::Contact;
}

const char* name_of(ViolationLevel level) {
  switch (level) {
    case ViolationLevel::SafetyDistance:
      return "safety distance broken";
    case ViolationLevel::Contact:
      return "contact";
    case ViolationLevel::HazardousContact:
      return "contact at hazardous speed";
  }
  invariant_violated("a level of violation has a name");
}

const RunEnd* find_run_end(OutcomeClass id) {
  const auto* const found = std::ranges::find(kRunEnds, id, &RunEnd::id);
  return found == kRunEnds.end() ? nullptr : found;
}

OutcomeClass Outcome::outcome_class() const {
  const RunEnd* heaviest = nullptr;
  for (const RunEnd& end : kRunEnds) {
    if (this->*end.flag && (heaviest == nullptr || end.weight > heaviest->weight)) heaviest = &end;
  }
  return heaviest == nullptr ? OutcomeClass::Clean : heaviest->id;
}

bool Outcome::is_failure() const {
  const RunEnd* end = find_run_end(outcome_class());
  return end != nullptr && end->is_failure;
}

std::string encode(const Outcome& outcome, std::uint32_t version) {
  ByteSink sink;
  encode(outcome, sink, version);
  return sink.take();
}

void encode(const Outcome& outcome, ByteSink& sink, std::uint32_t version) {
  sink.u32(version);
  for (const RunEnd& end : kRunEnds) sink.u8(outcome.*end.flag ? 1 : 0);
  sink.u8(outcome.min_clearance_um ? 1 : 0);
  if (outcome.min_clearance_um) sink.i64(*outcome.min_clearance_um);
  std::array<std::uint64_t, kCounters.size()> counters{};
  for (std::size_t i = 0; i < counters.size(); ++i) counters[i] = outcome.counters.*kCounters[i].member;
  sink.u64s(std::span(counters).first(version > kEncodingWithoutWithdrawn          ? counters.size()
                                      : version > kEncodingWithoutProcessorChanges ? kCountersBeforeWithdrawn
                                                                                   : kCountersBeforeProcessor));
  sink.u64(outcome.simulated_ns);
  sink.u32(outcome.agv_count);
  sink.u64(outcome.digest);
  sink.u32(static_cast<std::uint32_t>(outcome.running_digests.size()));
  sink.u64s(outcome.running_digests);
  sink.text(outcome.message);
  sink.u32(static_cast<std::uint32_t>(outcome.violations.size()));
  for (const auto& violation : outcome.violations) put(sink, violation, version);
  sink.u32(static_cast<std::uint32_t>(outcome.incidents.size()));
  for (const auto& incident : outcome.incidents) put(sink, incident);
  sink.u32(static_cast<std::uint32_t>(outcome.probes.size()));
  for (const auto& probe : outcome.probes) put(sink, probe);
}

Outcome decode_outcome(std::string_view bytes) {
  ByteSource source(bytes, "an encoded outcome");
  if (source.u32() != kEncodingVersion)
    throw EngineError("an encoded outcome is of another version, or is no outcome at all");
  Outcome outcome;
  for (const RunEnd& end : kRunEnds) outcome.*end.flag = source.flag();
  if (source.flag()) outcome.min_clearance_um = source.i64();
  for (const auto& counter : kCounters) outcome.counters.*counter.member = source.u64();
  outcome.simulated_ns = source.u64();
  outcome.agv_count = source.u32();
  outcome.digest = source.u64();
  outcome.running_digests.resize(source.count(sizeof(std::uint64_t)));
  for (auto& digest : outcome.running_digests) digest = source.u64();
  outcome.message = source.text();
  const auto violations = source.count(kViolationBytes);
  for (std::size_t i = 0; i < violations; ++i) outcome.violations.push_back(get_violation(source));
  const auto incidents = source.count(kIncidentBytes);
  for (std::size_t i = 0; i < incidents; ++i) outcome.incidents.push_back(get_incident(source));
  const auto probes = source.count(kShortestProbeBytes);
  for (std::size_t i = 0; i < probes; ++i) outcome.probes.push_back(get_probe(source));
  source.end();
  return outcome;
}

void file_violations(Outcome& outcome, std::vector<Violation> violations) {
  std::ranges::sort(violations, {}, [](const Violation& v) { return std::tuple(v.first, v.a, v.b); });
  for (const auto& violation : violations) {
    outcome.violation = true;
    outcome.contact = outcome.contact || violation.contact;
    outcome.min_clearance_um =
        std::min(outcome.min_clearance_um.value_or(violation.min_clearance_um), violation.min_clearance_um);
  }
  outcome.violations = std::move(violations);
}

void file_incidents(Outcome& outcome, std::vector<Incident> incidents) {
  sort(incidents);
  if (incidents.size() > kIncidentsMax) {
    outcome.counters.incidents_left_out += incidents.size() - kIncidentsMax;
    incidents = weightiest_first(incidents);
    incidents.resize(kIncidentsMax);
    sort(incidents);
  }
  outcome.incidents = std::move(incidents);
}

void file_probes(Outcome& outcome, std::vector<ProbeCount> probes) {
  std::erase_if(probes, [](const ProbeCount& probe) { return probe.count == 0; });
  std::ranges::sort(probes, {}, [](const ProbeCount& probe) { return std::tie(probe.source, probe.name); });
  outcome.probes = std::move(probes);
}

}  // namespace fleetproof
