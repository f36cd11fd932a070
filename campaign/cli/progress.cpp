#include "campaign/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "campaign/batch/time_budget.hpp"
#include "campaign/cli/failure_words.hpp"
#include "campaign/cli/streams.hpp"
#include "core/outcome/run_failures.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

constexpr double kLineEvery_s = 30.0;
constexpr std::size_t kMostRepeatsTold = 10;

// What is under way, and for how long at most: without it, a hang looks like a campaign that stands still.
std::string repeat_words(const RunRepeat& repeat) {
  if (repeat.hangs == 0)
    return fmt::format("run {} did not end within {:.3g} s of CPU time: it is repeated, for {:.3g} s at most",
                       repeat.run_index, repeat.limit_s, repeat.at_most_s);
  return fmt::format("run {} is repeated without {} that {}: {:.3g} s at most for each further one", repeat.run_index,
                     count_text(repeat.hangs, "call"), repeat.hangs == 1 ? "hangs" : "hang", repeat.at_most_s);
}

bool is_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
}

}  // namespace

ProgressTalk::ProgressTalk(const CampaignPlan& plan, std::vector<std::string> objects, std::string archive_path,
                           int workers)
    : opening_(fmt::format("campaign {}: {} cells x {} replicates = {} runs, seed {}, {} workers", plan.name,
                           plan.cell_count(), plan.replicates, plan.run_count(), plan.seed, workers)),
      cells_(plan.cells()),
      objects_(std::move(objects)),
      archive_path_(std::move(archive_path)),
      terminal_(is_terminal()) {}

ProgressTalk::~ProgressTalk() { clear_line(); }

CampaignListener ProgressTalk::listener() {
  return {[this] { started(); },
          [this](const RunRecord& record) { run_finished(record); },
          [this](const Progress& progress) { tick(progress); },
          [] { return false; },
          [this](const Progress& progress, const std::vector<RunUnderWay>& under_way) { status(progress, under_way); },
          [](const std::string& sentence) { talk("warning: {}\n", sentence); }};
}

void ProgressTalk::started() { talk("{}\n", opening_); }

void ProgressTalk::run_finished(const RunRecord& record) {
  const Outcome& outcome = record.outcome;
  if (!outcome.is_failure()) return;
  const CellRecord& cell = cells_[record.cell];
  if (std::ranges::find(told_agents_, cell.agent) != told_agents_.end()) return;
  told_agents_.push_back(cell.agent);
  clear_line();
  const auto leading = chosen_failure(outcome, {});
  talk("first failure of {}: {} in run {} ({}, {} AGVs, {})\n", cell.agent,
       leading && !leading->is_violation ? leading->what : name_of(outcome.outcome_class()), record.run_index,
       cell.layout, cell.fleet_size, factors_text(record.factors));
  if (leading) {
    const std::string others = others_line(outcome, *leading, OptionNamed::No);
    if (!others.empty()) talk("  {}\n", others);
  }
  if (archive_path_.empty()) return;
  const std::string replay = replay_command(archive_path_, record.run_index);
  talk("  replay: {}\n", replay);
  const bool is_object = std::ranges::find(objects_, cell.agent) != objects_.end();
  if (is_object && (outcome.crash || outcome.hang)) talk("  debug: gdb --args {} --in-process\n", replay);
}

std::string ProgressTalk::counter_line(const Progress& progress) const {
  const double rate = progress.elapsed_s > 0.0 ? static_cast<double>(progress.simulated) / progress.elapsed_s : 0.0;
  const std::string left =
      rate > 0.0 ? duration_text(static_cast<double>(progress.planned - progress.done) / rate) : "not known";
  return fmt::format("{}/{} runs  {:.0f} %  {:.0f} runs/s  ETA {} | violating {}{}", progress.done, progress.planned,
                     100.0 * static_cast<double>(progress.done) / static_cast<double>(progress.planned), rate, left,
                     progress.violating,
                     progress.engine_errors == 0 ? "" : fmt::format("  engine errors {}", progress.engine_errors)) +
         (progress.done == progress.planned && progress.audits_open > 0
              ? fmt::format("  {} audits to do", progress.audits_open)
              : "") +
         (progress.repeats.empty() ? "" : " | " + repeat_words(progress.repeats.front()));
}

