#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "storage/archive_writer.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::samples {

// Runs with everything that a report counts, drawn with a fixed seed. `trouble`: the share of runs in which something
// went wrong.
class DrawnRuns {
 public:
  explicit DrawnRuns(double trouble) : trouble_(trouble) {}

  RunRecord operator()(std::uint64_t index, const std::vector<CellRecord>& cells) {
    RunRecord run;
    run.run_index = index;
    run.cell = static_cast<std::uint32_t>(index % cells.size());
    run.replicate = index / cells.size();
    run.factors = cells[run.cell].lowest;
    Outcome& outcome = run.outcome;
    outcome.digest = below(trouble_ > 0.5 ? 3 : 1'000'000'000);
    outcome.agv_count = cells[run.cell].fleet_size;
    outcome.simulated_ns = 600'000'000'000 - below(1000) * 1'234'567;
    outcome.counters.transports_done = below(12);
    outcome.counters.safe_mode_ns = below(3) == 0 ? below(1'000'000'000'000) : 0;
    if (below(20) == 0) outcome.min_clearance_um = static_cast<std::int64_t>(below(400'000)) + 99'990;
    std::vector<ProbeCount> probes;
    for (const char* name : {"crossing", "following", "near-miss"}) {
      if (below(3) > 0) probes.push_back({ProbeSource::World, name, below(9) + 1});
    }
    if (below(2) == 0) probes.push_back({ProbeSource::Agent, "negotiation", below(50) + 1});
    file_probes(outcome, probes);
    if (chance(trouble_)) spoil(outcome);
    return run;
  }

 private:
  std::uint64_t below(std::uint64_t limit) { return random_() % limit; }
  bool chance(double share) { return static_cast<double>(random_()) < share * 18446744073709551615.0; }

  void spoil(Outcome& outcome) {
    const auto what = below(10);
    if (what < 4) file_violations(outcome, violations(outcome));
    if (what == 4) outcome.crash = true;
    if (what == 5) outcome.hang = true;
    if (what == 6) outcome.indeterminate = true;
    if (what == 7) outcome.stuck = true;
    if (outcome.crash || outcome.hang) outcome.message = "agent of AGV 1 stopped";
    if (what == 3 || what == 8 || what == 9) add_incidents(outcome);
  }
  std::vector<Violation> violations(const Outcome& outcome) {
    std::vector<Violation> list(1 + below(3));
    std::int64_t first_ns = 0;
    for (Violation& violation : list) {
      first_ns += static_cast<std::int64_t>(below(90'000'000'000));
      violation.a = EntityId{static_cast<std::uint32_t>(below(2))};
      violation.b = EntityId{static_cast<std::uint32_t>(2 + below(outcome.agv_count))};  // the last is an obstacle
      violation.first = at_ns(first_ns);
      violation.last = violation.closest_at = at_ns(first_ns + static_cast<std::int64_t>(below(1'000'000'000)));
      violation.contact = below(3) == 0;
      violation.min_clearance_um = violation.contact ? 0 : static_cast<std::int64_t>(below(99'998));
      violation.relative_speed_um_s = static_cast<std::int64_t>(below(900'000));
    }
    return list;
  }
  void add_incidents(Outcome& outcome) {
    std::vector<Incident> list(1 + below(3));
    for (Incident& incident : list) {
      incident.kind = static_cast<IncidentKind>(1 + below(17));
      incident.first = incident.last = at_ns(static_cast<std::int64_t>(below(200'000'000'000)));
      if (below(2) == 0) incident.a = EntityId{static_cast<std::uint32_t>(below(2))};
      if (below(2) == 0) incident.b = EntityId{static_cast<std::uint32_t>(2 + below(3))};
    }
    std::ranges::sort(list, {}, [](const Incident& i) { return std::tuple(i.first, i.kind, i.a, i.b); });
    file_incidents(outcome, list);
  }

  double trouble_;
  std::mt19937_64 random_{20'05};
};

// Gates on every end point, of every unit, region and method.
inline std::vector<GateRecord> gates_of_every_kind(const std::string& agent, const std::string& layout) {
  std::vector<GateRecord> gates;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(EndPoint::Throughput); ++i) {
    GateRecord gate = gate_of(agent, i % 4 == 0 ? GateKind::None : GateKind::Rate,
                              std::array{Region::Contract, Region::All, Region::WorstCase}.at(i % 3), 0.02);
    gate.end_point = static_cast<EndPoint>(i);
    gate.method = i % 2 == 0 ? GateMethod::AnyTime : GateMethod::Fixed;
    gate.unit = std::array{GateUnit::World, GateUnit::World, GateUnit::Run, GateUnit::AgvHour}.at(i % 4);
    if (gate.end_point == EndPoint::Throughput) gate.unit = GateUnit::World;
    gate.name = "gate " + std::to_string(i);
    gate.requirement = i % 5 == 0 ? "SR-" + std::to_string(i) : "";
    gate.where.layout = i % 5 == 3 ? layout : "";
    gate.confidence = i % 3 == 1 ? 0.99 : 0.95;
    gate.index = static_cast<std::uint32_t>(i);
    gates.push_back(gate);
  }
  return gates;
}

// Of the plan, reports read no more than the length of a run.
inline CampaignRecord with_length(CampaignRecord campaign) {
  campaign.plan_json = R"({"horizon_s": 600.0})";
  return campaign;
}

inline void write_archive(const std::string& path, const CampaignRecord& campaign, const std::vector<CellRecord>& cells,
                          const std::vector<GateRecord>& gates, std::uint64_t runs, double trouble) {
  ArchiveWriter writer(path, {with_length(campaign), cells, gates});
  DrawnRuns drawn(trouble);
  for (std::uint64_t i = 0; i < runs; ++i) writer.add(drawn(i, cells));
  writer.publish(runs);
}

}  // namespace fleetproof::samples
