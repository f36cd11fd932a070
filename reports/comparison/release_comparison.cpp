#include "reports/comparison/release_comparison.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/evidence/fisher.hpp"

namespace fleetproof {
namespace {

using Replicate = std::vector<ComparedRun>;

bool fails(const Replicate& replicate, std::size_t end_point) {
  return std::ranges::any_of(replicate,
                             [&](const ComparedRun& run) { return run.results[end_point] != RunResult::Passed; });
}

std::uint64_t failing_worlds(const ReleaseRuns& release, std::size_t end_point, std::size_t worlds) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < worlds; ++i) count += fails(release.replicates[i], end_point) ? 1 : 0;
  return count;
}

bool same_conditions(const CellRecord& a, const CellRecord& b) {
  return a.layout == b.layout && a.fleet_size == b.fleet_size && a.lowest == b.lowest && a.highest == b.highest;
}

// The part of a plan that shapes worlds and judgement.
SortedJson part_that_shapes(const std::string& plan_json) {
  SortedJson plan = read_sorted_json(plan_json);
  if (!plan.is_object()) return plan_json;
  for (const char* key :
       {"name", "replicates", "gates", "default_gates", "limits", "audit", "agent_config", "coverage"})
    plan.erase(key);
  if (plan.contains("factors") && plan["factors"].is_object()) plan["factors"].erase("agents");
  return plan;
}

// Why two campaigns did not run in the same worlds, judged by the same laws: "the plans differ in /horizon_s". Empty:
// they did, if their cells are the same. Names, agents, gates, limits, audits and the number of replicates are no
// difference.
std::string world_difference(const CampaignRecord& one, const CampaignRecord& other) {
  if (one.engine.version != other.engine.version) return "the versions of fleetproof differ";
  if (one.seed != other.seed) return "the seeds differ";
  const SortedJson patch = SortedJson::diff(part_that_shapes(one.plan_json), part_that_shapes(other.plan_json));
  return patch.empty() ? "" : "the plans differ in " + patch.front().at("path").get<std::string>();
}

// Why the runs cannot be paired; empty: they can.
std::string obstacle_to_pairs(const ReleaseRuns& a, const ReleaseRuns& b) {
  if (!std::ranges::equal(a.cells, b.cells, same_conditions)) return "the cells differ";
  return world_difference(a.campaign, b.campaign);
}

PairedCounts count_pairs(const ReleaseRuns& a, const ReleaseRuns& b, std::size_t end_point, std::size_t worlds) {
  PairedCounts pairs;
  for (std::size_t world = 0; world < worlds; ++world) {
    const bool was = fails(a.replicates[world], end_point), is = fails(b.replicates[world], end_point);
    ++(was ? (is ? pairs.both : pairs.only_old) : (is ? pairs.only_new : pairs.neither));
  }
  return pairs;
}

void take_difference(EndPointChange& change, const PairedDifference& difference) {
  change.lower = difference.lower;
  change.upper = difference.upper;
  change.one_sided_upper = difference.one_sided_upper;
}

// The one-sided bounds of both shares, each at a part of the risk (Bonferroni).
PairedDifference unpaired_difference(const EndPointChange& change, Confidence confidence) {
  const auto upper = [&](double parts) {
    return upper_bound(change.new_failing, change.new_worlds, confidence.shared(parts)) -
           lower_bound(change.old_failing, change.old_worlds, confidence.shared(parts));
  };
  const double lower = lower_bound(change.new_failing, change.new_worlds, confidence.shared(4.0)) -
                       upper_bound(change.old_failing, change.old_worlds, confidence.shared(4.0));
  return {0.0, lower, upper(4.0), upper(2.0)};
}

void judge_counts(EndPointChange& change, Confidence confidence) {
  if (change.pairs) {
    change.worse_p = mcnemar_exact(change.pairs->only_old, change.pairs->only_new).new_worse;
    change.improved_p = mcnemar_exact(change.pairs->only_new, change.pairs->only_old).new_worse;
    take_difference(change, paired_difference(*change.pairs, confidence));
  } else {
    const FisherResult fisher =
        fisher_exact(change.old_failing, change.old_worlds, change.new_failing, change.new_worlds);
    change.worse_p = fisher.first_smaller;
    change.improved_p = fisher.first_larger;
    take_difference(change, unpaired_difference(change, confidence));
  }
}

Change change_of(const EndPointChange& change, const ComparisonRule& rule) {
  const double risk = Confidence(rule.confidence).risk();
  if (change.worse_p <= risk) return Change::Worse;
  if (change.improved_p <= risk) return Change::Improved;
  return change.one_sided_upper <= rule.margin ? Change::NotWorse : Change::CannotTell;
}

