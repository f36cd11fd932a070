#include "core/engine/simulation.hpp"

#include <cstddef>

#include "core/base/error.hpp"
#include "core/engine/engine.hpp"
#include "core/sdk/agent_table.hpp"

namespace fleetproof {
namespace {

// Of a table of minor version 0, which ended with `destroy`.
constexpr std::size_t kOldestTypeSize = offsetof(fp_agent_type, destroy) + sizeof(fp_agent_type::destroy);

}  // namespace

void check_abi(const fp_agent_type& agent) {
  if (agent.struct_size < kOldestTypeSize || agent.abi_major != FP_ABI_MAJOR) {
    throw InputError("agent", "speaks another version of fleetproof/agent.h (this program: " +
                                  std::to_string(FP_ABI_MAJOR) + "); rebuild it against this version's header");
  }
  if (agent.name == nullptr || agent.name[0] == '\0')
    throw InputError("agent", "has no name; give its fp_agent_type one");
  const fp_bridge* bridge = bridge_of(agent);
  const bool has_create = agent.create != nullptr || (bridge != nullptr && bridge->create_in != nullptr);
  if (agent.description == nullptr || !has_create || agent.on_event == nullptr || agent.destroy == nullptr) {
    throw InputError(
        agent.name,
        "has a null member in its fp_agent_type; description, create, on_event and destroy must all be there");
  }
}

Outcome simulate(const Scenario& scenario, const fp_agent_type& agent, std::span<const std::unique_ptr<Law>> laws,
                 TraceSink* sink, const char* agent_config, const RunWatch& watch) {
  return simulate(scenario, FleetSoftware(agent, agent_config), laws, sink, watch);
}

Outcome simulate(const Scenario& scenario, const FleetSoftware& software, std::span<const std::unique_ptr<Law>> laws,
                 TraceSink* sink, const RunWatch& watch) {
  if (watch.play.empty()) check_roles(scenario, software);  // else nobody calls it
  try {
    Engine engine(scenario, software, laws, sink, watch);
    engine.run();
    return engine.finish();
  } catch (const InvariantViolation& bug) {
    Outcome failed;
    failed.engine_error = true;
    failed.message = bug.what();
    failed.agv_count = static_cast<std::uint32_t>(scenario.agvs.size());
    failed.simulated_ns = static_cast<std::uint64_t>(scenario.horizon.count());
    return failed;
  }
}

}  // namespace fleetproof
