#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "campaign/findings/finding.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/shrink/case_host.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof {

// One failure of a run, as the campaign stores it.
struct StoredFailure {
  FailureChoice choice;  // the way to find it when the run is simulated again
  RunFailure is;
};
struct SurveyedRun {
  std::uint64_t run = 0;
  std::string agent;
  std::vector<StoredFailure> failures{};  // the one that leads first
};

struct SurveyedRuns {
  std::vector<SurveyedRun> looked_at;  // in order of run index
  std::size_t all = 0;
};
// Of each agent, at most `most` of the runs that failed, spread evenly over the campaign. A run may fail in several
// ways: bodies too close, no progress, a wrong load, an empty battery, a crash, a hang. Of each way its heaviest
// failure that is judged is looked at; what is not judged only if nothing else is. `only`: not the failure that leads,
// but these end points. Throws GivenUp once the time is over.
SurveyedRuns failing_runs(const ArchiveReader& archive, const CampaignPlan& plan, std::size_t most, FailureChoice only,
                          const TimeLimit& limit);

// One host for each agent of a campaign that has failing runs.
class AgentHosts {
 public:
  AgentHosts(const CampaignPlan& plan, const AgentPrograms& programs, std::span<const SurveyedRun> runs, int workers);
  CaseHost& of(const std::string& agent) { return *hosts_.at(agent); }
  int workers() const { return workers_; }
  std::uint64_t simulated() const;

 private:
  std::map<std::string, std::unique_ptr<CaseHost>> hosts_;
  int workers_;
};

struct Survey {
  std::vector<KnownFailure> failures;
  std::size_t looked_at = 0;             // all of the runs, unless the time was over before
  std::vector<std::uint64_t> not_again;  // runs of which a failure did not come again when they were simulated again
};
// What each failure of the runs needs. The result is the same for any number of workers, unless the time is over: then
// it is what was found until then. `on_more` hears of each run that is done: how many are, and the survey so far.
using OnMore = std::function<void(std::size_t done, const std::function<Survey()>& so_far)>;
Survey survey(const CampaignPlan& plan, std::span<const SurveyedRun> runs, AgentHosts& hosts, const TimeLimit& limit,
              const OnMore& on_more);

}  // namespace fleetproof
