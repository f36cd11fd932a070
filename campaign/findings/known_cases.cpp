#include "campaign/findings/known_cases.hpp"

#include <optional>
#include <utility>

#include "campaign/shrink/all_runs.hpp"

namespace fleetproof {

std::vector<PlayedCase> play_known_cases(const FindingsFile& file, const CampaignPlan& plan,
                                         const AgentPrograms& programs, int workers,
                                         const std::function<bool()>& go_on) {
  std::vector<KeptFailure> kept;
  for (const KnownIssue& finding : file.findings()) kept.push_back(file.failure(finding));
  const TimeLimit limit({}, [&] { return !go_on(); });
  std::vector<PlayedCase> played;
  for (const AgentFactor& agent : plan.agents) {
    CaseHost host = CaseHost(case_agent(plan, agent), programs, workers).within(limit);
    auto runs = all_runs(host, {kept.size(), [&](std::size_t i) { return std::optional(kept[i].smallest); }});
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const FailureChoice choice = file.findings()[i].choice;
      if (choice != FailureChoice{}) runs[i] = host.looking_at(choice)(kept[i].smallest);  // another failure leads it
      const auto failure = failure_of(*runs[i]);
      played.push_back({file.findings()[i].id, agent.name, file.findings()[i].status,
                        failure && end_of(*failure) == kept[i].end, failure ? text_of(failure->kind) : "none"});
    }
  }
  return played;
}

}  // namespace fleetproof
