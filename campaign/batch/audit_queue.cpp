#include "campaign/batch/audit_queue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "campaign/batch/audit_finding.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "storage/checksum.hpp"

namespace fleetproof {
namespace {

// Runs that are audited one after the other.
constexpr std::size_t kBatch = 16;
constexpr std::size_t kFirstBatch = 4;  // the first findings are wanted soon: they may end the recording of runs
constexpr std::uint64_t kMostOpen = 65'536;
constexpr int kMostHangs = 3;  // of runs that did not hang before; then nothing more is audited

// So many threads that the audits keep up with the campaign.
int threads_for(double share, int workers) {
  return std::clamp(static_cast<int>(std::ceil(share * workers)), 1, workers);
}

}  // namespace

AuditQueue::AuditQueue(const CampaignPlan& plan, const AgentPrograms& programs, bool audits, int workers)
    : share_(plan.seed, plan.audit.share, plan.cells(), plugin_agents(plan, programs)),
      run_one_(plan, programs),
      threads_wanted_(threads_for(plan.audit.share, workers)),
      wanted_(kFirstBatch),
      begun_(plan.agents.size()) {
  for (const AgentFactor& agent : plan.agents) is_plugin_.push_back(programs.needs_worker(agent));
  if (!audits || plan.audit.share <= 0.0) return;
  Hosting hosting;
  hosting.workers = threads_wanted_;
  hosting.audits = true;
  runs_ = std::make_unique<IsolatedRuns>(plan, programs, hosting);
}

AuditQueue::~AuditQueue() {
  abandon();
  for (std::thread& thread : threads_) thread.join();
}

bool AuditQueue::offer(const RunRecord& run, std::uint64_t slowest_cpu_ns) {
  if (run.otherwise) {
    const std::lock_guard lock(mutex_);
    findings_.push_back({*run.otherwise, false});
    return true;
  }
  if (!runs_ || !share_.contains(run)) return false;
  runs_->expect_cpu_ns(slowest_cpu_ns);
  const std::lock_guard lock(mutex_);
  if (abandoned_) return false;
  waiting_.emplace(run.run_index, row_checksum(run));
  if (waiting_.size() >= wanted_) more_.notify_one();
  return true;
}

void AuditQueue::start() {
  if (!runs_) return;
  for (int i = 0; i < threads_wanted_; ++i) threads_.emplace_back([this] { work(); });
}

void AuditQueue::no_more_runs() {
  const std::lock_guard lock(mutex_);
  closing_ = true;
  more_.notify_all();
}

void AuditQueue::hurry() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty()) return;
  wanted_ = 1;
  more_.notify_all();
}

void AuditQueue::abandon() {
  stop_playing_ = true;
  if (runs_) runs_->abandon();
  const std::lock_guard lock(mutex_);
  abandoned_ = closing_ = true;
  waiting_.clear();
  more_.notify_all();
}

bool AuditQueue::idle() const {
  const std::lock_guard lock(mutex_);
  return waiting_.empty() && under_way_ == 0;
}

bool AuditQueue::is_far_behind() const { return open_count() >= kMostOpen; }

std::uint64_t AuditQueue::open_count() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size() + under_way_;
}

std::string AuditQueue::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

std::vector<AuditedRun> AuditQueue::take_findings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(findings_, {});
}

// In another order than that of the campaign, so that what one run leaves behind for the next shows.
AuditQueue::Batch AuditQueue::next_batch() {
  std::unique_lock lock(mutex_);
  more_.wait(lock, [&] { return closing_ || waiting_.size() >= wanted_; });
  Batch batch;
  for (auto next = waiting_.begin(); next != waiting_.end() && batch.size() < kBatch; next = waiting_.erase(next))
    batch.emplace_back(*next);
  if (waiting_.empty()) wanted_ = found_ >= kAuditsToPass ? kBatch : kFirstBatch;
  under_way_ += batch.size();
  std::ranges::sort(batch, {}, [](const auto& run) { return Draws(run.first).next(); });
  return batch;
}

void AuditQueue::work() {
  for (;;) {
    const Batch batch = next_batch();
    if (batch.empty()) return;
    try {
      audit(batch);
    } catch (const RunAbandoned&) {
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      failure_ = error.what();
      abandoned_ = closing_ = true;
      waiting_.clear();
      more_.notify_all();
    }
    const std::lock_guard lock(mutex_);
    under_way_ -= batch.size();
    if (abandoned_) return;
  }
}

// What software takes from its process shows soon if each of the first audits has a process of its own.
HostProcess AuditQueue::process_for(std::uint64_t run_index) {
  const std::lock_guard lock(mutex_);
  const bool is_early = ++begun_[agent_of_run(run_index, begun_.size())] <= kAuditsToPass;
  return is_early ? HostProcess::Own : HostProcess::Shared;
}

void AuditQueue::audit(const Batch& batch) {
  for (const auto& [run_index, checksum] : batch) {
    const bool record_calls = is_plugin_[agent_of_run(run_index, is_plugin_.size())];
    const RunRecord record = (*runs_)(run_index, record_calls, process_for(run_index));
    runs_->take_losses();  // what ended a worker here stands in the record, and so in the finding
    AuditedRun finding = record.otherwise ? AuditedRun{*record.otherwise, false}
                                          : audit_finding(run_one_, record, checksum, &stop_playing_);
    const std::lock_guard lock(mutex_);
    findings_.push_back(std::move(finding));
    if (++found_ >= kAuditsToPass) wanted_ = kBatch;
    // Each costs five times the limit, and the limit once more for each further AGV.
    if (record.outcome.hang && ++hung_ >= kMostHangs)
      throw MachineError(fmt::format("{} runs hang in an audit and did not before", hung_));
  }
}

}  // namespace fleetproof
