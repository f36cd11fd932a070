#include "campaign/batch/campaign.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include "campaign/batch/task_pool.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/run/engine_identity.hpp"
#include "campaign/workers/run_host.hpp"
#include "core/base/random.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "storage/archive_writer.hpp"

namespace fleetproof {
namespace {

// Runs between the oldest unfinished and the newest handed out: one slow run stalls nothing, and memory stays bounded.
constexpr std::uint64_t kLiveWindow = 65'536;

// Counts the gap-free prefix of a set of run indices that arrive in any order.
class Prefix {
 public:
  void add(std::uint64_t index) {
    ahead_.insert(index);
    while (!ahead_.empty() && *ahead_.begin() == length_) {
      ahead_.erase(ahead_.begin());
      ++length_;
    }
  }
  std::uint64_t length() const { return length_; }

 private:
  std::uint64_t length_ = 0;
  std::set<std::uint64_t> ahead_;
};

bool must_stop(const RunOptions& options, double elapsed_s) {
  const bool interrupted = options.interrupted != nullptr && options.interrupted->load() != 0;
  return interrupted || (options.max_time && elapsed_s >= static_cast<double>(options.max_time->count()));
}

constexpr std::chrono::seconds kDrain{4};  // what runs under way get after the stop; then they are abandoned
constexpr std::size_t kLossesKept = 1000;

void keep_losses(CampaignResult& result, std::vector<WorkerLoss> losses) {
  result.loss_count += losses.size();
  for (WorkerLoss& loss : losses) {
    if (result.losses.size() < kLossesKept) result.losses.push_back(std::move(loss));
  }
}

}  // namespace

void build_first_worlds(const CampaignPlan& plan) {
  const ScenarioSource scenarios(plan);
  for (std::uint64_t index = 0; index < plan.cell_count(); index += plan.cells_per_world())
    (void)scenarios.scenario(index);
}

std::vector<std::string> plugin_agents(const CampaignPlan& plan, const AgentPrograms& programs) {
  std::vector<std::string> names;
  std::ranges::copy_if(plan.agents, std::back_inserter(names),
                       [&](const std::string& name) { return programs.is_plugin(name); });
  return names;
}

CampaignRecord campaign_record(const CampaignPlan& plan, const AgentPrograms& programs) {
  CampaignRecord record;
  record.name = plan.name;
  record.kind = name_of(plan.kind);
  record.seed = plan.seed;
  record.replicates = plan.replicates;
  record.plan_json = plan_text(plan);
  record.plan_hash = name_hash(record.plan_json);
  record.required_probes = plan.probes_to_meet();
  if (plan.is_drawn()) record.sampling = name_of(plan.sampling);
  for (const Stream stream : plan.held_streams) record.held_streams.emplace_back(name_of(stream));
  record.held_replicate = plan.held_replicate;
  record.exempt_purposes = purposes_text(plan.law.exempt_purposes);
  record.exempt_radius_m = plan.law.exempt_radius_m;
  for (const ExemptPair& pair : plan.law.exempt_pairs) record.exempt_pairs.push_back(text_of(pair));
  record.plugin_agents = plugin_agents(plan, programs);
  record.engine = engine_identity();
  for (const std::string& plugin : programs.plugin_identities()) record.engine.libraries += ", plug-in " + plugin;
  return record;
}

CampaignResult run_campaign(const CampaignPlan& plan, const AgentPrograms& programs, const std::string& path,
                            const RunOptions& options, const CampaignListener& listener) {
  using Clock = std::chrono::steady_clock;
  RunHost runs(plan, programs, options.workers, options.worker_logs);
  build_first_worlds(plan);  // what cannot be built at all is said before anything is written
  ArchiveWriter archive(path, campaign_record(plan, programs), plan.cells(), plan.gates,
                        options.overwrite ? Existing::Replace : Existing::Refuse);
  CampaignResult result;
  result.progress.planned = plan.run_count();
  listener.started();
  Prefix prefix;
  const auto started = Clock::now();
  auto last_tick = started, last_commit = started;
  std::optional<Clock::time_point> stopped;
  {
    TaskPool pool(options.workers, 0, plan.run_count(), kLiveWindow, [&](std::uint64_t index) { return runs(index); });
    while (!pool.finished()) {
      const auto record = pool.next(std::chrono::milliseconds(100));
      const auto now = Clock::now();
      result.progress.elapsed_s = std::chrono::duration<double>(now - started).count();
      if (record) {
        ++result.progress.done;
        result.progress.violating += record->outcome.violation ? 1 : 0;
        result.progress.engine_errors += record->outcome.engine_error ? 1 : 0;
        prefix.add(record->run_index);
        archive.add(*record);
        listener.run_finished(*record);
      }
      if (!stopped && must_stop(options, result.progress.elapsed_s)) {
        stopped = now;
        pool.stop();
      }
      if (stopped && now - *stopped >= kDrain) runs.abandon();
      if (now - last_tick >= std::chrono::milliseconds(100)) {
        last_tick = now;
        listener.tick(result.progress);
        keep_losses(result, runs.take_losses());
      }
      if (now - last_commit >= std::chrono::seconds(1)) {  // even while one slow run lets no other finish
        last_commit = now;
        archive.commit();
      }
    }
    result.threads = pool.threads_seen();
  }
  keep_losses(result, runs.take_losses());
  result.stored = prefix.length();
  archive.publish(result.stored);
  return result;
}

}  // namespace fleetproof
