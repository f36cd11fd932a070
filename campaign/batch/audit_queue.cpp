#include "campaign/batch/audit_queue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
constexpr int kLooksAtAnAgent = 3;
// State that grows or fills shows after a few runs, or after more of them.
constexpr std::array<std::uint64_t, 2> kEarlierRuns = {3, 16};
constexpr int kMostHangs = 3;  // of runs that did not hang before; then nothing more is audited

// So many threads that the audits keep up with the campaign.
int threads_for(double share, int workers) {
  return std::clamp(static_cast<int>(std::ceil(share * workers)), 1, workers);
}

}  // namespace

AuditQueue::AuditQueue(const CampaignPlan& plan, const AgentPrograms& programs, bool audits, int workers)
    : plan_(plan),
      share_(plan.seed, plan.audit.share, plan.cells(), plugin_agents(plan, programs)),
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
  return waiting_.empty() && under_way_ == 0 && threads_looking_ == 0;
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

std::map<std::string, CloserLooks> AuditQueue::closer_looks() const {
  const std::lock_guard lock(mutex_);
  return looks_;
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
    std::vector<std::uint64_t> differing;
    try {
      differing = audit(batch);
    } catch (const RunAbandoned&) {
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      failure_ = error.what();
      abandoned_ = closing_ = true;
      waiting_.clear();
      more_.notify_all();
    }
    {
      const std::lock_guard lock(mutex_);
      under_way_ -= batch.size();
      if (abandoned_) return;
      ++threads_looking_;
    }
    // No audit is open while a run is looked at: a stop loses no finding.
    try {
      for (const std::uint64_t run_index : differing) look_closer(run_index);
    } catch (const std::exception&) {  // the audits themselves say what is wrong with the machine
    }
    const std::lock_guard lock(mutex_);
    --threads_looking_;
    if (abandoned_) return;
  }
}

// What software takes from its process shows soon if each of the first audits has a process of its own.
HostProcess AuditQueue::process_for(std::uint64_t run_index) {
  const std::lock_guard lock(mutex_);
  const bool is_early = ++begun_[agent_of_run(run_index, begun_.size())] <= kAuditsToPass;
  return is_early ? HostProcess::Own : HostProcess::Shared;
}

void AuditQueue::look_closer(std::uint64_t run_index) {
  const std::string& agent = plan_.agent_of_cell(run_index).name;
  {
    const std::lock_guard lock(mutex_);
    if (looks_begun_[agent] == kLooksAtAnAgent) return;
    ++looks_begun_[agent];
  }
  const bool depends = depends_on_earlier_runs(run_index);
  runs_->take_losses();
  const std::lock_guard lock(mutex_);
  ++(depends ? looks_[agent].dependent : looks_[agent].other);
}

// The run comes out the same in two new processes, whose memory is disturbed differently: it takes nothing from
// addresses, from memory that it never wrote, or from a clock. And it comes out otherwise, the same twice, in processes
// that have served the same other runs of its cell.
bool AuditQueue::depends_on_earlier_runs(std::uint64_t run_index) {
  const std::uint64_t alone = runs_->checksum_after({}, run_index);
  if (row_checksum((*runs_)(run_index, false, HostProcess::Own)) != alone) return false;
  const std::uint64_t cells = plan_.cells().size();
  for (const std::uint64_t count : kEarlierRuns) {
    std::vector<std::uint64_t> before;
    for (std::uint64_t i = 1; i <= count; ++i) before.push_back((run_index + i * cells) % (plan_.replicates * cells));
    const std::uint64_t after = runs_->checksum_after(before, run_index);
    if (after != alone) return runs_->checksum_after(before, run_index) == after;
  }
  return false;
}

std::vector<std::uint64_t> AuditQueue::audit(const Batch& batch) {
  std::vector<std::uint64_t> differing;
  for (const auto& [run_index, checksum] : batch) {
    const bool is_plugin = is_plugin_[agent_of_run(run_index, is_plugin_.size())];
    const RunRecord record = (*runs_)(run_index, is_plugin, process_for(run_index));
    runs_->take_losses();  // what ended a worker here stands in the record, and so in the finding
    AuditedRun finding = record.otherwise ? AuditedRun{*record.otherwise, false}
                                          : audit_finding(run_one_, record, checksum, &stop_playing_);
    // Software that ends its process, or hangs, is not looked at: each such run costs several times its limit.
    if (!finding.same && !record.otherwise && !record.outcome.hang && is_plugin) differing.push_back(run_index);
    const std::lock_guard lock(mutex_);
    findings_.push_back(std::move(finding));
    if (++found_ >= kAuditsToPass) wanted_ = kBatch;
    // Each costs five times the limit, and the limit once more for each further AGV.
    if (record.outcome.hang && ++hung_ >= kMostHangs)
      throw MachineError(fmt::format("{} runs hang in an audit and did not before", hung_));
  }
  return differing;
}

}  // namespace fleetproof
