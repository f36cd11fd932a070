#include "campaign/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "campaign/batch/time_budget.hpp"
#include "campaign/cli/streams.hpp"
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

ProgressTalk::ProgressTalk(const CampaignPlan& plan, std::vector<std::string> plugins, std::string archive_path,
                           int workers)
    : opening_(fmt::format("campaign {}: {} cells x {} replicates = {} runs, seed {}, {} workers", plan.name,
                           plan.cell_count(), plan.replicates, plan.run_count(), plan.seed, workers)),
      cells_(plan.cells()),
      plugins_(std::move(plugins)),
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
  talk("first failure of {}: {} in run {} ({}, {} AGVs, {})\n", cell.agent, name_of(outcome.outcome_class()),
       record.run_index, cell.layout, cell.fleet_size, factors_text(record.factors));
  if (archive_path_.empty()) return;
  const std::string replay = replay_command(archive_path_, record.run_index);
  talk("  replay: {}\n", replay);
  const bool plugin = std::ranges::find(plugins_, cell.agent) != plugins_.end();
  if (plugin && (outcome.crash || outcome.hang)) talk("  debug: gdb --args {} --in-process\n", replay);
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

}  // namespace fleetproof::cli
