#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/replay.hpp"

namespace fleetproof {

// How many of `runs` stored runs "1%" (rounded up) or "200" asks for. All runs, if there are fewer. Throws InputError.
std::uint64_t sample_size(const std::string& text, std::uint64_t runs);

// `size` of the runs 0 to runs - 1, in order: one run of each of `size` strata of equal length. The same key draws
// the same runs. Requires: size <= runs.
std::vector<std::uint64_t> sample_of_runs(std::uint64_t key, std::uint64_t runs, std::uint64_t size);

// A stored run that came out differently now.
struct Disagreement {
  std::uint64_t run_index = 0;
  std::string agent;
  ReplayVerdict verdict = ReplayVerdict::Diverged;
  std::string explanation;
  // The same program made both runs, and no plug-in that is not trusted decided what differs.
  bool engine_at_fault = false;
};

struct Verification {
  std::uint64_t agreeing = 0;
  std::vector<Disagreement> differing;  // in order of run index
};

// Simulates these runs of the results file again, on `workers` threads, and compares each with its row. Agents of
// plug-ins run in worker processes. `go_on` hears how many are done; once it says no, the result has those that were
// compared until then. Requires: `plan` is the plan in the file. Throws what ArchiveReader and RunHost throw.
Verification verify_runs(const std::string& path, const CampaignPlan& plan, const AgentPrograms& programs,
                         const std::vector<std::uint64_t>& sample, int workers,
                         const std::function<bool(std::size_t done)>& go_on);

}  // namespace fleetproof
