// What it costs to store a run, commits included, and to read the counters of one from a published file. The aim is at
// most 6 microseconds to store one. CPU time is what counts: the time on the wall contains the waiting for the disk,
// during which a campaign simulates.
#include <SQLiteCpp/Database.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <memory>

#include "campaign/run/run_one.hpp"
#include "storage/archive_writer.hpp"
#include "storage/schema.hpp"
#include "storage/statement.hpp"
#include "storage/table_pages.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof {
namespace {

CampaignPlan plan_of_bench() {
  CampaignPlan plan = test::small_plan();
  plan.replicates = 1'000'000;
  plan.horizon_s = 60.0;
  return plan;
}

// Runs of a campaign, in three agents, two layouts and four radio qualities.
std::vector<RunRecord> simulated_runs(const CampaignPlan& plan) {
  constexpr std::uint64_t kDifferent = 960;
  const AgentPrograms programs;
  const RunOne run_one(plan, programs);
  std::vector<RunRecord> runs;
  for (std::uint64_t i = 0; i < kDifferent; ++i) runs.push_back(run_one(i));
  return runs;
}

// A long row: three probes, and every counter large and different; in one run of five a violation.
std::vector<RunRecord> full_runs(const CampaignPlan&) {
  constexpr std::uint64_t kDifferent = 6000;
  std::vector<RunRecord> runs(kDifferent);
  for (std::uint64_t i = 0; i < kDifferent; ++i) {
    runs[i].scenario_digest = i * 0x9e3779b97f4a7c15ULL;
    Outcome& o = runs[i].outcome;
    o.simulated_ns = 60'000'000'000;
    o.agv_count = 5;
    o.digest = ~runs[i].scenario_digest;
    o.running_digests = {o.digest, o.digest + 1, o.digest + 2, o.digest + 3};
    std::uint64_t value = i;
    for (const auto& counter : kCounters) o.counters.*counter.member = value += 100;
    o.probes = {{ProbeSource::World, "crossing", 4},
                {ProbeSource::World, "head-on", 2},
                {ProbeSource::Agent, "negotiation", 30}};
    o.violation = i % 5 == 0;
    if (o.violation) o.violations.emplace_back();
  }
  return runs;
}

void store(benchmark::State& state, std::vector<RunRecord> (*make_runs)(const CampaignPlan&)) {
  const CampaignPlan plan = plan_of_bench();
  const std::uint64_t cells = plan.cell_count();
  std::vector<RunRecord> runs = make_runs(plan);
  const samples::TemporaryFolder folder;
  ArchiveWriter writer(folder / "a.fp", {samples::campaign(), plan.cells(), plan.gates});
  std::uint64_t index = 0;
  for (auto _ : state) {
    RunRecord& run = runs[index % runs.size()];
    run.run_index = index;
    run.replicate = index / cells;
    run.cell = static_cast<std::uint32_t>(index % cells);
    writer.add(run);
    ++index;
  }
  state.counters["rows/s"] = benchmark::Counter(static_cast<double>(index), benchmark::Counter::kIsRate);
}

constexpr int kRows = 200'000;
BENCHMARK_CAPTURE(store, simulated, simulated_runs)->Unit(benchmark::kMicrosecond)->Iterations(kRows)->UseRealTime();
BENCHMARK_CAPTURE(store, full, full_runs)->Unit(benchmark::kMicrosecond)->Iterations(kRows)->UseRealTime();

// A published file of full runs, its columns, and the place of the first counter among them.
struct Published {
  Published() {
    CampaignPlan plan = plan_of_bench();
    std::vector<RunRecord> runs = full_runs(plan);
    plan.replicates = runs.size() / plan.cell_count();
    ArchiveWriter writer(path, {samples::campaign(), plan.cells(), plan.gates});
    for (std::uint64_t i = 0; i < plan.replicates * plan.cell_count(); ++i) {
      runs[i].run_index = i;
      runs[i].replicate = i / plan.cell_count();
      runs[i].cell = static_cast<std::uint32_t>(i % plan.cell_count());
      writer.add(runs[i]);
    }
    writer.publish(plan.replicates * plan.cell_count());
  }
  const samples::TemporaryFolder folder;
  const std::string path = folder / "a.fp";
  const std::string columns = run_columns();
  const int counters_at =
      static_cast<int>(std::ranges::count(std::string_view(columns).substr(0, columns.find(kCounters[0].name)), ','));
};

// Seconds are those of a row: the whole file is read once in an iteration.
void read(benchmark::State& state, std::unique_ptr<RowSource> (*open)(SQLite::Database&, const Published&)) {
  const Published file;
  std::uint64_t rows = 0;
  for (auto _ : state) {
    SQLite::Database db(file.path, SQLite::OPEN_READONLY);
    const auto source = open(db, file);
    std::array<std::int64_t, kCounters.size()> counters{};
    for (; source->step(); ++rows) {
      source->numbers(file.counters_at, counters);
      benchmark::DoNotOptimize(counters);
    }
  }
  state.counters["s/row"] =
      benchmark::Counter(static_cast<double>(rows), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

std::unique_ptr<RowSource> from_pages(SQLite::Database& db, const Published& file) {
  return TablePages::open(db, file.path, "runs", file.columns);
}
std::unique_ptr<RowSource> through_sqlite(SQLite::Database& db, const Published& file) {
  return std::make_unique<Query>(db, "SELECT " + file.columns + " FROM runs ORDER BY run_index");
}
BENCHMARK_CAPTURE(read, from_pages, from_pages)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, through_sqlite, through_sqlite)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fleetproof
