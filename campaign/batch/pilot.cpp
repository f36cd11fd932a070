#include "campaign/batch/pilot.hpp"

#include <algorithm>
#include <mutex>
#include <numeric>

#include "campaign/batch/task_pool.hpp"
#include "campaign/workers/run_host.hpp"

namespace fleetproof {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// A step that visits all cells, each far from the one before: near the golden section, without a common divisor.
std::uint64_t spread_step(std::uint64_t cells) {
  std::uint64_t step = std::max<std::uint64_t>(1, cells * 618 / 1000);
  while (std::gcd(step, cells) != 1) ++step;
  return step;
}

// The time that runs take, by cell. Threads: any number.
class Costs {
 public:
  explicit Costs(std::uint64_t cells) : cells_(cells) {}

  void add(std::uint64_t cell, double run_s) {
    const std::lock_guard lock(mutex_);
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
  std::mutex mutex_;
  std::vector<CellCost> cells_;
};

}  // namespace

double Pilot::replicate_s() const {
  return std::accumulate(cells.begin(), cells.end(), 0.0,
                         [](double sum, const CellCost& cell) { return sum + cell.mean_s; });
}

double Pilot::forecast_s(std::uint64_t replicates) const {
  return replicate_s() * static_cast<double>(replicates) / workers;
}

std::uint64_t Pilot::replicates_within(double time_s) const {
  return static_cast<std::uint64_t>(time_s * workers / std::max(1e-9, replicate_s()));
}

double Pilot::runs_per_s() const { return static_cast<double>(cells.size()) * workers / std::max(1e-9, replicate_s()); }

Pilot run_pilot(const CampaignPlan& plan, const AgentPrograms& programs, int workers,
                std::chrono::milliseconds length) {
  const std::uint64_t cells = plan.cell_count(), step = spread_step(cells);
  Costs costs(cells);
  RunHost runs(plan, programs, {.workers = workers});
  const auto timed_run = [&](std::uint64_t place) {
    const std::uint64_t cell = place % cells * step % cells;
    const auto begin = Clock::now();
    auto record = runs(place - place % cells + cell);
    costs.add(cell, seconds_since(begin));
    return record;
  };
  Pilot pilot;
  const auto begin = Clock::now();
  {
    constexpr std::uint64_t kRecordsAhead = 1024;
    TaskPool pool(workers, 0, plan.run_count(), kRecordsAhead, timed_run);
    while (!pool.finished()) {
      if (pool.next(std::chrono::milliseconds(10))) ++pilot.runs;
      if (Clock::now() - begin >= length) pool.stop();
    }
  }
  pilot.elapsed_s = seconds_since(begin);
  pilot.workers = workers;
  pilot.cells = costs.means();
  return pilot;
}

}  // namespace fleetproof
