#include "campaign/findings/survey.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "campaign/batch/task_pool.hpp"
#include "campaign/plan/scenario_source.hpp"

namespace fleetproof {

namespace {

// What counts as one way to fail: how close two bodies came, and what keeps a fleet from its work, is chance.
FailureChoice way_of(EndPoint end_point) {
  constexpr std::uint32_t too_close =
      bit_of(EndPoint::Violation) | bit_of(EndPoint::Contact) | bit_of(EndPoint::HazardousContact);
  if ((too_close & bit_of(end_point)) != 0) return {too_close};
  if (!info_of(end_point).is_lack_of_progress) return {bit_of(end_point)};
  FailureChoice lacks;
  for (const EndPointInfo& info : kEndPoints) lacks.end_points |= info.is_lack_of_progress ? bit_of(info.id) : 0;
  return lacks;
}

std::vector<StoredFailure> looked_at_of(const Outcome& outcome, FailureChoice only) {
  std::vector<StoredFailure> found;
  std::uint32_t seen = 0;
  for (const RunFailure& failure : failures_of(outcome)) {
    if (only.end_points != 0) {
      const bool is_meant = failure.end_point && (only.end_points & bit_of(*failure.end_point)) != 0;
      if (is_meant && found.empty()) found.push_back({only, failure});
      continue;
    }
    if (!found.empty() && (!failure.is_judged || (seen & bit_of(*failure.end_point)) != 0)) continue;
    const bool leads = found.empty();
    const FailureChoice way = failure.end_point ? way_of(*failure.end_point) : FailureChoice{};
    found.push_back({leads ? FailureChoice{} : way, failure});
    seen |= way.end_points;
  }
  return found;
}

}  // namespace

SurveyedRuns failing_runs(const ArchiveReader& archive, const CampaignPlan& plan, std::size_t most, FailureChoice only,
                          const TimeLimit& limit) {
  SurveyedRuns found;
  std::map<std::string, std::vector<std::uint64_t>> by_agent;
  archive.for_each_run([&](const RunRecord& run) {
    if (limit.is_over()) throw GivenUp("the time for the survey is over");
    if (looked_at_of(run.outcome, only).empty()) return;
    ++found.all;
    by_agent[plan.agent_of_cell(run.run_index).name].push_back(run.run_index);
  });
  for (const auto& [agent, runs] : by_agent) {
    const std::size_t count = std::min(most, runs.size());
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t run = runs[i * runs.size() / count];
      found.looked_at.push_back({run, agent, looked_at_of(archive.run(run)->outcome, only)});
    }
  }
  std::ranges::sort(found.looked_at, {}, &SurveyedRun::run);
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

std::uint64_t AgentHosts::simulated() const {
  std::uint64_t sum = 0;
  for (const auto& [agent, host] : hosts_) sum += host->simulated();
  return sum;
}

namespace {

using NeedsOfRun = std::vector<std::optional<FailureNeeds>>;  // of each failure of a run; none: it does not come again

Survey survey_of(std::span<const SurveyedRun> runs, const std::map<std::uint64_t, NeedsOfRun>& needs) {
  Survey result;
  result.looked_at = needs.size();
  for (const auto& [i, found] : needs) {
    for (std::size_t k = 0; k < found.size(); ++k) {
      const StoredFailure& stored = runs[i].failures[k];
      const bool leads = stored.choice.end_points == 0;
      if (found[k])
        result.failures.push_back(
            {runs[i].run, runs[i].agent, *found[k], stored.choice, leads ? std::nullopt : stored.is.end_point});
    }
    const auto is_missing = [](const auto& failure) { return !failure; };
    if (std::ranges::any_of(found, is_missing)) result.not_again.push_back(runs[i].run);
  }
  return result;
}

}  // namespace

Survey survey(const CampaignPlan& plan, std::span<const SurveyedRun> runs, AgentHosts& hosts, const TimeLimit& limit,
              const OnMore& on_more) {
  std::map<std::uint64_t, NeedsOfRun> needs;
  const ScenarioSource scenarios(plan);
  const auto needs_of_run = [&](std::uint64_t i) -> std::optional<NeedsOfRun> {
    try {
      const Scenario scenario = scenarios.scenario(runs[i].run);
      NeedsOfRun found;
      for (const StoredFailure& failure : runs[i].failures) {
        CaseHost host = hosts.of(runs[i].agent).looking_at(failure.choice).within(limit);
        found.push_back(needs_of(host, scenario, &failure.is));
      }
      return found;
    } catch (const GivenUp&) {
      return std::nullopt;
    }
  };
  TaskPool<NeedsOfRun> pool({.workers = hosts.workers(), .end = runs.size(), .window = runs.size() + 1}, needs_of_run);
  pool.take_all(
      [&](std::uint64_t i, NeedsOfRun found) {
        needs.emplace(i, std::move(found));
        on_more(needs.size(), [&] { return survey_of(runs, needs); });
      },
      [&] {
        if (limit.is_over()) pool.stop();
      });
  return survey_of(runs, needs);
}

}  // namespace fleetproof
