#include "campaign/shards/shard_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <thread>
#include <vector>

#include "campaign/batch/audit_desk.hpp"
#include "campaign/batch/same_campaign.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/batch/task_pool.hpp"
#include "campaign/plan/first_worlds.hpp"
#include "campaign/shards/canary.hpp"
#include "campaign/shards/chunk_desk.hpp"
#include "campaign/workers/run_host.hpp"
#include "core/base/error.hpp"
#include "storage/checksum.hpp"
#include "storage/chunk_file.hpp"

namespace fleetproof {
namespace {

// Runs between the oldest unfinished and the newest handed out. A chunk that waits for a slow run keeps its file open,
// so there are less of them than a process may have.
constexpr std::uint64_t kLiveWindow = 4096;

// One session of a shard. It counts, publishes and reports on the caller's thread.
class ShardSession {
 public:
  ShardSession(const CampaignPlan& plan, const AgentPrograms& programs, const StoredPlan& stored,
               const ShardFolder& folder, Shard shard, const RunOptions& options, const ShardListener& listener)
      : options_(options),
        listener_(listener),
        stretch_(plan.cells_per_world()),
        grid_(plan.run_count()),
        owned_(grid_.of(shard)),
        runs_(plan, programs, {.workers = options.workers, .log_prefix = options.worker_logs}),
        audits_(plan, programs, options.audit_program, options.workers),
        desk_(folder, grid_, common_label(stored)) {
    // Which failed runs may be simulated again is known when all shards are put together.
    for (std::size_t agent = 0; agent < plan.agents.size(); ++agent)
      runs_.record(agent, plan.audit.share > 0.0 && programs.is_plugin(plan.agents[agent].program));
    for (std::uint64_t chunk = owned_.begin; chunk < owned_.end; ++chunk) {
      result_.runs.progress.planned += grid_.run_count(chunk);
      if (!is_chunk_there(folder.chunk_file(chunk))) {
        to_do_.push_back(chunk);
        runs_to_do_ += grid_.run_count(chunk);
      }
    }
    result_.owned = owned_.count();
    found_ = owned_.count() - to_do_.size();
    result_.runs.progress.done = result_.runs.progress.planned - runs_to_do_;
  }

