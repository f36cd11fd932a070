#include "campaign/findings/survey.hpp"

#include <chrono>
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

// Each task writes to its own place.
Survey survey(const CampaignPlan& plan, std::span<const SurveyedRun> runs, AgentHosts& hosts,
              const std::function<bool(std::size_t done)>& go_on) {
  std::vector<std::optional<FailureNeeds>> needs(runs.size());
  std::vector<bool> is_done(runs.size());
  const ScenarioSource scenarios(plan);
  {
    std::size_t done = 0;
    TaskPool pool(hosts.workers(), 0, runs.size(), runs.size() + 1, [&](std::uint64_t i) {
      needs[i] = needs_of(hosts.of(runs[i].agent), scenarios.scenario(runs[i].run));
      RunRecord finished;
      finished.run_index = i;
      return std::optional(std::move(finished));
    });
    while (!pool.finished()) {
      if (const auto finished = pool.next(std::chrono::milliseconds(50))) {
        ++done;
        is_done[finished->run_index] = true;
      }
      if (!go_on(done)) pool.stop();
    }
  }
  Survey result;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!is_done[i]) continue;
    ++result.looked_at;
    if (needs[i]) {
      result.failures.push_back({runs[i].run, runs[i].agent, *std::move(needs[i])});
    } else {
      result.not_again.push_back(runs[i].run);
    }
  }
  return result;
}

}  // namespace fleetproof
