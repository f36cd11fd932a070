#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "campaign/shrink/failure_pattern.hpp"

namespace fleetproof {

// Candidates in an order of preference. They are made when they are tried, perhaps several at once. None: this one
// makes no sense and is not simulated.
struct Candidates {
  std::size_t count = 0;
  std::function<std::optional<Scenario>(std::size_t rank)> make;
};

struct TrialLimits {
  std::optional<std::uint64_t> trials{};  // counted as one worker would make them
};

// Verdicts on scenarios by their digest, so that none that passes is simulated twice. They may come from a file.
class TrialCache {
 public:
  virtual ~TrialCache() = default;
  virtual std::optional<bool> find(std::uint64_t digest);
  virtual void add(std::uint64_t digest, bool fails);

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, bool> verdicts_;
};

// Tries candidates on all workers. What it finds does not depend on their number.
class Trials {
 public:
  struct Found {
    std::size_t rank = 0;
    FailingCase is;
  };

  // Requires: host and cache outlive the object.
  Trials(CaseHost& host, TrialCache& cache, FailurePattern pattern, const TrialLimits& limits)
      : host_(host), cache_(cache), pattern_(std::move(pattern)), limits_(limits) {}

  // The first candidate that fails in the same way. None if there is none, or if the time of the host or a limit was
  // over before it was found.
  std::optional<Found> first_failing(const Candidates& candidates);
  // Whether a limit was met. No trial is made then.
  bool ended() const { return ended_; }
  // So many candidates were simulated, or known from the cache, as one worker would have had to.
  std::uint64_t count() const { return count_; }
  CaseHost& host() { return host_; }

 private:
  bool is_over() const;
  std::size_t pass_known(const Candidates& candidates, std::size_t end, std::optional<Found>& found);
  std::optional<FailingCase> attempt(Scenario scenario);

  CaseHost& host_;
  TrialCache& cache_;
  FailurePattern pattern_;
  TrialLimits limits_;
  std::uint64_t count_ = 0;
  bool ended_ = false;
  bool all_known_ = true;  // so far: an earlier search has tried the same
};

}  // namespace fleetproof
