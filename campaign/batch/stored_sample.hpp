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
  // Of the runs that are added here, some are drawn. Which ones follows from the rows themselves, in the order in which
  // they come.
  void add(const RunRecord& run);
  // Something in the file speaks of this run, so that an exchanged row would not fit it: an audit, for example. The
  // first hundred of them are simulated, and count as drawn in no bound.
  void add_named(const RunRecord& run);
  // Simulates them on as many threads as the session has, for two seconds or until the session is asked to stop. What a
  // plug-in does otherwise becomes an audit that differs. Says how many were simulated. Throws EngineError with `path`
  // if a run of another agent comes out otherwise.
  TakenOver simulate_again(Session& session, const CampaignPlan& plan, const AgentPrograms& programs,
                           const std::string& path) const;

 private:
  using Stored = std::pair<std::uint64_t, std::uint64_t>;  // index, checksum of its row

  std::uint64_t seen_ = 0, key_ = 0;
  std::vector<Stored> named_, drawn_;
};

}  // namespace fleetproof
