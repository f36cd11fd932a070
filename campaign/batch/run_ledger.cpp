#include "campaign/batch/run_ledger.hpp"

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

}  // namespace fleetproof
