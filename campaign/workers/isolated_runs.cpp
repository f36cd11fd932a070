#include "campaign/workers/isolated_runs.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <limits>
#include <utility>

#include "campaign/workers/worker.hpp"
#include "core/base/error.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "storage/checksum.hpp"

namespace fleetproof {
namespace {

constexpr std::chrono::milliseconds kLookEvery{100};
constexpr double kTimesSlowest = 20.0;  // the CPU time that a run may use, in times of the slowest run so far
constexpr double kRepeatFactor = 4.0;   // a run that went beyond it gets so much more in the repeat
constexpr int kKillsFromOutside = 3;    // of one run; then the run itself is the reason
// Somebody else may end the workers now and then: twice each, and in one of so many runs. Software that does it itself
// does so again and again.
constexpr std::uint64_t kEndsPerWorker = 2, kRunsPerEnd = 100;

// Whether what ended the first attempt of a run ended a later one, too. A run that is only slow needs its time again.
bool came_again(const CauseOfDeath& first, double limit_s, const RunOrder& order, const RunAnswer& answer) {
  if (!answer.explained) return true;
  const bool is_filed = std::ranges::any_of(order.known_ends, [&](const KnownEnd& end) {
    return end.hang == first.hang && (end.hang || end.call == first.call);
  });
  return is_filed || (first.hang && !first.maybe_outside && 1e-9 * static_cast<double>(answer.cpu_ns) > limit_s / 2.0);
}

// A first attempt that ended in another way than the run, as an audit of the run would have it.
AuditRecord audit_of(const CauseOfDeath& cause, const RunRecord& run) {
  RunRecord ended;
  ended.run_index = run.run_index;
  ended.cell = run.cell;
  ended.replicate = run.replicate;
  ended.outcome.crash = !cause.hang;
  ended.outcome.hang = cause.hang;
  ended.outcome.agv_count = run.outcome.agv_count;
  ended.outcome.message = cause.message;
  return {run.run_index, row_checksum(ended), audited_outcome(ended)};
}

}  // namespace

class IsolatedRuns::Turn {
 public:
  Turn(IsolatedRuns& runs, bool alone) : runs_(runs), alone_(alone) {
    std::unique_lock lock(runs_.mutex_);
    if (alone_) {
      ++runs_.wait_to_be_alone_;
      runs_.turn_over_.wait(lock, [&] { return runs_.turns_ == 0; });
    } else {
      runs_.turn_over_.wait(lock, [&] { return runs_.wait_to_be_alone_ == 0; });
    }
    ++runs_.turns_;
  }
  ~Turn() {
    const std::lock_guard lock(runs_.mutex_);
    --runs_.turns_;
    if (alone_) --runs_.wait_to_be_alone_;
    runs_.turn_over_.notify_all();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  IsolatedRuns& runs_;
  bool alone_;
};

class IsolatedRuns::ToldRepeat {
 public:
  ToldRepeat(IsolatedRuns& runs, std::uint64_t run_index, double limit_s)
      : runs_(runs), told_{run_index, limit_s, kRepeatFactor * limit_s, 0} {
    const std::lock_guard lock(runs_.mutex_);
    runs_.repeats_.push_back(told_);
  }
  ~ToldRepeat() {
    const std::lock_guard lock(runs_.mutex_);
    std::erase(runs_.repeats_, told_);
  }
  ToldRepeat(const ToldRepeat&) = delete;
  ToldRepeat& operator=(const ToldRepeat&) = delete;

  void call_hangs() {
    const std::lock_guard lock(runs_.mutex_);
    const auto place = std::ranges::find(runs_.repeats_, told_);
    told_.at_most_s = told_.limit_s;
    ++told_.hangs;
    *place = told_;
  }