// As many times the worlds, with the same shares, until the comparison can tell.
std::optional<std::uint64_t> worlds_needed(const EndPointChange& change, const ComparisonRule& rule) {
  constexpr std::uint64_t kMostTimes = 4096;
  const auto tells = [&](std::uint64_t times) {
    EndPointChange more = change;
    for (auto* count : {&more.old_failing, &more.old_worlds, &more.new_failing, &more.new_worlds}) *count *= times;
    if (more.pairs) {
      for (auto* count : {&more.pairs->both, &more.pairs->only_old, &more.pairs->only_new, &more.pairs->neither})
        *count *= times;
    }
    judge_counts(more, rule.confidence);
    return change_of(more, rule) != Change::CannotTell;
  };
  std::uint64_t times = 1;
  while (times <= kMostTimes && !tells(times)) times *= 2;
  if (times > kMostTimes) return std::nullopt;
  std::uint64_t low = times / 2;
  while (times - low > 1) {
    const std::uint64_t middle = low + (times - low) / 2;
    (tells(middle) ? times : low) = middle;
  }
  return times * std::min(change.old_worlds, change.new_worlds);
}

EndPointChange change_at(const ReleaseRuns& a, const ReleaseRuns& b, std::size_t end_point, bool paired,
                         const ComparisonRule& rule) {
  const std::size_t common = std::min(a.replicates.size(), b.replicates.size());
  EndPointChange change;
  change.end_point = kComparedEndPoints[end_point];
  change.old_worlds = paired ? common : a.replicates.size();
  change.new_worlds = paired ? common : b.replicates.size();
  change.old_failing = failing_worlds(a, end_point, change.old_worlds);
  change.new_failing = failing_worlds(b, end_point, change.new_worlds);
  if (paired) change.pairs = count_pairs(a, b, end_point, common);
  if (common == 0) return change;
  judge_counts(change, rule.confidence);
  change.change = change_of(change, rule);
  if (change.change == Change::CannotTell) change.worlds_needed = worlds_needed(change, rule);
  return change;
}

double transports_per_agv_hour(const Replicate& replicate) {
  std::uint64_t done = 0, agv_us = 0;
  for (const ComparedRun& run : replicate) done += run.transports_done, agv_us += run.agv_us;
  return agv_us == 0 ? 0.0 : static_cast<double>(done) / agv_hours(agv_us);
}

double mean_throughput(const ReleaseRuns& release, std::size_t worlds) {
  double sum = 0.0;
  for (std::size_t i = 0; i < worlds; ++i) sum += transports_per_agv_hour(release.replicates[i]);
  return worlds == 0 ? 0.0 : sum / static_cast<double>(worlds);
}

void compare_runs(Comparison& comparison, const ReleaseRuns& a, const ReleaseRuns& b) {
  std::vector<CellChange> cells;
  for (const CellRecord& cell : b.cells) cells.push_back({cell, 0, 0});
  for (std::size_t world = 0; world < comparison.worlds; ++world) {
    const double before = transports_per_agv_hour(a.replicates[world]),
                 now = transports_per_agv_hour(b.replicates[world]);
    comparison.slower_worlds += now < before ? 1 : 0;
    comparison.faster_worlds += now > before ? 1 : 0;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const ComparedRun &was = a.replicates[world][cell], &is = b.replicates[world][cell];
      if (was.is_clean() == is.is_clean()) continue;
      (is.is_clean() ? comparison.newly_passing : comparison.newly_failing).push_back(is.run_index);
      ++(is.is_clean() ? cells[cell].only_old : cells[cell].only_new);
    }
  }
  std::ranges::copy_if(cells, std::back_inserter(comparison.cells),
                       [](const CellChange& cell) { return cell.only_old + cell.only_new > 0; });
}

}  // namespace

const char* name_of(Change change) {
  switch (change) {
    case Change::Improved:
      return "improved";
    case Change::NotWorse:
      return "not worse within the margin";
    case Change::Worse:
      return "worse";
    case Change::CannotTell:
      return "cannot tell";
  }
  invariant_violated("a change has a name");
}

bool Comparison::any(Change change) const {
  return std::ranges::find(end_points, change, &EndPointChange::change) != end_points.end();
}

Comparison compare(const ReleaseRuns& old_release, const ReleaseRuns& new_release, const ComparisonRule& rule) {
  Comparison comparison;
  comparison.old_agent = old_release.agent;
  comparison.new_agent = new_release.agent;
  comparison.why_unpaired = obstacle_to_pairs(old_release, new_release);
  comparison.paired = comparison.why_unpaired.empty();
  comparison.worlds = std::min(old_release.replicates.size(), new_release.replicates.size());
  for (std::size_t i = 0; i < kComparedEndPoints.size(); ++i)
    comparison.end_points.push_back(change_at(old_release, new_release, i, comparison.paired, rule));
  const bool paired = comparison.paired;
  comparison.old_transports_per_agv_hour =
      mean_throughput(old_release, paired ? comparison.worlds : old_release.replicates.size());
  comparison.new_transports_per_agv_hour =
      mean_throughput(new_release, paired ? comparison.worlds : new_release.replicates.size());
  if (paired) compare_runs(comparison, old_release, new_release);
  return comparison;
}

}  // namespace fleetproof
