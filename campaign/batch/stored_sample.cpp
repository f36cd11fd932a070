#include "campaign/batch/stored_sample.hpp"

#include <fmt/format.h>

#include <chrono>

#include "campaign/batch/task_pool.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "storage/checksum.hpp"

namespace fleetproof {
namespace {

// If a fifth of all rows was exchanged, a sample of this size holds none of them once in two hundred times.
constexpr std::size_t kSample = 24;
constexpr std::chrono::seconds kLongest{2};

}  // namespace

void StoredSample::add(const RunRecord& run) {
  const std::uint64_t checksum = row_checksum(run);
  Draws draws(key_ ^ checksum);
  key_ = draws.next();
  const std::uint64_t place =
      runs_.size() < kSample ? runs_.size() : draws.below(static_cast<std::uint32_t>(seen_ + 1));
  ++seen_;
  if (place == runs_.size()) runs_.emplace_back();
  if (place < runs_.size()) runs_[place] = {run.run_index, checksum};
}

void StoredSample::simulate_again(Session& session, const CampaignPlan& plan, const AgentPrograms& programs,
                                  const std::string& path) const {
  const auto begin = std::chrono::steady_clock::now();
  TaskPool<RunRecord> pool({.workers = session.options().workers, .end = runs_.size()},
                           [&](std::uint64_t place) { return session.runs()(runs_[place].first); });
  const auto compare = [&](std::uint64_t place, RunRecord run) {
    if (run.was_disturbed || run.otherwise || row_checksum(run) == runs_[place].second) return;
    if (!programs.is_plugin(plan.agent_of_cell(run.run_index)))
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
}

}  // namespace fleetproof
