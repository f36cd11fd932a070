#include "campaign/run/release.hpp"

#include <algorithm>
#include <vector>

#include "campaign/plan/default_gates.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/run/engine_identity.hpp"
#include "campaign/run/sha256.hpp"
#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// The length before each text: no two different lists have the same bytes.
void add(std::string& bytes, const std::string& text) { bytes += std::to_string(text.size()) + ":" + text; }

constexpr std::uint64_t kLargestSeed = 0x7fff'ffff'ffff'ffff;  // as a campaign file can hold it

}  // namespace

std::string release_digest(const CampaignPlan& plan, const AgentPrograms& programs) {
  std::vector<bool> is_plugin;
  for (const AgentFactor& agent : plan.agents) is_plugin.push_back(programs.needs_worker(agent));
  const std::vector<std::string> judged = agents_under_test(plan, is_plugin);
  std::string bytes;
  for (const AgentFactor& agent : plan.agents) {
    if (std::ranges::find(judged, agent.name) == judged.end()) continue;
    add(bytes, agent.name);
    for (const ProgramPart* part : agent.parts()) {
      const AgentProgram& program = programs.program(part->program, "factors.agents");
      if (program.inside != nullptr) add(bytes, program.name);
      add(bytes, program.is_built_in() ? engine_identity().program_sha256 : program.source.sha256);
      add(bytes, plan.config_of(*part));
    }
  }
  return sha256_hex(bytes);
}

std::uint64_t fresh_seed(const CampaignPlan& plan, const AgentPrograms& programs) {
  CampaignPlan bare = plan;
  bare.seed = 0;
  bare.name.clear();
  bare.replicates = 1;
  return name_hash(release_digest(plan, programs) + plan_text(bare)) & kLargestSeed;
}

}  // namespace fleetproof
