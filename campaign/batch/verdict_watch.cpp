#include "campaign/batch/verdict_watch.hpp"

namespace fleetproof {

void VerdictWatch::add(const RunRecord& run) {
  if (decided_length_) return;
  RunRecord& kept = ahead_.emplace(run.run_index, run).first->second;
  kept.recording.clear();
  for (auto next = ahead_.begin(); next != ahead_.end() && next->first == evidence_.runs() && !decided_length_;
       next = ahead_.erase(next)) {
    evidence_.add(next->second);
    const bool replicate_ends = evidence_.runs() % evidence_.cells().size() == 0;
    if (replicate_ends && overall_verdict(evidence_, evidence_.judge_all()) != Verdict::NotDemonstrated)
      decided_length_ = evidence_.runs();
  }
}

}  // namespace fleetproof
