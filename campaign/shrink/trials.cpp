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

bool Trials::is_over() const { return host_.is_over() || (limits_.trials && count_ >= *limits_.trials); }

std::optional<FailingCase> Trials::attempt(Scenario scenario) {
  const std::uint64_t digest = scenario_digest(scenario);
  if (cache_.find(digest) == false) return std::nullopt;
  const CaseRun run = host_(scenario);
  const auto failure = pattern_.match(run);
  cache_.add(digest, failure.has_value());
  if (!failure) return std::nullopt;
  return FailingCase{std::move(scenario), *failure, run.outcome.digest};
}

// Passes over the candidates that an earlier search has tried: their answers need no workers. Returns the first rank
// that is still to be tried.
std::size_t Trials::pass_known(const Candidates& candidates, std::size_t end, std::optional<Found>& found) {
  std::size_t rank = 0;
  for (; rank < end && all_known_ && !found && !host_.is_over(); ++rank) {
    auto scenario = candidates.make(rank);
    if (!scenario) continue;
    const auto known = cache_.find(scenario_digest(*scenario));
    all_known_ = known.has_value();
    if (!all_known_) break;
    if (*known) {
      if (auto failing = attempt(*std::move(scenario))) found = Found{rank, *std::move(failing)};
    }
  }
  return rank;
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
  std::optional<Found> found;
  const std::size_t begin = pass_known(candidates, end, found);
  std::atomic<std::size_t> best = end;  // the lowest rank that has failed
  std::atomic<bool> late = false;
  if (!found && begin < end) {
    const auto trial = [&](std::uint64_t rank) -> std::optional<FailingCase> {
      if (rank > best || late) return std::nullopt;
      auto scenario = candidates.make(rank);
      if (!scenario) return std::nullopt;
      std::optional<FailingCase> failing;
      try {
        failing = attempt(*std::move(scenario));
      } catch (const GivenUp&) {
        late = true;
      }
      std::size_t lowest = best;
      while (failing && rank < lowest && !best.compare_exchange_weak(lowest, rank)) {
      }
      return failing;
    };
    TaskPool<FailingCase> pool({.workers = host_.workers(), .begin = begin, .end = end, .window = 64}, trial);
    pool.take_all(
        [&](std::uint64_t rank, FailingCase failing) {
          if (!found || rank < found->rank) found = Found{rank, std::move(failing)};
        },
        [&] {
          if (best < end) pool.stop();
          if (host_.is_over()) late = true;
        });
  }
  count_ += found ? found->rank + 1 : end;
  if (!found && end < candidates.count) ended_ = true;  // the others were not tried
  // A candidate before the one that was found may not have been tried any more: the result would depend on the clock.
  if (late) ended_ = true;
  if (late && best != begin) return std::nullopt;
  return found;
}

}  // namespace fleetproof
