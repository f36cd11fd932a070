#include "campaign/findings/survey.hpp"

#include <optional>
#include <utility>

#include "campaign/batch/task_pool.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "reports/evidence/first_cause.hpp"

namespace fleetproof {

SurveyedRuns failing_runs(const ArchiveReader& archive, const CampaignPlan& plan, std::size_t most) {
  SurveyedRuns found;
  std::map<std::string, std::vector<std::uint64_t>> by_agent;
  archive.for_each_run([&](const RunRecord& run) {
    if (!first_cause(run.outcome)) return;
    ++found.all;
    by_agent[plan.agent_of_cell(run.run_index).name].push_back(run.run_index);
  });
  std::map<std::uint64_t, std::string> chosen;
  for (const auto& [agent, runs] : by_agent) {
    const std::size_t count = std::min(most, runs.size());
    for (std::size_t i = 0; i < count; ++i) chosen.emplace(runs[i * runs.size() / count], agent);
  }
  for (const auto& [run, agent] : chosen) found.looked_at.push_back({run, agent});
  return found;
}

AgentHosts::AgentHosts(const CampaignPlan& plan, const AgentPrograms& programs, std::span<const SurveyedRun> runs,
                       int workers)
    : workers_(workers) {
  for (const SurveyedRun& run : runs) {
    if (hosts_.contains(run.agent)) continue;
    const AgentFactor& agent = plan.agent_of_cell(run.run);
    hosts_.emplace(run.agent, std::make_unique<CaseHost>(case_agent(plan, agent), programs, workers));
  }
}

Survey survey(const CampaignPlan& plan, std::span<const SurveyedRun> runs, AgentHosts& hosts,
              const std::function<bool(std::size_t done)>& go_on) {
  using Needs = std::optional<FailureNeeds>;  // none: the run does not fail again
  std::map<std::uint64_t, Needs> needs;
  const ScenarioSource scenarios(plan);
  {
    TaskPool<Needs> pool(
        {.workers = hosts.workers(), .end = runs.size(), .window = runs.size() + 1}, [&](std::uint64_t i) {
          return std::make_optional(needs_of(hosts.of(runs[i].agent), scenarios.scenario(runs[i].run)));
        });
    pool.take_all([&](std::uint64_t i, Needs found) { needs.emplace(i, std::move(found)); },
                  [&] {
                    if (!go_on(needs.size())) pool.stop();
                  });
  }
  Survey result;
  result.looked_at = needs.size();
  for (auto& [i, found] : needs) {
    if (found) {
      result.failures.push_back({runs[i].run, runs[i].agent, *std::move(found)});
    } else {
      result.not_again.push_back(runs[i].run);
    }
  }
  return result;
}

}  // namespace fleetproof