void ProgressTalk::tell_repeats(const Progress& progress) {
  for (const RunRepeat& repeat : progress.repeats) {
    if (told_repeats_.size() >= kMostRepeatsTold || !told_repeats_.insert(repeat.run_index).second) continue;
    clear_line();
    talk("{}\n", repeat_words(repeat));
    if (told_repeats_.size() == kMostRepeatsTold) talk("further runs that are repeated are not told one by one\n");
  }
}

void ProgressTalk::tick(const Progress& progress) {
  tell_repeats(progress);
  if (terminal_) {
    steer_terminal("\r\033[K" + counter_line(progress), kNoPatience_ms);
    line_open_ = true;
  } else if (progress.elapsed_s - last_line_s_ >= kLineEvery_s) {
    last_line_s_ = progress.elapsed_s;
    talk("{}\n", counter_line(progress));
  }
}

void ProgressTalk::status(const Progress& progress, const std::vector<RunUnderWay>& under_way) {
  clear_line();
  talk("{}\n", counter_line(progress));
  for (const RunUnderWay& run : under_way) talk("  run {} for {:.1f} s\n", run.run_index, run.since_s);
}

void ProgressTalk::clear_line() {
  if (!line_open_) return;
  steer_terminal("\r\033[K");
  line_open_ = false;
}

WorkProgress::WorkProgress(std::string verb, std::function<std::uint64_t()> simulated, double allowed_s)
    : verb_(std::move(verb)),
      simulated_(std::move(simulated)),
      allowed_s_(allowed_s),
      terminal_(is_terminal()),
      thread_([this] { watch(); }) {}

WorkProgress::~WorkProgress() {
  {
    const std::lock_guard lock(mutex_);
    is_leaving_ = true;
    clear_line();
  }
  leaving_.notify_all();
  thread_.join();
}

void WorkProgress::begin(std::string_view step) {
  const std::lock_guard lock(mutex_);
  step_ = step;
  step_began_ = std::chrono::steady_clock::now();
  done_ = all_ = 0;
  is_step_told_ = false;
}

void WorkProgress::count(std::size_t done, std::size_t all) {
  const std::lock_guard lock(mutex_);
  done_ = done;
  all_ = all;
}

void WorkProgress::hide() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

void WorkProgress::say(std::string_view line) {
  const std::lock_guard lock(mutex_);
  clear_line();
  talk("{}\n", line);
}

std::string WorkProgress::text() const {
  const auto now = std::chrono::steady_clock::now();
  const auto since = [&](auto begin) { return std::chrono::duration<double>(now - begin).count(); };
  std::string text = fmt::format("{}: {}", verb_, step_);
  if (all_ > 0) text += fmt::format(", {} of {}", done_, all_);
  if (done_ > 0) {
    const double each_s = since(step_began_) / static_cast<double>(done_);
    text += fmt::format(", ETA {}", duration_text(each_s * static_cast<double>(all_ - std::min(all_, done_))));
  }
  text += simulated_ ? fmt::format("; {} runs simulated in {}", simulated_(), duration_text(since(began_)))
                     : "; " + duration_text(since(began_));
  if (allowed_s_ > 0.0) text += fmt::format(" of {} at most", duration_text(allowed_s_));
  return text;
}

void WorkProgress::watch() {
  constexpr std::chrono::milliseconds often{100}, soon{2000}, seldom{30'000};
  auto last = began_;
  std::unique_lock lock(mutex_);
  while (!leaving_.wait_for(lock, often, [&] { return is_leaving_; })) {
    if (terminal_) {
      steer_terminal("\r\033[K" + text(), kNoPatience_ms);
      line_open_ = true;
    } else if (std::chrono::steady_clock::now() - last >= (is_step_told_ ? seldom : soon)) {
      talk("{}\n", text());
      is_step_told_ = true;
      last = std::chrono::steady_clock::now();
    }
  }
}

void WorkProgress::clear_line() {
  if (!line_open_) return;
  steer_terminal("\r\033[K");
  line_open_ = false;
}

std::unique_ptr<WorkProgress> reading_progress(const std::string& verb, std::uint64_t runs) {
  constexpr std::uint64_t few = 100'000;
  if (runs <= few) return nullptr;
  auto progress = std::make_unique<WorkProgress>(verb, nullptr);
  progress->begin("reading " + count_text(runs, "run"));
  return progress;
}

}  // namespace fleetproof::cli