  ShardResult run() {
    listener_.campaign.started();
    listener_.planned(owned_, found_);
    audits_.start();
    simulate();
    finish_audits();
    result_.runs.add(runs_.take_losses());
    result_.published = found_ + desk_.published();
    result_.runs.stored = result_.runs.progress.done - desk_.open_runs();
    return std::move(result_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  // Only the last chunk of a campaign is shorter, and it is the last one to do.
  std::uint64_t run_at(std::uint64_t place) const {
    return grid_.first_run(to_do_[place / grid_.chunk_runs()]) + place % grid_.chunk_runs();
  }

  void simulate() {
    TaskPool pool(
        options_.workers, 0, runs_to_do_, std::max(kLiveWindow, grid_.chunk_runs()),
        [this](std::uint64_t place) { return runs_(run_at(place)); }, {}, stretch_);
    while (!pool.finished()) {
      if (audits_.is_far_behind()) {  // with a large share the audits set the pace
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      } else if (const auto record = pool.next(std::chrono::milliseconds(100))) {
        take(*record);
      }
      if (must_stop(options_)) pool.stop_after_stretch(grid_.chunk_runs());
      tick_if_due([&] { return runs_under_way(pool); });
    }
    result_.runs.threads = pool.threads_seen();
    result_.runs.progress.elapsed_s = elapsed_s();
  }

  void finish_audits() {
    audits_.no_more_runs();
    while (!audits_.idle()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      tick_if_due([] { return std::vector<RunUnderWay>(); });
    }
    keep_findings();
    desk_.audits_end();
    desk_.publish();
    result_.runs.audit_failure = audits_.failure();
  }

  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

  std::vector<RunUnderWay> runs_under_way(const TaskPool& pool) const {
    auto runs = pool.under_way();
    for (RunUnderWay& run : runs) run.run_index = run_at(run.run_index);
    return runs;
  }

  void take(const RunRecord& record) {
    Progress& progress = result_.runs.progress;
    ++progress.simulated;
    ++progress.done;
    progress.violating += record.outcome.violation ? 1 : 0;
    progress.engine_errors += record.outcome.engine_error ? 1 : 0;
    desk_.add(record, audits_.offer(record, runs_.slowest_cpu_ns()));
    listener_.campaign.run_finished(record);
  }

  void tick_if_due(const std::function<std::vector<RunUnderWay>()>& under_way) {
    const auto now = Clock::now();
    if (now - last_tick_ < std::chrono::milliseconds(100)) return;
    last_tick_ = now;
    result_.runs.add(runs_.take_losses());
    keep_findings();
    if (!audits_.failure().empty()) desk_.audits_end();
    desk_.publish();
    if (!desk_.waits_for_audits()) last_without_waiting_ = now;
    if (now - last_without_waiting_ >= std::chrono::seconds(1)) audits_.hurry();
    Progress& progress = result_.runs.progress;
    progress.elapsed_s = elapsed_s();
    progress.audits_open = audits_.open_count();
    listener_.campaign.tick(progress);
    if (listener_.campaign.wants_status()) listener_.campaign.status(progress, under_way());
  }

  void keep_findings() {
    for (const AuditFinding& finding : audits_.take_findings()) {
      desk_.add(finding.audit);
      ++result_.runs.progress.audited;
      if (!finding.same) ++result_.runs.audits_differing;
    }
  }

  const RunOptions& options_;
  const ShardListener& listener_;
  ShardResult result_;
  const std::uint64_t stretch_;  // of runs in one world
  ChunkGrid grid_;
  ChunkRange owned_;
  std::vector<std::uint64_t> to_do_;  // chunks, in their order
  std::uint64_t runs_to_do_ = 0, found_ = 0;
  RunHost runs_;  // before files are opened: worker processes must not hold them
  AuditDesk audits_;
  ChunkDesk desk_;
  const Clock::time_point started_ = Clock::now();
  Clock::time_point last_tick_ = started_, last_without_waiting_ = started_;
};

}  // namespace

ChunkLabel common_label(const StoredPlan& plan) {
  StoredPlan without_engine = plan;
  without_engine.campaign.engine = {};
  const EngineIdentity& engine = plan.campaign.engine;
  ChunkLabel label;
  label.plan = plan_checksum(without_engine);
  label.campaign = plan.campaign.name;
  label.program = fmt::format("fleetproof {} sha256 {} ({})", engine.version, engine.program_sha256, engine.libraries);
  return label;
}

void require_same_plan(const std::string& where, const CampaignRecord& stored, const CampaignRecord& now) {
  std::string differences = plan_differences(stored, now);
  if (differences.empty() && stored.replicates != now.replicates)
    differences = fmt::format("plan/replicates: stored {}, now {}", stored.replicates, now.replicates);
  if (!differences.empty())
    throw InputError(where, fmt::format("the shards in this folder belong to another campaign ({}); name another "
                                        "folder with --out",
                                        differences));
  if (const auto other = engine_differences(stored.engine, now.engine); !other.empty())
    throw InputError(where, fmt::format("another program made the shards in this folder ({}); use that program on all "
                                        "machines, or name another folder with --out",
                                        other));
}

ShardResult run_shard(const CampaignPlan& plan, const AgentPrograms& programs, const ShardFolder& folder, Shard shard,
                      const RunOptions& options, const ShardListener& listener) {
  for (const AgentFactor& agent : plan.agents) (void)programs.program(agent.program, "factors.agents");
  // What cannot be built is said before anything is written.
  for (const std::string& sentence : build_first_worlds(plan)) listener.campaign.warned(sentence);
  folder.make();
  const StoredPlan ours = stored_plan(plan, programs);
  publish_plan(folder, ours);
  require_same_plan(folder.plan_file(), read_plan(folder).campaign, ours.campaign);
  check_canary(folder, canary_text(plan, programs, options.workers));
  return ShardSession(plan, programs, ours, folder, shard, options, listener).run();
}

}  // namespace fleetproof
