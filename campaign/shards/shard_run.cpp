#include "campaign/shards/shard_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "campaign/batch/same_campaign.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/plan/first_worlds.hpp"
#include "campaign/shards/canary.hpp"
#include "campaign/shards/chunk_collector.hpp"
#include "core/base/error.hpp"
#include "storage/checksum.hpp"
#include "storage/chunk_file.hpp"

namespace fleetproof {
namespace {

// Runs between the oldest unfinished and the newest handed out. A chunk that waits for a slow run keeps its file open,
// so there are less of them than a process may have.
constexpr std::uint64_t kLiveShardWindow = 4096;

// Publishes the runs of a session in chunks. A stop lets the chunks that were begun come to their end.
class ShardPolicy final : public SessionPolicy {
 public:
  ShardPolicy(Session& session, const CampaignPlan& plan, const StoredPlan& stored, const ShardFolder& folder,
              Shard shard)
      : session_(session),
        grid_(plan.run_count()),
        owned_(grid_.of(shard)),
        collector_(folder, grid_, common_label(stored)) {
    Progress& progress = session_.progress();
    for (std::uint64_t chunk = owned_.begin; chunk < owned_.end; ++chunk) {
      progress.planned += grid_.run_count(chunk);
      if (!is_chunk_there(folder.chunk_file(chunk))) {
        to_do_.push_back(chunk);
        runs_to_do_ += grid_.run_count(chunk);
      }
    }
    found_ = owned_.count() - to_do_.size();
    progress.done = progress.planned - runs_to_do_;
  }

  const ChunkRange& owned() const { return owned_; }
  std::uint64_t published() const { return found_ + collector_.published(); }
  std::uint64_t open_runs() const { return collector_.open_runs(); }
  TaskRange runs_to_do() const {
    return {.end = runs_to_do_, .window = std::max(kLiveShardWindow, grid_.chunk_runs())};
  }

  // Only the last chunk of a campaign is shorter, and it is the last one to do.
  std::uint64_t run_at(std::uint64_t place) const override {
    return grid_.first_run(to_do_[place / grid_.chunk_runs()]) + place % grid_.chunk_runs();
  }

  std::uint64_t piece() const override { return grid_.chunk_runs(); }

  void keep(const RunRecord& run, bool audited) override { collector_.add(run, audited); }

  void keep(const AuditedRun& finding) override { collector_.add(finding.audit); }

  void tick() override {
    if (!session_.audits().failure().empty()) collector_.audits_end();
    collector_.publish();
    const auto now = Clock::now();
    if (!collector_.waits_for_audits()) last_without_waiting_ = now;
    if (now - last_without_waiting_ >= std::chrono::seconds(1)) session_.audits().hurry();
  }

  void publish_rest() {
    collector_.audits_end();
    collector_.publish();
  }

 private:
  using Clock = std::chrono::steady_clock;

  Session& session_;
  ChunkGrid grid_;
  ChunkRange owned_;
  std::vector<std::uint64_t> to_do_;  // chunks, in their order
  std::uint64_t runs_to_do_ = 0, found_ = 0;
  ChunkCollector collector_;
  Clock::time_point last_without_waiting_ = Clock::now();
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
  for (const AgentFactor& agent : plan.agents) (void)programs.parts_of(agent, "factors.agents");
  // What cannot be built is said before anything is written.
  for (const std::string& sentence : build_first_worlds(plan)) listener.campaign.warned(sentence);
  folder.make();
  const StoredPlan ours = stored_plan(plan, programs);
  publish_plan(folder, ours);
  require_same_plan(folder.plan_file(), read_plan(folder).campaign, ours.campaign);
  check_canary(folder, canary_text(plan, programs, options.workers));
  Session session(plan, programs, options, listener.campaign);
  // Which failed runs may be simulated again is known when all shards are put together.
  for (std::size_t agent = 0; agent < plan.agents.size(); ++agent)
    session.runs().record(agent, plan.audit.share > 0.0 && programs.needs_worker(plan.agents[agent]));
  ShardPolicy policy(session, plan, ours, folder, shard);
  listener.campaign.started();
  listener.planned(policy.owned(), policy.published());
  ShardResult result;
  result.runs = session.run(policy, policy.runs_to_do());
  policy.publish_rest();
  result.runs.stored = result.runs.progress.done - policy.open_runs();
  result.owned = policy.owned().count();
  result.published = policy.published();
  return result;
}

}  // namespace fleetproof
