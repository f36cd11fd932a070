#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "campaign/batch/session.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Some of the runs that a results file holds when it goes on. A row could be of other software, another seed or another
// fleet: its checksum would not tell. So they are simulated once more before any other run.
class StoredSample {
 public:
  // Which ones are drawn follows from the rows themselves, in the order in which they come.
  void add(const RunRecord& run);
  // Simulates them on as many threads as the session has, for two seconds or until the session is asked to stop. What a
  // plug-in does otherwise becomes an audit that differs. Throws EngineError with `path` if a run of another agent
  // comes out otherwise.
  void simulate_again(Session& session, const CampaignPlan& plan, const AgentPrograms& programs,
                      const std::string& path) const;

 private:
  std::uint64_t seen_ = 0, key_ = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> runs_;  // index, checksum of its row
};

}  // namespace fleetproof
