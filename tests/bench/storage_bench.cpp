// What it costs to store a run, commits included. The aim is at most 6 microseconds.
#include <benchmark/benchmark.h>

#include "storage/archive_writer.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kCells = 6;  // of samples::cells()

// As a campaign stores it: three probes, four running digests, and in one run of five a violation.
RunRecord usual_run(std::uint64_t index) {
  RunRecord run;
  run.run_index = index;
  run.cell = static_cast<std::uint32_t>(index % kCells);
  run.replicate = index / kCells;
  run.scenario_digest = index * 0x9e3779b97f4a7c15ULL;
  Outcome& o = run.outcome;
  o.simulated_ns = 60'000'000'000;
  o.agv_count = 5;
  o.digest = ~run.scenario_digest;
  o.running_digests = {o.digest, o.digest + 1, o.digest + 2, o.digest + 3};
  std::uint64_t value = index;
  for (const auto& counter : kCounters) o.counters.*counter.member = value += 100;
  o.probes = {
      {ProbeSource::World, "crossing", 4}, {ProbeSource::World, "head-on", 2}, {ProbeSource::Agent, "negotiation", 30}};
  o.violation = index % 5 == 0;
  if (o.violation) o.violations.emplace_back();
  return run;
}

void store(benchmark::State& state) {
  constexpr std::uint64_t kDifferent = 6000;
  std::vector<RunRecord> runs;
  for (std::uint64_t i = 0; i < kDifferent; ++i) runs.push_back(usual_run(i));
  const samples::TemporaryFolder folder;
  ArchiveWriter writer(folder / "a.fp", samples::campaign(), samples::cells(), samples::gates());
  std::uint64_t index = 0;
  for (auto _ : state) {
    RunRecord& run = runs[index % kDifferent];
    run.run_index = index;
    run.replicate = index / kCells;
    writer.add(run);
    ++index;
  }
  state.counters["rows/s"] = benchmark::Counter(static_cast<double>(index), benchmark::Counter::kIsRate);
}

BENCHMARK(store)->Unit(benchmark::kMicrosecond)->Iterations(200'000)->UseRealTime();

}  // namespace
}  // namespace fleetproof
