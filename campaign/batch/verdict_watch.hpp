#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "reports/evidence/evidence.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Says when a campaign has its verdict, with the code that the report judges with. Runs are judged in the order of
// their index, whatever the order in which they finish: otherwise short runs would be over-represented. Threads: one.
class VerdictWatch {
 public:
  explicit VerdictWatch(const StoredPlan& plan) : evidence_(plan) {}

  void add(const RunRecord& run);
  // How many runs the campaign needed to be demonstrated or violated, in whole replicates. Empty until then.
  std::optional<std::uint64_t> decided_length() const { return decided_length_; }

 private:
  Evidence evidence_;
  std::map<std::uint64_t, RunRecord> ahead_;  // of runs whose predecessors are not finished
  std::optional<std::uint64_t> decided_length_;
};

}  // namespace fleetproof
