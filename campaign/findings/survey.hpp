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

struct SurveyedRun {
  std::uint64_t run = 0;
  std::string agent;
};

struct SurveyedRuns {
  std::vector<SurveyedRun> looked_at;  // in order of run index
  std::size_t all = 0;
};
// Of each agent, at most `most` of the runs that failed, spread evenly over the campaign.
SurveyedRuns failing_runs(const ArchiveReader& archive, const CampaignPlan& plan, std::size_t most);

// One host for each agent of a campaign that has failing runs.
class AgentHosts {
 public:
  AgentHosts(const CampaignPlan& plan, const AgentPrograms& programs, std::span<const SurveyedRun> runs, int workers);
  CaseHost& of(const std::string& agent) { return *hosts_.at(agent); }
  int workers() const { return workers_; }

 private:
  std::map<std::string, std::unique_ptr<CaseHost>> hosts_;
  int workers_;
};

struct Survey {
  std::vector<KnownFailure> failures;
  std::size_t looked_at = 0;             // all of the runs, unless it was to end before
  std::vector<std::uint64_t> not_again;  // runs that did not fail when they were simulated again
};
// What each of the runs needs. The result is the same for any number of workers. `go_on` hears how many are done, at
// least every 50 ms; once it says no, the runs under way are finished, and no other is begun.
Survey survey(const CampaignPlan& plan, std::span<const SurveyedRun> runs, AgentHosts& hosts,
              const std::function<bool(std::size_t done)>& go_on);

}  // namespace fleetproof
