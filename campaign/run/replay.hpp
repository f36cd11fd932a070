#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/engine/run_watch.hpp"
#include "core/outcome/trace.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof {

// SoftwareDiffers: the outcome is another one, and so is the program or the plug-in. NotDeterministic: the outcome is
// another one, and nothing shows that the agent always does the same (see is_trusted).
enum class ReplayVerdict : std::uint8_t { Reproduced, Diverged, ScenarioDiffers, SoftwareDiffers, NotDeterministic };
const char* name_of(ReplayVerdict verdict);  // REPRODUCED, DIVERGED, SOFTWARE DIFFERS, NOT DETERMINISTIC

struct ReplayResult {
  ReplayVerdict verdict = ReplayVerdict::Reproduced;
  std::string explanation;      // which value differs and, for a trace, between which events
  bool from_recording = false;  // not by the agents' software
  RunRecord stored, recomputed;
};

// Compares run `run_index` of the archive with what `simulate` gives for it now, one value after the other; a folded
// run by 16 bits of its checksum. Throws InputError if the archive has no such run.
using Resimulate = std::function<RunRecord(std::uint64_t run_index)>;
ReplayResult replay(const ArchiveReader& archive, const CampaignPlan& plan, std::uint64_t run_index,
                    const AgentPrograms& programs, const Resimulate& simulate);
// The same with the plan in the archive, on this thread. Throws InputError if the agent of the run is not known.
// Requires: a plug-in is loaded.
ReplayResult replay(const ArchiveReader& archive, std::uint64_t run_index, const AgentPrograms& programs,
                    TraceSink* sink = nullptr, const RunWatch& watch = {});
// The same from what the agents did, as the archive recorded it: their software is not needed. Empty: the archive has
// no recording of this run.
std::optional<ReplayResult> replay_recording(const ArchiveReader& archive, const CampaignPlan& plan,
                                             std::uint64_t run_index, TraceSink* sink = nullptr);

// How many runs of one agent the campaign audited, and how many came out differently.
struct AuditCount {
  std::uint64_t audited = 0, differing = 0;
};
AuditCount audits_of(const ArchiveReader& archive, const CampaignPlan& plan, const AgentFactor& agent);

// Whether another outcome of the same run is the fault of the engine. A reference agent always does the same; a plug-in
// does if it promises so (FP_DETERMINISTIC) and its audits bear that out.
bool is_trusted(bool is_plugin, bool is_deterministic, const AuditCount& audits);

// The SHA-256 digests that the archive stores of the shared object with this agent. There are several if sessions with
// different builds wrote to it. Empty: the archive does not know the agent as a plug-in.
std::vector<std::string> stored_plugins(const EngineIdentity& stored, const std::string& program);

// How the software that made a run differs from the software at hand: "the software differs (...)"; empty: it is the
// same. Where several engines wrote to the archive, nobody knows which of them made the run.
std::string software_difference(const EngineIdentity& stored, const std::vector<const AgentProgram*>& parts);

// What differs between the stored record of a run and its recomputed record.
ReplayResult compare_runs(RunRecord stored, RunRecord recomputed);

}  // namespace fleetproof