 private:
  IsolatedRuns& runs_;
  RunRepeat told_;
};

IsolatedRuns::IsolatedRuns(const CampaignPlan& plan, const AgentPrograms& programs, const Hosting& hosting)
    : plan_(plan),
      programs_(programs),
      hosting_(hosting),
      setup_(encode_setup(plan, programs)),
      run_one_(plan, programs),
      slots_(hosting.workers),
      logs_(hosting.log_prefix, hosting.workers, hosting.earlier_logs),
      forker_(worker_program(slots_, logs_)) {
  for (int slot = hosting.workers - 1; slot >= 0; --slot) {
    idle_.emplace_back().slot = slot;
    slots_[slot].labelled = logs_.size(slot);
  }
}

RunRecord IsolatedRuns::operator()(std::uint64_t run_index, bool record_calls, HostProcess process) {
  RunRecord record = run_one_.empty_record(run_index);
  RunOrder order{run_index, {}, record_calls, {}, false, hosting_.audits};
  RunAnswer answer = answer_of(order, process);
  record.scenario_digest = answer.scenario_digest;
  record.outcome = std::move(answer.run.outcome);
  record.recording = std::move(answer.recording);
  ++hosted_;
  record.was_disturbed =
      answer.ended_otherwise && answer.ended_otherwise->maybe_outside && may_be_from_outside(++ended_from_outside_);
  if (answer.ended_otherwise && !record.was_disturbed) record.otherwise = audit_of(*answer.ended_otherwise, record);
  return record;
}

std::uint64_t IsolatedRuns::checksum_after(const std::vector<std::uint64_t>& before, std::uint64_t run_index) {
  RunRecord record = run_one_.empty_record(run_index);
  RunOrder order;
  order.run_index = run_index;
  RunAnswer answer = answer_of(order, HostProcess::Own, before);
  record.scenario_digest = answer.scenario_digest;
  record.outcome = std::move(answer.run.outcome);
  return row_checksum(record);
}

bool IsolatedRuns::may_be_from_outside(std::uint64_t ends) const {
  return ends <= kEndsPerWorker * static_cast<std::uint64_t>(hosting_.workers) + hosted_ / kRunsPerEnd;
}

CaseRun IsolatedRuns::of_case(const Scenario& scenario, const CaseWishes& wishes) {
  RunOrder order;
  order.run_index = wishes.as_audit.value_or(0);
  order.scenario = cases_.write(scenario);
  order.deliveries = wishes.deliveries == Deliveries::Kept;
  order.choice = wishes.choice;
  order.is_audit = wishes.as_audit.has_value();
  order.abandon = wishes.abandon;
  order.record = wishes.recorded;
  RunAnswer answer = answer_of(order, wishes.as_audit ? HostProcess::Own : HostProcess::Shared);
  CaseRun run = std::move(answer.run);
  run.choice = wishes.choice;
  run.recording = std::move(answer.recording);
  return run;
}

std::optional<std::vector<KnownEnd>> IsolatedRuns::ends_in(const Scenario& scenario) {
  RunOrder order;
  order.scenario = cases_.write(scenario);
  if (!answer_of(order).explained) return std::nullopt;
  return std::move(order.known_ends);
}

RunAnswer IsolatedRuns::answer_of(RunOrder& order, HostProcess process, const std::vector<std::uint64_t>& before) {
  Member member = take_member();
  try {
    if (process == HostProcess::Own && !member.fresh) retire(member);
    for (const std::uint64_t run_index : before) {
      RunOrder earlier;
      earlier.run_index = run_index;
      answer_of(member, earlier);
    }
    RunAnswer answer = answer_of(member, order);
    if (process == HostProcess::Own) retire(member);
    give_back(std::move(member));
    return answer;
  } catch (const RunAbandoned&) {
    if (member.worker.pid != 0) ::kill(member.worker.pid, SIGKILL);  // it is in the middle of the run
    retire(member);
    give_back(std::move(member));
    throw;
  } catch (...) {
    give_back(std::move(member));
    throw;
  }
}

// A worker that hosted nothing before and crashes is what a repeat would show.
RunAnswer IsolatedRuns::answer_of(Member& member, RunOrder& order) {
  const double limit_s = cpu_limit_s(order.run_index);
  Attempt first = attempt(member, order, {limit_s});
  if (first.answer) return std::move(*first.answer);
  if (first.in_fresh_worker && !first.cause.hang && !first.cause.maybe_outside && first.cause.call > 0)
    order.known_ends.push_back({first.cause.call, false, first.cause.message});
  RunAnswer answer = repeat(member, order, first.cause);
  if (!came_again(first.cause, limit_s, order, answer)) answer.ended_otherwise = std::move(first.cause);
  retire(member);  // agents that ended early have cleared nothing away
  return answer;
}

// Each attempt happens in a worker that has hosted nothing before, and learns at which calls agents ended the attempts
// before it. Every such call is later than the one before, or the software does not do the same thing twice.
// If the forker died in an attempt, any run that was under way may have killed it: from then on the run is alone.
// Once a call was found to hang, another one has shown enough when it takes the limit by itself.
RunAnswer IsolatedRuns::repeat(Member& member, RunOrder& order, const CauseOfDeath& first) {
  const double limit_s = cpu_limit_s(order.run_index);
  WorkerWatch::Limits limits{kRepeatFactor * limit_s};
  bool alone = first.with_forker;
  std::optional<ToldRepeat> told;
  if (first.hang) told.emplace(*this, order.run_index, limit_s);
  for (int killed = 0;;) {
    Attempt again = attempt(member, order, limits, alone);
    if (again.answer) return std::move(*again.answer);
    if (again.cause.with_forker && !std::exchange(alone, true)) continue;
    if (again.cause.from_outside && ++killed < kKillsFromOutside) continue;
    const std::uint64_t last = order.known_ends.empty() ? 0 : order.known_ends.back().call;
    if (again.cause.call <= last) return unexplained(order, again.cause);
    order.known_ends.push_back({again.cause.call, again.cause.hang, again.cause.message});
    if (!again.cause.hang) continue;
    limits.call_s = limit_s;
    if (!told) told.emplace(*this, order.run_index, limit_s);
    told->call_hangs();
  }
}

RunAnswer IsolatedRuns::unexplained(const RunOrder& order, const CauseOfDeath& cause) const {
  const Scenario scenario =
      order.scenario.is_empty() ? run_one_.scenarios().scenario(order.run_index) : CaseReader().read(order.scenario);
  RunAnswer answer;
  answer.explained = false;
  answer.scenario_digest = scenario_digest(scenario);
  answer.run.outcome.crash = !cause.hang;
  answer.run.outcome.hang = cause.hang;
  answer.run.outcome.message = cause.message + "; what happened after it is not known";
  answer.run.outcome.agv_count = static_cast<std::uint32_t>(scenario.agvs.size());
  return answer;
}

IsolatedRuns::Attempt IsolatedRuns::attempt(Member& member, const RunOrder& order, WorkerWatch::Limits limits,
                                            bool alone) {
  const Turn turn(*this, alone);
  for (;;) {
    if (abandoned_ || (order.abandon != nullptr && *order.abandon)) throw RunAbandoned();
    slots_[member.slot].call.number = 0;  // before the start: the worker may die while it loads
    if (const auto state = start(member)) return lost(member, order.run_index, *state);
    member.worker.channel.post(encode(order));
    RunAnswer answer;
    if (const auto state = take_answer(member, limits, answer, order.abandon))
      return lost(member, order.run_index, *state);
    if (answer.declined && !member.fresh) {
      retire(member);
      continue;
    }
    member.fresh = false;
    expect_cpu_ns(answer.cpu_ns);
    return {std::move(answer), {}, false};
  }
}

void IsolatedRuns::expect_cpu_ns(std::uint64_t cpu_ns) {
  std::uint64_t slowest = slowest_ns_;
  while (slowest < cpu_ns && !slowest_ns_.compare_exchange_weak(slowest, cpu_ns)) {
  }
}

std::optional<WorkerState> IsolatedRuns::start(Member& member) {
  if (member.worker.pid != 0) return std::nullopt;
  slots_[member.slot].started = 0;
  member.worker = forker_.start(member.slot);
  member.worker.channel.post(setup_);
  RunAnswer ready;
  return take_answer(member, {plan_.limits.loading_s()}, ready);
}

void IsolatedRuns::retire(Member& member) {
  if (member.worker.pid == 0) return;
  member.worker.channel.close();
  forker_.collect(member.worker);
  member.worker = {};
  member.fresh = true;
}

std::optional<WorkerState> IsolatedRuns::take_answer(Member& member, WorkerWatch::Limits limits, RunAnswer& answer,
                                                     const std::atomic<bool>* abandon) {
  Channel& channel = member.worker.channel;
  if (plan_.limits.memory_mb > 0) limits.bytes_below = plan_.limits.memory_mb << 20U;
  WorkerWatch watch(member.worker.pid, limits, slots_[member.slot].call.number);
  std::string pieces;
  for (;;) {
    switch (channel.wait(kLookEvery)) {
      case Channel::Wait::Arrived:
        try {
          answer = decode_answer(channel.received());
        } catch (const EngineError&) {
          return WorkerState::Garbled;
        }
        if (answer.is_piece) {
          pieces += answer.recording;
          break;
        }
        if (!answer.recording.empty()) answer.recording.insert(0, pieces);
        if (answer.failed && answer.machine) throw MachineError(answer.message);
        if (answer.failed) throw EngineError(answer.message);
        return std::nullopt;
      case Channel::Wait::Gone:
        return WorkerState::Closed;
      case Channel::Wait::NotYet:
        if (abandoned_ || (abandon != nullptr && *abandon)) throw RunAbandoned();
        if (const auto state = watch.look(std::chrono::duration<double>(kLookEvery).count())) return state;
    }
  }
}

IsolatedRuns::Attempt IsolatedRuns::lost(Member& member, std::uint64_t run_index, WorkerState state) {
  if (state != WorkerState::Closed) ::kill(member.worker.pid, SIGKILL);
  WorkerLoss loss;
  loss.run_index = run_index;
  loss.death = forker_.collect(member.worker);
  const CauseOfDeath cause = cause_of_death(state, loss.death, slots_[member.slot]);
  loss.message = cause.message;
  loss.log = logs_.path(member.slot);
  WorkerSlot& slot = slots_[member.slot];
  const std::string label = line_label(run_index, slot.call);
  if (!loss.log.empty())
    slot.labelled = label_lines(logs_.descriptors()[static_cast<std::size_t>(member.slot)], slot.labelled, label);
  if (WIFSIGNALED(loss.death.status) && WTERMSIG(loss.death.status) != SIGKILL)
    loss.stack = logs_.last_stack(member.slot, label);
  loss.in_fresh_worker = member.fresh;
  const bool was_fresh = std::exchange(member.fresh, true);
  member.worker = {};
  // Software may end its process with any code, but only once that runs.
  if (slots_[member.slot].started == 0 && WIFEXITED(loss.death.status) &&
      WEXITSTATUS(loss.death.status) == kCannotStartExit)
    throw EngineError("the program of a worker cannot be started");
  const std::lock_guard lock(mutex_);
  losses_.push_back(std::move(loss));
  return {std::nullopt, cause, was_fresh};
}

// Reference agents have no limit: in a campaign they run in the main process.
double IsolatedRuns::cpu_limit_s(std::uint64_t run_index) const {
  if (!programs_.needs_worker(plan_.agent_of_cell(run_index))) return std::numeric_limits<double>::infinity();
  return std::max(plan_.limits.cpu_s, kTimesSlowest * 1e-9 * static_cast<double>(slowest_ns_.load()));
}

IsolatedRuns::Member IsolatedRuns::take_member() {
  std::unique_lock lock(mutex_);
  member_back_.wait(lock, [&] { return !idle_.empty(); });
  Member member = std::move(idle_.back());
  idle_.pop_back();
  return member;
}

void IsolatedRuns::give_back(Member member) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(member));
  member_back_.notify_one();
}

std::vector<WorkerLoss> IsolatedRuns::take_losses() {
  const std::lock_guard lock(mutex_);
  return std::exchange(losses_, {});
}

std::vector<RunRepeat> IsolatedRuns::repeats() const {
  const std::lock_guard lock(mutex_);
  return repeats_;
}

}  // namespace fleetproof
