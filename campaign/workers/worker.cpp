#include "campaign/workers/worker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "campaign/plan/plan_text.hpp"
#include "campaign/run/case_run.hpp"
#include "campaign/run/memory_limit.hpp"
#include "campaign/run/run_one.hpp"
#include "campaign/workers/disturbance.hpp"
#include "campaign/workers/fatal_signals.hpp"
#include "campaign/workers/left_behind.hpp"
#include "campaign/workers/process_tree.hpp"
#include "campaign/workers/run_order.hpp"
#include "campaign/workers/worker_logs.hpp"
#include "core/base/byte_text.hpp"
#include "core/base/error.hpp"
#include "core/engine/call_tape.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kWorkerWord = "take-orders";  // then slots, number of slots, channel, slot
constexpr int kWorkerWords = 6;
// Of one scenario, which is recorded to be watched. The main process holds it.
constexpr std::size_t kLongestWatchedTape = std::size_t{4} << 30U;
constexpr std::size_t kShortestSource = 1 + 4 + 4 + 1;

// A worker hosts runs for so many times the CPU time of its start, its first run included. What software takes from its
// process (addresses, a process number) then varies within a campaign, and shows as a rate.
constexpr std::uint64_t kTimesOwnStart = 20;
// The memory is disturbed before each run of the campaign if that takes at most this share of a run.
constexpr std::uint64_t kRunsPerDisturbance = 20;

std::uint64_t cpu_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(time.tv_nsec);
}

struct Setup {
  CampaignPlan plan;
  std::vector<ProgramSource> programs;
};

Setup decode_setup(std::string_view bytes) {
  ByteSource source(bytes, "the setup of a worker");
  Setup setup;
  setup.plan = parse_plan(source.text(), PlanCells::MayBeNone);
  setup.programs.resize(source.count(kShortestSource));
  for (ProgramSource& program : setup.programs) {
    program.kind = static_cast<ProgramKind>(source.u8());
    program.file = source.text();
    program.sha256 = source.text();
    program.global_symbols = source.flag();
  }
  source.end();
  return setup;
}

// Empty: the other end is gone.
std::optional<std::string> next_frame(Channel& channel) {
  Channel::Wait state = Channel::Wait::NotYet;
  while (state == Channel::Wait::NotYet) state = channel.wait(std::chrono::hours(1));
  if (state == Channel::Wait::Gone) return std::nullopt;
  return channel.received();
}

void send_answer(Channel& channel, const RunAnswer& answer) {
  if (!channel.send(encode(answer))) ::_exit(kChannelClosedExit);
}

// The standard output of the worker, if that is a log. It labels what is printed there.
class PrintedLog {
 public:
  explicit PrintedLog(WorkerSlot& slot) : slot_(slot) {
    struct stat status {};
    if (::fstat(STDOUT_FILENO, &status) != 0 || !S_ISREG(status.st_mode)) return;
    file_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);  // an agent may close its own descriptor
  }

  WorkerSlot& slot() const { return slot_; }
  bool is_kept() const { return file_ >= 0; }
  void label_start() const {
    if (is_kept()) slot_.labelled = label_lines(file_, slot_.labelled, kStartLabel);
  }
  // The lines that the last call of an agent has printed.
  void label(std::uint64_t run_index) const {
    struct stat status {};
    if (!is_kept() || ::fstat(file_, &status) != 0) return;
    if (static_cast<std::uint64_t>(status.st_size) == slot_.labelled) return;
    slot_.labelled = label_lines(file_, slot_.labelled, line_label(run_index, slot_.call));
  }
  // How an agent has failed stands behind what the agents of the run have printed.
  void tell_failure(std::uint64_t run_index, const Outcome& outcome) const {
    if (is_kept() && (outcome.crash || outcome.hang))
      slot_.labelled = add_line(file_, end_label(run_index) + outcome.message);
  }

 private:
  WorkerSlot& slot_;
  int file_ = -1;  // what agents print is dropped
};

