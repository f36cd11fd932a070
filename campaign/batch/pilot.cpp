#include "campaign/batch/pilot.hpp"

#include <algorithm>
#include <numeric>

#include "campaign/batch/stored_plan.hpp"
#include "campaign/batch/task_pool.hpp"
#include "campaign/workers/run_host.hpp"
#include "reports/evidence/audit_share.hpp"

namespace fleetproof {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

struct TimedRun {
  double took_s = 0.0;
  std::optional<std::string> failure;  // the control software crashed or hung
};

// A step that visits all cells, each far from the one before: near the golden section, without a common divisor.
std::uint64_t spread_step(std::uint64_t cells) {
  std::uint64_t step = std::max<std::uint64_t>(1, cells * 618 / 1000);
  while (std::gcd(step, cells) != 1) ++step;
  return step;
}

// The time that runs take, by cell.
class Costs {
 public:
  explicit Costs(std::uint64_t cells) : cells_(cells) {}

  void add(std::uint64_t cell, double run_s) {
    cells_[cell].mean_s += run_s;  // the sum, until means()
    ++cells_[cell].runs;
  }
  std::vector<CellCost> means() const {
    std::vector<CellCost> cells = cells_;
    CellCost all;
    for (CellCost& cell : cells) {
      if (cell.runs == 0) continue;
      cell.mean_s /= static_cast<double>(cell.runs);
      all.mean_s += cell.mean_s;
      ++all.runs;
    }
    for (CellCost& cell : cells) {
      if (cell.runs == 0 && all.runs > 0) cell.mean_s = all.mean_s / static_cast<double>(all.runs);
    }
    return cells;
  }

 private:
  std::vector<CellCost> cells_;
};

// Each agent has as many cells as the others; its first runs are audited in any case.
double first_audits_s(const CampaignPlan& plan, const AgentPrograms& programs, const std::vector<CellCost>& cells) {
  if (plan.audit.share <= 0.0) return 0.0;
  const AuditShare share(plan.seed, plan.audit.share, plan.cells(), plugin_agents(plan, programs));
  const std::size_t agents = plan.agents.size();
  double sum_s = 0.0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    sum_s += cells[cell].mean_s * static_cast<double>(share.first_runs(static_cast<std::uint32_t>(cell)));
  return sum_s * static_cast<double>(agents) / static_cast<double>(cells.size());
}

}  // namespace

double Pilot::replicate_s() const {
  return std::accumulate(cells.begin(), cells.end(), 0.0,
                         [](double sum, const CellCost& cell) { return sum + cell.mean_s; });
}

double Pilot::forecast_s(std::uint64_t replicates) const {
  const double runs_s = replicate_s() * static_cast<double>(replicates);
  return (runs_s * (1.0 + audit_share) + std::min(first_audits_s, runs_s)) / workers;
}

std::uint64_t Pilot::replicates_within(double time_s) const {
  const double left_s = std::max(0.0, time_s * workers - first_audits_s);
  return static_cast<std::uint64_t>(left_s / std::max(1e-9, replicate_s() * (1.0 + audit_share)));
}

double Pilot::runs_per_s() const { return static_cast<double>(cells.size()) * workers / std::max(1e-9, replicate_s()); }

Pilot run_pilot(const CampaignPlan& plan, const AgentPrograms& programs, int workers, PilotLength length) {
  const std::uint64_t cells = plan.cell_count(), step = spread_step(cells);
  Costs costs(cells);
  RunHost runs(plan, programs, {.workers = workers});
  const auto cell_at = [&](std::uint64_t place) { return place % cells * step % cells; };
  const auto timed_run = [&](std::uint64_t place) {
    const auto begin = Clock::now();
    TimedRun run;
    const std::optional<RunRecord> record = runs(place - place % cells + cell_at(place));
    if (record && (record->outcome.crash || record->outcome.hang)) run.failure = record->outcome.message;
    run.took_s = seconds_since(begin);
    return std::optional(run);
  };
  Pilot pilot;
  const auto begin = Clock::now();
  {
    TaskPool<TimedRun> pool({.workers = workers, .end = std::min(plan.run_count(), length.runs)}, timed_run);
    pool.take_all(
        [&](std::uint64_t place, const TimedRun& run) {
          costs.add(cell_at(place), run.took_s);
          if (run.failure) pilot.failures.push_back({cell_at(place), *run.failure});
          ++pilot.runs;
        },
        [&] {
          if (Clock::now() - begin >= length.time) pool.stop();
        });
  }
  pilot.elapsed_s = seconds_since(begin);
  pilot.workers = workers;
  pilot.cells = costs.means();
  pilot.audit_share = plan.audit.share;
  pilot.first_audits_s = first_audits_s(plan, programs, pilot.cells);
  return pilot;
}

}  // namespace fleetproof
