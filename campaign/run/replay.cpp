#include "campaign/run/replay.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "campaign/plan/plan_text.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/engine_identity.hpp"
#include "campaign/run/run_one.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "storage/checksum.hpp"

namespace fleetproof {
namespace {

// Running digest k covers the events up to and including number 2^k.
std::string bracket(const Outcome& stored, const Outcome& recomputed) {
  const std::size_t common = std::min(stored.running_digests.size(), recomputed.running_digests.size());
  std::size_t same = 0;
  while (same < common && stored.running_digests[same] == recomputed.running_digests[same]) ++same;
  const std::uint64_t after = same == 0 ? 0 : std::uint64_t{1} << (same - 1);
  const std::uint64_t until =
      same < common ? std::uint64_t{1} << same : std::max(stored.counters.events, recomputed.counters.events);
  return fmt::format("the traces part after event {} and not later than event {}", after, until);
}

std::string first_difference(const Outcome& stored, const Outcome& recomputed) {
  if (stored.digest != recomputed.digest) {
    return fmt::format("trace digest: stored {:016x}, recomputed {:016x}; {}", stored.digest, recomputed.digest,
                       bracket(stored, recomputed));
  }
  if (stored.running_digests != recomputed.running_digests) return "running digests: " + bracket(stored, recomputed);
  if (stored.outcome_class() != recomputed.outcome_class()) {
    return fmt::format("outcome: stored {}, recomputed {}", name_of(stored.outcome_class()),
                       name_of(recomputed.outcome_class()));
  }
  if (stored.violations.size() != recomputed.violations.size()) {
    return fmt::format("violations: stored {}, recomputed {}", stored.violations.size(), recomputed.violations.size());
  }
  const auto pair = std::ranges::mismatch(stored.violations, recomputed.violations);
  if (pair.in1 != stored.violations.end()) return fmt::format("violation {}", pair.in1 - stored.violations.begin());
  if (stored.incidents.size() != recomputed.incidents.size()) {
    return fmt::format("incidents: stored {}, recomputed {}", stored.incidents.size(), recomputed.incidents.size());
  }
  const auto incident = std::ranges::mismatch(stored.incidents, recomputed.incidents);
  if (incident.in1 != stored.incidents.end())
    return fmt::format("incident {}", incident.in1 - stored.incidents.begin());
  if (stored.probes != recomputed.probes) return "what the run met";
  if (stored.min_clearance_um != recomputed.min_clearance_um) return "smallest clearance";
  if (!(stored.counters == recomputed.counters)) return "counters";
  return "end points";
}

// "loss 0.4, delay_s 2, ...": with all digits, as one may be the difference.
std::string all_digits(const FactorValues& factors) {
  std::string text;
  for (const FactorInfo& factor : kFactors)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", factor.key, factors[factor.id]);
  return text;
}

ReplayResult of_intact_plan(ReplayResult result, const CampaignRecord& campaign) {
  if (name_hash(campaign.plan_json) == campaign.plan_hash) return result;
  result.explanation = "the plan in the file was changed: its hash no longer matches" +
                       (result.explanation.empty() ? "" : "; " + result.explanation);
  if (result.verdict == ReplayVerdict::Reproduced) result.verdict = ReplayVerdict::ScenarioDiffers;
  return result;
}

}  // namespace

const char* name_of(ReplayVerdict verdict) {
  switch (verdict) {
    case ReplayVerdict::Reproduced:
      return "REPRODUCED";
    case ReplayVerdict::SoftwareDiffers:
      return "SOFTWARE DIFFERS";
    case ReplayVerdict::NotDeterministic:
      return "NOT DETERMINISTIC";
    case ReplayVerdict::Diverged:
    case ReplayVerdict::ScenarioDiffers:
      return "DIVERGED";
  }
  invariant_violated("a verdict of a replay has a name");
}

namespace {

// Appends the digest that follows each occurrence of `words` in `text`, if it is not in the list yet.
void add_digests(std::string_view text, const std::string& words, std::vector<std::string>& digests) {
  constexpr std::string_view kName = "sha256 ";
  constexpr std::size_t kDigits = 64;
  for (auto at = text.find(words); at != std::string_view::npos; at = text.find(words, at + 1)) {
    const auto name = text.find(kName, at);
    if (name == std::string_view::npos) return;
    std::string digest(text.substr(name + kName.size(), kDigits));
    if (std::ranges::find(digests, digest) == digests.end()) digests.push_back(std::move(digest));
  }
}

}  // namespace

std::vector<std::string> stored_plugins(const EngineIdentity& stored, const std::string& program) {
  std::vector<std::string> digests;
  add_digests(stored.libraries, "plug-in " + program + " sha256 ", digests);
  return digests;
}

std::string software_difference(const EngineIdentity& stored, const std::vector<const AgentProgram*>& parts) {
  for (const AgentProgram* part : parts) {
    if (part->is_built_in()) continue;
    const auto then = stored_plugins(stored, part->innermost().name);
    if (then != std::vector{part->source.sha256})
      return fmt::format("the software differs (plug-in {}: sha256 {} then, {} now)", part->name,
                         then.empty() ? "unknown" : fmt::format("{}", fmt::join(then, " and ")), part->source.sha256);
  }
  const EngineIdentity now = engine_identity();
  std::vector<std::string> then{stored.program_sha256};
  add_digests(stored.libraries, "begun by fleetproof ", then);
  if (then == std::vector{now.program_sha256}) return "";
  return fmt::format("the software differs (fleetproof {}: sha256 {} then, {}: {} now)", stored.version,
                     fmt::join(then, " and "), now.version, now.program_sha256);
}

ReplayResult compare_runs(RunRecord stored, RunRecord recomputed) {
  ReplayResult result;
  if (stored.scenario_digest != recomputed.scenario_digest) {
    result.verdict = ReplayVerdict::ScenarioDiffers;
    result.explanation = fmt::format("the scenario differs: digest stored {:016x}, recomputed {:016x}",
                                     stored.scenario_digest, recomputed.scenario_digest);
  } else if (stored.cell != recomputed.cell || stored.replicate != recomputed.replicate) {
    result.verdict = ReplayVerdict::ScenarioDiffers;
    result.explanation = fmt::format("cell or replicate: stored {} and {}, recomputed {} and {}", stored.cell,
                                     stored.replicate, recomputed.cell, recomputed.replicate);
  } else if (stored.factors != recomputed.factors) {
    result.verdict = ReplayVerdict::ScenarioDiffers;
    result.explanation = fmt::format("the factors of the run: stored {}; recomputed {}", all_digits(stored.factors),
                                     all_digits(recomputed.factors));
  } else if (!(stored.outcome == recomputed.outcome)) {
    result.verdict = ReplayVerdict::Diverged;
    result.explanation = first_difference(stored.outcome, recomputed.outcome);
  }
  result.stored = std::move(stored);
  result.recomputed = std::move(recomputed);
  return result;
}

AuditCount audits_of(const ArchiveReader& archive, const CampaignPlan& plan, const AgentFactor& agent) {
  AuditCount count;
  archive.for_each_audit([&](const AuditRecord& audit, bool same) {
    if (plan.agent_of_cell(audit.run_index).name != agent.name) return;
    ++count.audited;
    count.differing += same ? 0 : 1;
  });
  return count;
}

bool is_trusted(bool is_plugin, bool is_deterministic, const AuditCount& audits) {
  if (!is_plugin) return true;
  return is_deterministic && audits.audited >= kAuditsToPass && audits.differing == 0;
}

namespace {

std::string why_not_trusted(bool is_deterministic, const AuditCount& audits) {
  if (audits.differing > 0)
    return fmt::format("{} of {} audited runs of this agent came out differently, too", audits.differing,
                       audits.audited);
  if (!is_deterministic) return "the agent does not declare that it is deterministic (FP_DETERMINISTIC)";
  return fmt::format("{} runs of this agent were audited, which is too few", audits.audited);
}

void require_run(const CampaignPlan& plan, std::uint64_t run_index) {
  if (run_index >= plan.run_count())
    throw InputError("run",
                     fmt::format("{} does not exist; the campaign has runs 0 to {}", run_index, plan.run_count() - 1));
}

[[noreturn]] void throw_not_stored(const ArchiveReader& archive, const CampaignPlan& plan, std::uint64_t run_index) {
  throw InputError("run", fmt::format("{} is not in the file; it holds runs 0 to {} of {} planned", run_index,
                                      archive.run_count() - 1, plan.run_count()));
}

ReplayResult compare_folded(KnownRun known, RunRecord recomputed) {
  ReplayResult result;
  if (static_cast<std::uint16_t>(row_checksum(recomputed)) == known.check) {
    result.explanation =
        "the file has no row of this run: nothing went wrong in it, and it is folded; the 16 bits that "
        "are kept of its checksum match";
    result.stored = recomputed;
  } else {
    result.verdict = ReplayVerdict::Diverged;
    result.explanation =
        "the file has no row of this run: nothing went wrong in it, and it is folded; the 16 bits that "
        "are kept of its checksum do not match";
    result.stored = std::move(known.run);
  }
  result.recomputed = std::move(recomputed);
  return result;
}

ReplayResult compare_with_file(const ArchiveReader& archive, const CampaignPlan& plan, std::uint64_t run_index,
                               const Resimulate& simulate) {
  require_run(plan, run_index);
  if (auto stored = archive.run(run_index)) return compare_runs(*std::move(stored), simulate(run_index));
  if (auto known = archive.folded_run(run_index)) return compare_folded(*std::move(known), simulate(run_index));
  throw_not_stored(archive, plan, run_index);
}

}  // namespace

ReplayResult replay(const ArchiveReader& archive, std::uint64_t run_index, const AgentPrograms& programs,
                    TraceSink* sink, const RunWatch& watch) {
  const CampaignPlan plan = parse_plan(archive.campaign().plan_json);
  return replay(archive, plan, run_index, programs,
                [&](std::uint64_t index) { return RunOne(plan, programs)(index, sink, watch); });
}

std::optional<ReplayResult> replay_recording(const ArchiveReader& archive, const CampaignPlan& plan,
                                             std::uint64_t run_index, TraceSink* sink) {
  require_run(plan, run_index);
  const auto recording = archive.recording(run_index);
  if (!recording) return std::nullopt;
  auto stored = archive.run(run_index);
  if (!stored) throw_not_stored(archive, plan, run_index);
  RunWatch watch;
  watch.play = *recording;
  const AgentPrograms none;
  ReplayResult result = compare_runs(*std::move(stored), RunOne(plan, none)(run_index, sink, watch));
  result.from_recording = true;
  return of_intact_plan(std::move(result), archive.campaign());
}

ReplayResult replay(const ArchiveReader& archive, const CampaignPlan& plan, std::uint64_t run_index,
                    const AgentPrograms& programs, const Resimulate& simulate) {
  ReplayResult result = compare_with_file(archive, plan, run_index, simulate);
  if (result.verdict == ReplayVerdict::Reproduced) return of_intact_plan(std::move(result), archive.campaign());
  const AgentFactor& factor = plan.agent_of_cell(run_index);
  if (const auto difference = software_difference(archive.campaign().engine, programs.parts_of(factor, "replay"));
      !difference.empty()) {
    result.verdict = ReplayVerdict::SoftwareDiffers;
    result.explanation = difference + "; " + result.explanation;
  } else if (result.verdict == ReplayVerdict::Diverged) {
    const AuditCount audits = audits_of(archive, plan, factor);
    const bool is_deterministic = programs.is_deterministic(factor);
    if (!is_trusted(programs.needs_worker(factor), is_deterministic, audits)) {
      result.verdict = ReplayVerdict::NotDeterministic;
      result.explanation += "; " + why_not_trusted(is_deterministic, audits);
    }
  }
  return of_intact_plan(std::move(result), archive.campaign());
}

}  // namespace fleetproof
