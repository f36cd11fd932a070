#include "campaign/batch/stored_sample.hpp"

#include <fmt/format.h>

#include <chrono>

#include "campaign/batch/task_pool.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "storage/checksum.hpp"

namespace fleetproof {
namespace {

// If one row in a hundred was exchanged, a sample of this size holds none of them in one of twenty cases.
constexpr std::size_t kDrawn = 300;
constexpr std::size_t kNamed = 100;
constexpr std::chrono::seconds kLongest{2};

}  // namespace

void StoredSample::add(const RunRecord& run) {
  const std::uint64_t checksum = row_checksum(run);
  Draws draws(key_ ^ checksum);
  key_ = draws.next();
  const std::uint64_t place =
      drawn_.size() < kDrawn ? drawn_.size() : draws.below(static_cast<std::uint32_t>(seen_ + 1));
  ++seen_;
  if (place == drawn_.size()) drawn_.emplace_back();
  if (place < drawn_.size()) drawn_[place] = {run.run_index, checksum};
}

void StoredSample::add_named(const RunRecord& run) {
  if (named_.size() >= kNamed) return add(run);
  named_.emplace_back(run.run_index, row_checksum(run));
}

TakenOver StoredSample::simulate_again(Session& session, const CampaignPlan& plan, const AgentPrograms& programs,
                                       const std::string& path) const {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Stored> runs = named_;
  runs.insert(runs.end(), drawn_.begin(), drawn_.end());
  TaskPool<RunRecord> pool({.workers = session.options().workers, .end = runs.size()},
                           [&](std::uint64_t place) { return session.runs()(runs[place].first); });
  TakenOver taken;
  const auto compare = [&](std::uint64_t place, RunRecord run) {
    if (run.was_disturbed || run.otherwise) return;
    ++taken.simulated_again;
    taken.drawn += place < named_.size() ? 0 : 1;
    if (row_checksum(run) == runs[place].second) return;
    if (!programs.needs_worker(plan.agent_of_cell(run.run_index)))
      throw EngineError(
          fmt::format("{}: run {} is stored otherwise than this program simulates it; somebody has changed "
                      "the file, or a computer is at fault. Begin again with --overwrite",
                      path, run.run_index));
    run.otherwise = AuditRecord{run.run_index, row_checksum(run), audited_outcome(run)};
    session.audits().offer(run);
  };
  pool.take_all(compare, [&] {
    if (must_stop(session.options()) || std::chrono::steady_clock::now() - begin > kLongest) pool.stop();
  });
  return taken;
}

}  // namespace fleetproof
