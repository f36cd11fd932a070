#include "reports/comparison/release_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "reports/evidence/confidence.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/evidence/paired_sequence.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

using Replicate = std::vector<ComparedRun>;

// ---- conditions

bool same_conditions(const CellRecord& a, const CellRecord& b) {
  return a.layout == b.layout && a.fleet_size == b.fleet_size && a.lowest == b.lowest && a.highest == b.highest;
}

// The part of a plan that shapes worlds and judgement, but for the seed.
SortedJson conditions_of(const std::string& plan_json) {
  SortedJson plan = read_sorted_json(plan_json);
  if (!plan.is_object()) return plan_json;
  for (const char* key :
       {"name", "seed", "replicates", "gates", "default_gates", "audit", "keep", "agent_config", "coverage"})
    plan.erase(key);
  if (plan.contains("factors") && plan["factors"].is_object()) plan["factors"].erase("agents");
  return plan;
}

// "horizon_s", for each field of the plans that differs: the outermost one that both have.
std::vector<std::string> other_conditions(const ReleaseRuns& a, const ReleaseRuns& b) {
  constexpr std::size_t kMostConditions = 8;
  std::vector<std::string> list;
  if (a.campaign.engine.version != b.campaign.engine.version) list.emplace_back("the version of fleetproof");
  if (!std::ranges::equal(a.cells, b.cells, same_conditions)) list.emplace_back("the cells");
  const SortedJson patch = SortedJson::diff(conditions_of(a.campaign.plan_json), conditions_of(b.campaign.plan_json));
  for (const auto& change : patch) {
    std::string field = change.at("path").get<std::string>();
    if (field.starts_with('/')) field.erase(0, 1);
    std::ranges::replace(field, '/', '.');
    if (std::ranges::find(list, field) == list.end()) list.push_back(field.empty() ? "the plan" : field);
  }
  if (list.size() > kMostConditions) {
    const std::size_t more = list.size() - kMostConditions;
    list.resize(kMostConditions);
    list.push_back(fmt::format("{} more", more));
  }
  return list;
}

// ---- doubts

void doubt(std::vector<std::string>& doubts, const char* which, const ReleaseRuns& release) {
  if (release.differing > 0)
    doubts.push_back(fmt::format("{} of {} audited runs of the {} release came out differently", release.differing,
                                 release.audited, which));
  if (has_several_programs(release.campaign.engine))
    doubts.push_back(fmt::format("more than one program made the runs of the {} release", which));
  const auto delivered = [](const Replicate& replicate) {
    return std::ranges::any_of(replicate, [](const ComparedRun& run) { return run.transports_done > 0; });
  };
  if (!release.replicates.empty() && std::ranges::none_of(release.replicates, delivered))
    doubts.push_back(fmt::format("the {} release completed no transport: a parked fleet is safe and useless", which));
  if (release.has_unplaced_repeats)
    doubts.push_back(fmt::format(
        "the file of the {} release does not say which of its runs repeat others; run it with this version", which));
}

// What is asked of a campaign beside its worlds, as its plan says it.
bool has_default_gates(const ReleaseRuns& release) {
  const SortedJson plan = read_sorted_json(release.campaign.plan_json);
  return !plan.is_object() || !plan.contains("default_gates") || plan["default_gates"] != false;
}

bool is_weak(const ReleaseRuns& release) {
  return std::ranges::find(release.head, "weak", &Headline::word) != release.head.end();
}

// Where less was asked of one release than of the other, what it did not fail in proves less.
void doubt_laxer(std::vector<std::string>& doubts, const char* which, const ReleaseRuns& release,
                 const ReleaseRuns& other) {
  std::vector<std::string> probes;
  std::ranges::copy_if(other.campaign.required_probes, std::back_inserter(probes), [&](const std::string& probe) {
    return std::ranges::find(release.campaign.required_probes, probe) == release.campaign.required_probes.end();
  });
  if (!probes.empty())
    doubts.push_back(fmt::format("the {} release did not have to meet {}, and the other did", which,
                                 printable(joined(probes), 200)));
  if (release.campaign.audit_share < other.campaign.audit_share)
    doubts.push_back(fmt::format("{} of the runs of the {} release were to be audited, and {} of the other's",
                                 percent(release.campaign.audit_share), which, percent(other.campaign.audit_share)));
  if (!has_default_gates(release) && has_default_gates(other))
    doubts.push_back(fmt::format("the {} release leaves the default gates out, and the other does not", which));
  if (is_weak(release) && !is_weak(other))
    doubts.push_back(fmt::format("the evidence of the {} release is weak, and that of the other is not", which));
}

