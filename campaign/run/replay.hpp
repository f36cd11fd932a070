#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/outcome/trace.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof {

// SoftwareDiffers: the outcome is another one, and so is the program or the plug-in.
enum class ReplayVerdict : std::uint8_t { Reproduced, Diverged, ScenarioDiffers, SoftwareDiffers };
const char* name_of(ReplayVerdict verdict);  // REPRODUCED, DIVERGED, SOFTWARE DIFFERS

struct ReplayResult {
  ReplayVerdict verdict = ReplayVerdict::Reproduced;
  std::string explanation;  // which value differs and, for a trace, between which events
  RunRecord stored, recomputed;
};

// Compares run `run_index` of the archive with what `simulate` gives for it now, one value after the other. Throws
// InputError if the archive has no such run.
using Resimulate = std::function<RunRecord(std::uint64_t run_index)>;
ReplayResult replay(const ArchiveReader& archive, const CampaignPlan& plan, std::uint64_t run_index,
                    const AgentPrograms& programs, const Resimulate& simulate);
// The same with the plan in the archive, on this thread. Throws InputError if the agent of the run is not loaded.
ReplayResult replay(const ArchiveReader& archive, std::uint64_t run_index, const AgentPrograms& programs,
                    TraceSink* sink = nullptr);

// Where the cause of a diverged replay may lie: the agent may have promised to be deterministic (FP_DETERMINISTIC).
std::string_view suspects_of(const AgentProgram& agent);

// How the software that made a run differs from the software at hand: "the software differs (...)"; empty: it is the
// same.
std::string software_difference(const EngineIdentity& stored, const AgentProgram& agent);

// What differs between the stored record of a run and its recomputed record.
ReplayResult compare_runs(RunRecord stored, RunRecord recomputed);

}  // namespace fleetproof