// A worker that has loaded the plug-ins and takes orders.
class Worker {
 public:
  Worker(Setup setup, WorkerSlot& slot, Channel& channel)
      : plan_(std::move(setup.plan)), log_(slot), channel_(channel) {
    disturbance_.renew(0, Disturbance::Fill::Next);
    own_bytes_ = mapped_bytes();
    limit_memory(plan_.limits.memory_mb, own_bytes_);  // a plug-in may use as much while it is loaded
    for (const ProgramSource& program : setup.programs) programs_.load_unchanged(program);
    log_.label_start();
    left_behind_.emplace();
  }

  void take_orders() {
    while (const auto bytes = next_frame(channel_)) {
      const RunOrder order = decode_order(*bytes);
      if (is_worn_) {
        RunAnswer declined;
        declined.declined = true;
        send_answer(channel_, declined);
        ::_exit(0);  // to clear away what nobody uses any more takes longer than a run
      }
      prepare(order);
      send_answer(channel_, answer_to(order));
      is_worn_ = is_worn();  // while the answer is on its way
    }
  }

 private:
  // The first run belongs to the start: it makes what later ones find.
  bool is_worn() {
    const bool is_clean = left_behind_->set_back();
    const std::uint64_t used_ns = used_cpu_ns();
    if (runs_ == 1) start_cpu_ns_ = used_ns;
    return !is_clean || used_ns >= (1 + kTimesOwnStart) * start_cpu_ns_;
  }

  // With that of the processes that it has started. Looking at these costs time: only where there are some.
  std::uint64_t used_cpu_ns() const {
    if (!programs_.have_processes()) return cpu_ns();
    return cpu_ns() + static_cast<std::uint64_t>(1e9 * use_of_tree(::getpid()).below_s);
  }

  void prepare(const RunOrder& order) {
    if (order.is_audit) programs_.renew();
    // What a reference agent leaves mapped does not count against the plug-ins of the runs that follow.
    if (before_unlimited_) own_bytes_ += std::max(mapped_bytes(), *before_unlimited_) - *before_unlimited_;
    disturb(order);
    // Reference agents have no limit in a campaign either: there they run in the main process.
    const bool limited = programs_.needs_worker(plan_.agent_of_cell(order.run_index));
    before_unlimited_ = limited ? std::nullopt : std::optional(mapped_bytes());
    limit_memory(limited ? plan_.limits.memory_mb : 0, own_bytes_);
  }

  void disturb(const RunOrder& order) {
    const bool is_cheap = kRunsPerDisturbance * disturbance_ns_ <= runs_ns_ / std::max<std::uint64_t>(1, runs_);
    if (runs_ > 0 && !order.is_audit && !is_cheap) return;
    const std::uint64_t begin_ns = cpu_ns();
    if (order.is_audit) {
      disturbance_.renew(kAuditKeys + order.run_index);
    } else {
      disturbance_.renew(order.run_index, Disturbance::Fill::Next);
    }
    disturbance_ns_ = cpu_ns() - begin_ns;
  }

  RunAnswer answer_to(const RunOrder& order) {
    RunAnswer answer;
    const std::uint64_t begin_ns = used_cpu_ns();
    RunWatch watch;
    watch.note = &log_.slot().call;
    watch.known_ends = order.known_ends;
    CallTape tape = order.scenario.is_empty() ? CallTape() : CallTape(kLongestWatchedTape, [&](std::string piece) {
      RunAnswer part;
      part.is_piece = true;
      part.recording = std::move(piece);
      send_answer(channel_, part);
    });
    if (order.record) watch.record = &tape;
    if (log_.is_kept()) {
      watch.call_ended = [&] {
        if (left_behind_->has_called_yet()) log_.label(order.run_index);
      };
    }
    left_behind_->run_begins();
    if (order.scenario.is_empty()) {
      RunRecord record = run_one_(order.run_index, nullptr, watch);
      answer.scenario_digest = record.scenario_digest;
      answer.run.outcome = std::move(record.outcome);
    } else {
      const AgentFactor& agent = plan_.agents.front();
      watch.foreign = programs_.handles_of(agent);
      const Scenario scenario = cases_.read(order.scenario);
      answer.run = run_case(scenario, programs_.software(agent, plan_.agent_config, scenario), plan_.laws_left_out,
                            order.deliveries ? Deliveries::Kept : Deliveries::Ignored, watch, order.choice);
    }
    left_behind_->run_ended();
    log_.label(order.run_index);
    log_.tell_failure(order.run_index, answer.run.outcome);
    const bool is_kept = order.is_audit || !order.scenario.is_empty() || answer.run.outcome.is_failure();
    if (order.record && is_kept) answer.recording = tape.take();
    const std::uint64_t end_ns = used_cpu_ns();
    answer.cpu_ns = end_ns - std::min(begin_ns, end_ns);
    ++runs_;
    runs_ns_ += answer.cpu_ns;
    return answer;
  }