// ---- worlds

RunResult result_of_world(const Replicate& replicate, std::size_t end_point) {
  RunResult worst = RunResult::Passed;
  for (const ComparedRun& run : replicate) {
    if (run.results[end_point] == RunResult::Failed) return RunResult::Failed;
    if (run.results[end_point] == RunResult::Unknown) worst = RunResult::Unknown;
  }
  return worst;
}

struct Work {
  std::uint64_t transports_done = 0, agv_us = 0;

  explicit Work(const Replicate& replicate) {
    for (const ComparedRun& run : replicate) transports_done += run.transports_done, agv_us += run.agv_us;
  }
  double rate() const { return agv_us == 0 ? 0.0 : static_cast<double>(transports_done) / agv_hours(agv_us); }
  // Less than 90 % of what the other one does in an hour.
  bool is_slower_than(const Work& other) const {
    __extension__ using Wide = unsigned __int128;
    return Wide{transports_done} * other.agv_us * 10 < Wide{other.transports_done} * agv_us * 9;
  }
};

// A run of which nobody knows how it went on has no time.
bool is_known(const Replicate& replicate) {
  return std::ranges::none_of(replicate, [](const ComparedRun& run) { return run.agv_us == 0; });
}

// The two releases in each world, at one end point.
struct World {
  RunResult before = RunResult::Passed, now = RunResult::Passed;
  bool is_new = true;

  bool failed_only_now() const { return now == RunResult::Failed && before != RunResult::Failed; }
  bool failed_only_before() const { return before == RunResult::Failed && now != RunResult::Failed; }
};

// The difference as it speaks most for the old release, or for the new one: what is unknown may have been anything.
WorldDifference difference(const World& world, bool for_old) {
  const auto counts = [](RunResult result, bool unknown_too) {
    return result == RunResult::Failed || (unknown_too && result == RunResult::Unknown) ? 1 : 0;
  };
  return {counts(world.now, for_old) - counts(world.before, !for_old), world.is_new};
}

bool is_new(const Replicate& replicate) {
  return std::ranges::any_of(replicate, [](const ComparedRun& run) { return !run.repeats; });
}

std::vector<World> worlds_at(const ReleaseRuns& a, const ReleaseRuns& b, EndPoint end_point, std::size_t position) {
  std::vector<World> worlds(std::min(a.replicates.size(), b.replicates.size()));
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const Replicate &before = a.replicates[i], &now = b.replicates[i];
    World& world = worlds[i];
    world.is_new = is_new(before) && is_new(now);
    if (end_point == EndPoint::Throughput) {
      const Work work_before(before), work_now(now);
      if (work_now.is_slower_than(work_before)) world.now = RunResult::Failed;
      if (work_before.is_slower_than(work_now)) world.before = RunResult::Failed;
      if (!is_known(now)) world.now = RunResult::Unknown;
      if (!is_known(before)) world.before = RunResult::Unknown;
    } else {
      world.before = result_of_world(before, position);
      world.now = result_of_world(now, position);
    }
  }
  return worlds;
}

// ---- the rule

struct Claims {
  PairedSequence worse = PairedSequence::worse(), improved = PairedSequence::improved(), not_worse;

  explicit Claims(double margin) : not_worse(PairedSequence::not_worse_by(margin)) {}
  void add(const World& world) {
    worse.add(difference(world, false));
    improved.add(difference(world, true));
    not_worse.add(difference(world, true));
  }
  Change change(double risk, bool in_doubt) const {
    if (worse.shows(risk)) return Change::Worse;
    if (in_doubt) return Change::CannotTell;
    if (improved.shows(risk)) return Change::Improved;
    return not_worse.shows(risk) ? Change::NotWorse : Change::CannotTell;
  }
};

