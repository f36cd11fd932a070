#pragma once

#include <cstdint>
#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/outcome/trace.hpp"
#include "storage/archive.hpp"

namespace fleetproof {

enum class ReplayVerdict : std::uint8_t { Reproduced, Diverged, ScenarioDiffers };
const char* name_of(ReplayVerdict verdict);  // REPRODUCED, DIVERGED

struct ReplayResult {
  ReplayVerdict verdict = ReplayVerdict::Reproduced;
  std::string explanation;  // which value differs and, for a trace, between which events
  RunRecord stored, recomputed;
};

// Simulates run `run_index` again from the plan in the archive and compares with what was stored, value by value.
// Throws InputError if the archive has no such run (or names an agent that is not loaded).
ReplayResult replay(const ArchiveReader& archive, std::uint64_t run_index, const AgentPrograms& programs,
                    TraceSink* sink = nullptr);

// What differs between a stored and a recomputed record of one run; also usable on its own.
ReplayResult compare_runs(RunRecord stored, RunRecord recomputed);

}  // namespace fleetproof