  static constexpr std::uint64_t kAuditKeys = std::uint64_t{1} << 63;  // keys of audits are beyond all others

  CampaignPlan plan_;
  PrintedLog log_;
  Channel& channel_;
  Disturbance disturbance_;
  AgentPrograms programs_;
  RunOne run_one_{plan_, programs_};
  CaseReader cases_;
  std::optional<LeftBehind> left_behind_;
  std::uint64_t own_bytes_ = 0, start_cpu_ns_ = 0;
  std::optional<std::uint64_t> before_unlimited_;  // what was mapped before the last run, if that had no limit
  std::uint64_t runs_ = 0, runs_ns_ = 0, disturbance_ns_ = 0;
  bool is_worn_ = false;
};

// Ends the process. If something goes wrong, the channel or the exit code says what.
[[noreturn]] void serve(Channel channel, int slots_fd, int count, int slot) {
  try {
    std::setvbuf(stdout, nullptr, _IONBF, 0);  // a crash loses nothing
    const SharedSlots slots(count, slots_fd);
    slots[slot].started = 1;
    note_fatal_signals(slots[slot]);
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // what its processes have started stays below it
    if (const auto setup = next_frame(channel)) {
      Worker worker(decode_setup(*setup), slots[slot], channel);
      send_answer(channel, {});  // it is ready: what it has used until here is no part of a run
      worker.take_orders();
    }
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemoryExit);
  } catch (const std::exception& error) {
    RunAnswer failed;
    failed.failed = true;
    // The main process has loaded the same files: if they cannot be loaded now, something happened to them.
    failed.machine =
        dynamic_cast<const MachineError*>(&error) != nullptr || dynamic_cast<const InputError*>(&error) != nullptr;
    failed.message = error.what();
    channel.send(encode(failed));
  }
  ::_exit(0);
}

int number_in(const char* word) {
  int value = -1;
  const char* end = word + std::strlen(word);
  const auto [stop, error] = std::from_chars(word, end, value);
  return error == std::errc{} && stop == end ? value : -1;
}

}  // namespace

WorkerProgram worker_program(const SharedSlots& slots, const WorkerLogs& logs) {
  return {kThisProgram,
          {std::string(kWorkerWord), std::to_string(slots.fd()), std::to_string(slots.count())},
          {slots.fd()},
          logs.descriptors()};
}

std::string encode_setup(const CampaignPlan& plan, const AgentPrograms& programs) {
  ByteSink sink;
  sink.text(plan_text(plan));
  const auto foreign = programs.foreign();
  sink.u32(static_cast<std::uint32_t>(foreign.size()));
  for (const AgentProgram* program : foreign) {
    sink.u8(static_cast<std::uint8_t>(program->source.kind));
    sink.text(program->source.file);
    sink.text(program->source.sha256);
    sink.u8(program->source.global_symbols ? 1 : 0);
  }
  return sink.take();
}

void serve_if_called(int argc, const char* const* argv) {
  serve_forker_if_called(argc, argv);
  if (argc != kWorkerWords || argv[1] != kWorkerWord) return;
  const int slots_fd = number_in(argv[2]), count = number_in(argv[3]), channel = number_in(argv[4]),
            slot = number_in(argv[5]);
  if (channel < 0 || slots_fd < 0 || slot < 0 || slot >= count || ::fcntl(channel, F_GETFD) < 0) return;
  ::fcntl(channel, F_SETFD, FD_CLOEXEC);
  serve(Channel(channel), slots_fd, count, slot);
}

}  // namespace fleetproof
