#include "campaign/batch/stop_rules.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace fleetproof {

void RunLedger::add(std::uint64_t run_index, bool failed) {
  ensure(run_index >= length_ && !ahead_.contains(run_index), "a run finishes once");
  ahead_.emplace(run_index, failed);
  for (auto next = ahead_.begin(); next != ahead_.end() && next->first == length_; next = ahead_.erase(next)) {
    if (next->second) failures_.push_back(length_);
    ++length_;
  }
}

std::set<std::uint64_t> RunLedger::ahead() const {
  std::set<std::uint64_t> indices;
  for (const auto& [index, failed] : ahead_) indices.insert(index);
  return indices;
}

std::optional<std::uint64_t> RunLedger::length_with_failures(std::uint64_t count) const {
  ensure(count >= 1, "a stopping rule waits for one failure at least");
  if (failures_.size() < count) return std::nullopt;
  return failures_[count - 1] + 1;
}

void VerdictWatch::add(const RunRecord& run) {
  if (decided_length_) return;
  RunRecord& kept = ahead_.emplace(run.run_index, run).first->second;
  kept.recording.clear();
  advance();
}

void VerdictWatch::add(const AuditedRun& audit) {
  if (decided_length_ || audit.audit.run_index < evidence_.runs()) return;
  evidence_.know(audit);
  advance();
}

void VerdictWatch::audits_end(std::uint64_t below) {
  audits_end_ = std::max(audits_end_, below);
  advance();
}

bool VerdictWatch::waits_for_audits() const {
  return !decided_length_ && !ahead_.empty() && ahead_.begin()->first == evidence_.runs();
}

void VerdictWatch::advance() {
  for (auto next = ahead_.begin(); next != ahead_.end() && next->first == evidence_.runs() && !decided_length_;
       next = ahead_.erase(next)) {
    RunRecord& run = next->second;
    if (is_open(run)) return;
    run.repeats = !seen_.add(run);
    evidence_.add(run);
    const bool replicate_ends = evidence_.runs() % evidence_.cells().size() == 0;
    if (replicate_ends && overall_verdict(evidence_, evidence_.judge_all()) != Verdict::NotDemonstrated)
      decided_length_ = evidence_.runs();
  }
}

}  // namespace fleetproof
