#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "reports/evidence/failing_run.hpp"
#include "reports/evidence/first_cause.hpp"

namespace fleetproof {

// Failing runs of one agent with the same end point, the same leading failure, and the same kind of thing before it.
struct FailureGroup {
  std::string agent, end_point, first_cause;
  CameBefore before = CameBefore::Nothing;
  std::uint64_t runs = 0, distinct = 0;  // distinct: runs with the same trace digest count once
  bool at_least = false;                 // `distinct` is a lower bound: too many digests to keep
  FailingRun worst;
  std::vector<FailingRun> first;  // the most serious ones with the worst among them; no trace twice
};

// Of these groups at most so many runs to look at: one of each group before a second one of any.
std::vector<std::uint64_t> runs_to_show(const std::vector<FailureGroup>& groups, std::size_t most);

// Groups the failing runs of a campaign in one pass. Memory does not grow with the number of runs. Threads: one.
class FailureGroups {
 public:
  void add(const RunRecord& run, const std::string& agent);
  std::uint64_t failing_runs() const { return failing_runs_; }
  // Agents under test before reference agents; of each, the most serious first.
  std::vector<FailureGroup> list(const StoredPlan& plan) const;

 private:
  struct Group {
    FailureGroup shown;
    WorstRuns first;
    std::unordered_set<std::uint64_t> digests{};
  };
  std::map<std::tuple<std::string, OutcomeClass, std::string, CameBefore>, Group> groups_;
  std::uint64_t failing_runs_ = 0;
  std::size_t digests_ = 0;
};

}  // namespace fleetproof
