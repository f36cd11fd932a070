#include "campaign/shrink/trials.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "campaign/batch/task_pool.hpp"
#include "core/scenario/canonical_bytes.hpp"

namespace fleetproof {

std::optional<bool> TrialCache::find(std::uint64_t digest) {
  const std::lock_guard lock(mutex_);
  const auto found = verdicts_.find(digest);
  return found == verdicts_.end() ? std::nullopt : std::optional(found->second);
}

void TrialCache::add(std::uint64_t digest, bool fails) {
  const std::lock_guard lock(mutex_);
  verdicts_.emplace(digest, fails);
}

bool Trials::is_over() const {
  return (limits_.deadline && std::chrono::steady_clock::now() >= *limits_.deadline) ||
         (limits_.trials && count_ >= *limits_.trials);
}

std::optional<FailingCase> Trials::attempt(Scenario scenario) {
  const std::uint64_t digest = scenario_digest(scenario);
  if (cache_.find(digest) == false) return std::nullopt;
  const auto failure = pattern_.match(host_(scenario));
  cache_.add(digest, failure.has_value());
  if (!failure) return std::nullopt;
  return FailingCase{std::move(scenario), *failure};
}

// Indices are handed out in ascending order. When one has failed, all before it are therefore under way or done, and
// none behind it matters.
std::optional<Trials::Found> Trials::first_failing(const Candidates& candidates) {
  if (ended_ || is_over()) {
    ended_ = true;
    return std::nullopt;
  }
  std::size_t end = candidates.count;
  if (limits_.trials) end = std::min<std::size_t>(end, *limits_.trials - count_);
  std::atomic<std::size_t> best = end;
  std::mutex mutex;
  std::optional<Found> found;
  std::atomic<bool> late = false;
  {
    TaskPool pool(host_.workers(), 0, end, 64, [&](std::uint64_t rank) -> std::optional<RunRecord> {
      RunRecord done;
      done.run_index = rank;
      if (rank > best || late) return done;
      auto scenario = candidates.make(rank);
      if (!scenario) return done;
      auto failing = attempt(*std::move(scenario));
      if (!failing) return done;
      const std::lock_guard lock(mutex);
      if (rank < best || !found) {
        best = rank;
        found = Found{rank, *std::move(failing)};
      }
      return done;
    });
    while (!pool.finished()) {
      pool.next(std::chrono::milliseconds(50));
      if (best < end) pool.stop();
      if (limits_.deadline && std::chrono::steady_clock::now() >= *limits_.deadline) late = true;
    }
  }
  count_ += found ? found->rank + 1 : end;
  if (!found && end < candidates.count) ended_ = true;  // the others were not tried
  // A candidate before the one that was found may not have been tried any more: the result would depend on the clock.
  if (late) ended_ = true;
  if (late && best != 0) return std::nullopt;
  return found;
}

}  // namespace fleetproof