// The same worlds again and again, as if each were new, until the comparison can tell.
std::optional<std::uint64_t> worlds_needed(const std::vector<World>& worlds, const ComparisonRule& rule, double risk) {
  constexpr std::uint64_t kMostTimes = 4096, kMostWorlds = 10'000'000;
  if (worlds.empty()) return std::nullopt;
  Claims claims(rule.margin);
  for (std::uint64_t done = 0; done < std::min(kMostWorlds, kMostTimes * worlds.size());) {
    World next = worlds[done % worlds.size()];
    next.is_new = true;
    claims.add(next);
    ++done;
    if (claims.change(risk, false) != Change::CannotTell) return done;
  }
  return std::nullopt;
}

EndPointChange change_at(const std::vector<World>& worlds, EndPoint end_point, const Comparison& comparison,
                         const ComparisonRule& rule) {
  const double risk = Confidence(rule.confidence).risk();
  EndPointChange change;
  change.end_point = end_point;
  Claims claims(rule.margin);
  std::vector<WorldDifference> growth, shrinkage;
  for (const World& world : worlds) {
    claims.add(world);
    growth.push_back(difference(world, true));
    const WorldDifference least = difference(world, false);
    shrinkage.push_back({-least.value, least.is_new});
    change.only_old += world.failed_only_before() ? 1 : 0;
    change.only_new += world.failed_only_now() ? 1 : 0;
    for (const auto& [result, counts] : {std::pair{world.before, &change.before}, {world.now, &change.now}}) {
      counts->failed += result == RunResult::Failed ? 1 : 0;
      counts->unknown += result == RunResult::Unknown ? 1 : 0;
    }
  }
  change.upper = difference_upper(growth, risk);
  change.lower = -difference_upper(shrinkage, risk);
  if (!comparison.other_conditions.empty()) return change;
  change.change = claims.change(risk, !comparison.doubts.empty());
  if (change.change == Change::CannotTell && comparison.doubts.empty())
    change.worlds_needed = worlds_needed(worlds, rule, risk);
  return change;
}

// ---- what is told beside it

double mean_throughput(const ReleaseRuns& release, std::size_t worlds) {
  double sum = 0.0;
  for (std::size_t i = 0; i < worlds; ++i) sum += Work(release.replicates[i]).rate();
  return worlds == 0 ? 0.0 : sum / static_cast<double>(worlds);
}

bool fails_newly(const ComparedRun& was, const ComparedRun& is) {
  for (std::size_t i = 0; i < is.results.size(); ++i) {
    if (is.results[i] == RunResult::Failed && was.results[i] != RunResult::Failed) return true;
  }
  return false;
}

void compare_runs(Comparison& comparison, const ReleaseRuns& a, const ReleaseRuns& b) {
  std::vector<CellChange> cells;
  for (const CellRecord& cell : b.cells) cells.push_back({cell, 0, 0});
  for (std::size_t world = 0; world < comparison.worlds; ++world) {
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const ComparedRun &was = a.replicates[world][cell], &is = b.replicates[world][cell];
      if (fails_newly(was, is)) {
        comparison.newly_failing.push_back(is.run_index);
        ++cells[cell].only_new;
      } else if (is.is_clean() && !was.is_clean()) {
        comparison.newly_passing.push_back(is.run_index);
        ++cells[cell].only_old;
      }
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
  comparison.other_conditions = other_conditions(old_release, new_release);
  doubt(comparison.doubts, "old", old_release);
  doubt(comparison.doubts, "new", new_release);
  doubt_laxer(comparison.doubts, "old", old_release, new_release);
  doubt_laxer(comparison.doubts, "new", new_release, old_release);
  comparison.same_worlds =
      comparison.other_conditions.empty() && old_release.campaign.seed == new_release.campaign.seed;
  comparison.worlds = std::min(old_release.replicates.size(), new_release.replicates.size());
  for (std::size_t i = 0; i < kComparedEndPoints.size(); ++i) {
    const EndPoint end_point = kComparedEndPoints[i];
    comparison.end_points.push_back(
        change_at(worlds_at(old_release, new_release, end_point, i), end_point, comparison, rule));
  }
  comparison.old_transports_per_agv_hour = mean_throughput(old_release, comparison.worlds);
  comparison.new_transports_per_agv_hour = mean_throughput(new_release, comparison.worlds);
  if (comparison.same_worlds) compare_runs(comparison, old_release, new_release);
  return comparison;
}

}  // namespace fleetproof
