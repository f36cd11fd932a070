#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "reports/evidence/evidence.hpp"
#include "storage/records.hpp"
#include "storage/seen_traces.hpp"

namespace fleetproof {

// Where results end a campaign: `--fail-fast` and `--until-verdict`.

// Which runs are finished, and the gap-free prefix of run indices among them. Statistics and stopping rules look at the
// prefix only: short runs finish first and would be over-represented.
class RunLedger {
 public:
  // Each index once, in any order.
  void add(std::uint64_t run_index, bool failed);

  std::uint64_t prefix_length() const { return length_; }
  // The finished runs beyond the prefix.
  std::set<std::uint64_t> ahead() const;
  // The length of the shortest prefix that holds `count` failed runs; none if the prefix holds fewer. Requires: count
  // is at least 1.
  std::optional<std::uint64_t> length_with_failures(std::uint64_t count) const;

 private:
  std::uint64_t length_ = 0;
  std::map<std::uint64_t, bool> ahead_;  // run index -> failed
  std::vector<std::uint64_t> failures_;  // of the prefix, in order
};

// Says when a campaign has its verdict, with the code that the report judges with. Runs are judged in the order of
// their index, whatever the order in which they finish: otherwise short runs would be over-represented. A run that is
// due for an audit waits for it. Threads: one.
class VerdictWatch {
 public:
  explicit VerdictWatch(const StoredPlan& plan) : evidence_(plan) {}

  void add(const RunRecord& run);
  void add(const AuditedRun& audit);
  // No other audit of a run below this index is waited for; those that are due are missing then.
  void audits_end(std::uint64_t below = std::numeric_limits<std::uint64_t>::max());
  // The next run in order is here, and only its audit is missing.
  bool waits_for_audits() const;
  std::size_t waiting_runs() const { return ahead_.size(); }
  // How many runs the campaign needed to be demonstrated or violated, in whole replicates. Empty until then.
  std::optional<std::uint64_t> decided_length() const { return decided_length_; }

 private:
  void advance();
  bool is_open(const RunRecord& run) const {
    return run.run_index >= audits_end_ && evidence_.audits().is_awaited(run);
  }

  Evidence evidence_;
  SeenTraces seen_;
  std::uint64_t audits_end_ = 0;
  std::map<std::uint64_t, RunRecord> ahead_;  // of runs whose predecessors or audits are not finished
  std::optional<std::uint64_t> decided_length_;
};

}  // namespace fleetproof
