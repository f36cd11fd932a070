#include "core/bridges/wrapped/wrapped_program.hpp"

#include <deque>
#include <mutex>
#include <string>
#include <utility>

#include "core/bridges/wrapped/fault_agents.hpp"
#include "core/sdk/agent_table.hpp"

namespace fleetproof::wrapped {
namespace {

// Agents that have ended stay in memory, so that a thread of theirs that calls on reaches the engine, which refuses it.
class Resting {
 public:
  void add(std::unique_ptr<WrappedAgent> agent) {
    const std::lock_guard lock(mutex_);
    agents_.push_back(std::move(agent));
    if (agents_.size() > kMost) agents_.pop_front();
  }

 private:
  static constexpr std::size_t kMost = 4096;
  std::mutex mutex_;
  std::deque<std::unique_ptr<WrappedAgent>> agents_;
};

std::unique_ptr<WrappedAgent> make_agent(const Fault& fault, const Surroundings& around) {
  static constexpr AgentMaker kMakers[] = {make_dropping,   make_repeating,    make_stalling,
                                           make_forgetting, make_old_position, make_clock_off};
  return kMakers[static_cast<std::size_t>(fault.kind)](fault, around);
}

void hear(void* agent, const fp_event* event) { static_cast<WrappedAgent*>(agent)->tell(*event); }

}  // namespace

struct WrappedProgram::State {
  State(const fp_agent_type& program, const Fault& given) : inside(program), fault(given) {}

  void* create(const fp_host* host, fp_controller* handle, const fp_briefing* briefing) {
    auto agent = make_agent(fault, {inside, *host, handle, *briefing, own_timer, this});
    if (agent->start()) return agent.release();
    resting.add(std::move(agent));
    return nullptr;
  }

  const fp_agent_type& inside;
  Fault fault;
  std::uint32_t own_timer = kInnermostTimer;
  std::string name, description;
  Resting resting;
  fp_bridge bridge{};
  fp_agent_type type{};
};

WrappedProgram::WrappedProgram(const fp_agent_type& inside, const Fault& fault)
    : state_(std::make_unique<State>(inside, fault)) {
  State& state = *state_;
  if (inside.on_event == hear) state.own_timer = static_cast<State*>(inside.bridge->own)->own_timer - 1;
  state.name = inside.name + std::string(kWith) + text_of(fault);
  state.description = inside.name + (" that " + description_of(fault));
  state.bridge.struct_size = sizeof(fp_bridge);
  state.bridge.own = &state;
  state.bridge.create_in = [](void* own, const fp_host* host, fp_controller* handle, const fp_briefing* briefing) {
    return static_cast<State*>(own)->create(host, handle, briefing);
  };
  state.bridge.run_ends = [](void* own) {
    const fp_bridge* bridge = bridge_of(static_cast<State*>(own)->inside);
    if (bridge != nullptr && bridge->run_ends != nullptr) bridge->run_ends(bridge->own);
  };
  state.bridge.knows_fault_in = [](void* own, const char* word) -> std::uint32_t {
    return knows_fault(static_cast<State*>(own)->inside, word) ? 1 : 0;
  };
  state.type.struct_size = sizeof(fp_agent_type);
  state.type.abi_major = FP_ABI_MAJOR;
  state.type.abi_minor = FP_ABI_MINOR;
  state.type.flags = flags_of(inside);
  state.type.name = state.name.c_str();
  state.type.description = state.description.c_str();
  state.type.on_event = hear;
  state.type.destroy = [](void* ended) {
    std::unique_ptr<WrappedAgent> agent(static_cast<WrappedAgent*>(ended));
    Resting& resting = static_cast<State*>(agent->program())->resting;
    agent->end();
    resting.add(std::move(agent));
  };
  state.type.bridge = &state.bridge;
}

WrappedProgram::~WrappedProgram() = default;

const fp_agent_type& WrappedProgram::type() const { return state_->type; }

}  // namespace fleetproof::wrapped
