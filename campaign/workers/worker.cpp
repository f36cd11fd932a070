#include "campaign/workers/worker.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <new>

#include "campaign/run/case_run.hpp"
#include "campaign/run/run_one.hpp"
#include "campaign/workers/fatal_signals.hpp"
#include "campaign/workers/fresh_program.hpp"
#include "campaign/workers/run_order.hpp"
#include "core/base/error.hpp"
#include "core/engine/call_tape.hpp"

namespace fleetproof {
namespace {

// What an agent may write to one file, its log included: an agent that prints without end must not fill the disk.
constexpr rlim_t kLargestFile = rlim_t{64} << 20;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // shadow memory takes terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

std::uint64_t cpu_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(time.tv_nsec);
}

void redirect_streams(int log) {
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(log >= 0 ? log : nothing, stream);
  ::close(nothing);
  std::setvbuf(stdout, nullptr, _IONBF, 0);  // a crash loses nothing
}

void set_limits(std::uint64_t memory_mb) {
  const rlimit core{0, 0}, file{kLargestFile, kLargestFile};
  ::setrlimit(RLIMIT_CORE, &core);
  ::setrlimit(RLIMIT_FSIZE, &file);
  limit_memory(memory_mb, mapped_bytes());
}

// What a worker needs to simulate.
struct Stage {
  const CampaignPlan& plan;
  const AgentPrograms& programs;
  CaseReader& cases;
  RunOne run_one{plan, programs};
};

RunAnswer answer_to(const RunOrder& order, const Stage& stage, WorkerSlot& slot) {
  RunAnswer answer;
  const std::uint64_t begin_ns = cpu_ns();
  RunWatch watch;
  watch.note = &slot.call;
  watch.known_ends = order.known_ends;
  CallTape tape;
  if (order.record) watch.record = &tape;
  if (order.scenario.is_empty()) {
    RunRecord record = stage.run_one(order.run_index, nullptr, watch);
    answer.scenario_digest = record.scenario_digest;
    answer.run.outcome = std::move(record.outcome);
  } else {
    const AgentFactor& agent = stage.plan.agents.front();
    answer.run = run_case(stage.cases.read(order.scenario), stage.programs.find(agent.program, "agent"),
                          stage.plan.config_of(agent), stage.plan.laws_left_out,
                          order.deliveries ? Deliveries::Kept : Deliveries::Ignored, watch);
  }
  if (order.record && answer.run.outcome.is_failure()) answer.recording = tape.take();
  answer.cpu_ns = cpu_ns() - begin_ns;
  return answer;
}

}  // namespace

void take_orders(const CampaignPlan& plan, const AgentPrograms& programs, WorkerSlot& slot, Channel& channel,
                 const std::function<void(const RunOrder& order)>& before_each) {
  CaseReader cases;
  const Stage stage{plan, programs, cases};
  for (;;) {
    Channel::Wait state = Channel::Wait::NotYet;
    while (state == Channel::Wait::NotYet) state = channel.wait(std::chrono::hours(1));
    if (state == Channel::Wait::Gone) return;
    const RunOrder order = decode_order(channel.received());
    before_each(order);
    if (!channel.send(encode(answer_to(order, stage, slot)))) ::_exit(kChannelClosedExit);
  }
}

std::uint64_t mapped_bytes() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit_memory(std::uint64_t memory_mb, std::uint64_t own_bytes) {
  rlimit memory{};
  if (kSanitized || ::getrlimit(RLIMIT_AS, &memory) != 0) return;
  memory.rlim_cur = memory_mb > 0 ? std::min<rlim_t>(own_bytes + (memory_mb << 20), memory.rlim_max) : memory.rlim_max;
  ::setrlimit(RLIMIT_AS, &memory);
}

void answer_failures(Channel& channel, const std::function<void()>& life) {
  try {
    life();
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemoryExit);
  } catch (const std::exception& error) {
    RunAnswer failed;
    failed.failed = true;
    failed.message = error.what();
    channel.send(encode(failed));
  }
  ::_exit(0);
}

void work(const WorkerSetup& setup, int slot, Channel channel) {
  redirect_streams(setup.logs[static_cast<std::size_t>(slot)]);
  // A program of its own begins with more than this process had mapped, and limits itself later.
  set_limits(setup.program.empty() ? setup.plan.limits.memory_mb : 0);
  if (!setup.program.empty()) become_fresh_program(setup.program, setup.slots, slot, std::move(channel));
  note_fatal_signals(setup.slots[slot]);
  answer_failures(channel, [&] {
    AgentPrograms programs;
    for (const AgentProgram& known : setup.programs.all()) {
      if (known.is_plugin()) programs.load_unchanged(known);
    }
    take_orders(setup.plan, programs, setup.slots[slot], channel);
  });
}

}  // namespace fleetproof
