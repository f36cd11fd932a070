#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "reports/evidence/failing_run.hpp"

namespace fleetproof::html {

// Failing runs of one agent with the same end point and the same first cause.
struct FailureGroup {
  std::string agent, end_point, first_cause;
  std::uint64_t runs = 0, distinct = 0;  // distinct: runs with the same trace digest count once
  bool at_least = false;                 // `distinct` is a lower bound: too many digests to keep
  FailingRun worst;
};

// What went wrong first in a run: the earliest violation or judged incident, with the kind of its pair of bodies.
std::string first_cause(const RunRecord& run, const FailingRun& failing);

// Groups the failing runs of a campaign in one pass. Memory does not grow with the number of runs. Threads: one.
class FailureGroups {
 public:
  void add(const RunRecord& run, const std::string& agent);
  std::uint64_t failing_runs() const { return failing_runs_; }
  std::vector<FailureGroup> list() const;  // the most serious first

 private:
  struct Group {
    FailureGroup shown;
    std::unordered_set<std::uint64_t> digests{};
  };
  std::map<std::tuple<std::string, Severity, std::string>, Group> groups_;
  std::uint64_t failing_runs_ = 0;
  std::size_t digests_ = 0;
};

}  // namespace fleetproof::html
