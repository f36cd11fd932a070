#include "core/bridges/lockstep/lockstep.hpp"

#include <algorithm>
#include <csignal>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/bridges/lockstep/command.hpp"
#include "core/bridges/lockstep/hosted_process.hpp"
#include "core/bridges/lockstep/line_writer.hpp"

namespace fleetproof::lockstep {
namespace {

constexpr std::uint32_t kForAll = FP_NONE;  // the process that hosts all participants

std::string hexadecimal(std::uint64_t word) {
  std::string line;
  LineWriter(line).bits("", word);
  constexpr std::size_t kDigits = 16;
  return line.substr(line.size() - kDigits - 1, kDigits);  // the rest is punctuation
}

Recipient recipient_of(const fp_briefing& briefing) {
  if (briefing.role == FP_AGV)
    return {std::to_string(briefing.self), briefing.agv_names[briefing.self], hexadecimal(briefing.seed)};
  const std::size_t place = std::size_t{briefing.self - briefing.fleet_count} * briefing.computer_stride;
  const auto* computer =
      reinterpret_cast<const fp_computer*>(reinterpret_cast<const char*>(briefing.computers) + place);
  return {std::to_string(briefing.self), computer->name, hexadecimal(briefing.seed)};
}

}  // namespace

struct LockstepProgram::State {
  struct Agent : Participant {
    State* program = nullptr;
    HostedProcess* process = nullptr;
  };

  explicit State(std::string_view text) : command(text) {}

  void* create(const fp_host* host, fp_controller* handle, const fp_briefing* briefing);
  HostedProcess& process_for(const fp_briefing& briefing);
  void end_run();

  Command command;
  Introduction introduction;
  std::map<std::uint32_t, std::unique_ptr<HostedProcess>> processes;  // by participant, or kForAll
  fp_bridge bridge{};
  fp_agent_type type{};
};

HostedProcess& LockstepProgram::State::process_for(const fp_briefing& briefing) {
  auto& process = processes[command.is_for_one() ? briefing.self : kForAll];
  if (process == nullptr) {
    process = std::make_unique<HostedProcess>(command.words_for(recipient_of(briefing)));
    if (process->introduction() != introduction) {
      process.reset();
      throw Broken("introduces itself in another way than before");
    }
  }
  if (!process->is_in_run()) process->begin_run(briefing);
  return *process;
}

void* LockstepProgram::State::create(const fp_host* host, fp_controller* handle, const fp_briefing* briefing) {
  const bool is_served = briefing->role == FP_AGV ? introduction.serves_agvs : introduction.serves_computers;
  if (!is_served) {
    host->fail(handle, 0,
               briefing->role == FP_AGV
                   ? "the lockstep program serves no AGV: its hello has no role \"agv\" (in Python: serve(vehicle=...))"
                   : "the lockstep program serves no computer: its hello has no role \"computer\" (in Python: "
                     "serve(computer=...))");
    return nullptr;
  }
  try {
    auto agent = std::make_unique<Agent>();
    agent->controller = {host, handle};
    agent->briefing = briefing;
    agent->program = this;
    agent->process = &process_for(*briefing);
    return agent.release();
  } catch (const Broken& broken) {
    host->fail(handle, 0, ("the lockstep program " + std::string(broken.what())).c_str());
    return nullptr;
  }
}

// A process that may not go on is replaced when the next run needs it. What went wrong at the end is filed once.
void LockstepProgram::State::end_run() {
  std::string trouble;
  for (auto& [participant, process] : processes) {
    if (process == nullptr || !process->is_in_run()) continue;
    const bool was_whole = process->trouble().empty();
    const bool goes_on = process->end_run() && !command.is_for_one_run();
    if (was_whole && trouble.empty()) trouble = process->trouble();
    if (!goes_on) process.reset();
  }
  if (!trouble.empty()) throw std::runtime_error(trouble);
}

LockstepProgram::LockstepProgram(std::string_view command) : state_(std::make_unique<State>(command)) {
  struct sigaction pipe {};
  if (::sigaction(SIGPIPE, nullptr, &pipe) == 0 && pipe.sa_handler == SIG_DFL) ::signal(SIGPIPE, SIG_IGN);
  State& state = *state_;
  auto first = std::make_unique<HostedProcess>(state.command.words_for({"0", "0", hexadecimal(0)}));
  state.introduction = first->introduction();
  if (!state.command.is_for_one() && !state.command.is_for_one_run()) state.processes[kForAll] = std::move(first);
  state.bridge.struct_size = sizeof(fp_bridge);
  state.bridge.own = &state;
  state.bridge.create_in = [](void* own, const fp_host* host, fp_controller* handle, const fp_briefing* briefing) {
    return static_cast<State*>(own)->create(host, handle, briefing);
  };
  state.bridge.run_ends = [](void* own) { static_cast<State*>(own)->end_run(); };
  state.bridge.knows_fault_in = [](void* own, const char* word) -> std::uint32_t {
    const auto& known = static_cast<State*>(own)->introduction.faults;
    return std::ranges::find(known, word) != known.end() ? 1 : 0;
  };
  state.type.struct_size = sizeof(fp_agent_type);
  state.type.abi_major = FP_ABI_MAJOR;
  state.type.abi_minor = FP_ABI_MINOR;
  state.type.flags = (state.introduction.is_deterministic ? FP_DETERMINISTIC : 0U) |
                     (state.introduction.serves_computers ? FP_SERVES_COMPUTERS : 0U);
  state.type.name = state.introduction.name.c_str();
  state.type.description = state.introduction.description.c_str();
  state.type.on_event = [](void* own, const fp_event* event) {
    auto& agent = *static_cast<State::Agent*>(own);
    agent.process->tell(agent, *event);
  };
  state.type.destroy = [](void* own) {
    const std::unique_ptr<State::Agent> agent(static_cast<State::Agent*>(own));
    agent->process->tell_end_of(agent->briefing->self);
  };
  state.type.bridge = &state.bridge;
}

LockstepProgram::~LockstepProgram() = default;

const fp_agent_type& LockstepProgram::type() const { return state_->type; }

void LockstepProgram::renew() { state_->processes.clear(); }

}  // namespace fleetproof::lockstep
