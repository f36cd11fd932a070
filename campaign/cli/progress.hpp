#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "campaign/batch/campaign.hpp"

namespace fleetproof::cli {

// The progress of a running campaign, on stderr. A terminal shows one line that is rewritten at most ten times a
// second; otherwise there is one line every 30 s. The first failure of each agent is printed at once, with its replay
// line, and so is each run that is beyond its limit of CPU time and is repeated.
class ProgressTalk {
 public:
  // `objects`: the agents that come from shared objects. `archive_path` empty: there is none, and no replay line.
  ProgressTalk(const CampaignPlan& plan, std::vector<std::string> objects, std::string archive_path, int workers);
  ~ProgressTalk();
  ProgressTalk(const ProgressTalk&) = delete;
  ProgressTalk& operator=(const ProgressTalk&) = delete;

  CampaignListener listener();

 private:
  void started();
  void run_finished(const RunRecord& record);
  void tick(const Progress& progress);
  void status(const Progress& progress, const std::vector<RunUnderWay>& under_way);
  void tell_repeats(const Progress& progress);
  std::string counter_line(const Progress& progress) const;
  void clear_line();

  const std::string opening_;
  const std::vector<CellRecord> cells_;
  const std::vector<std::string> objects_;
  const std::string archive_path_;
  const bool terminal_;
  std::vector<std::string> told_agents_;
  std::set<std::uint64_t> told_repeats_;  // runs
  double last_line_s_ = 0.0;
  bool line_open_ = false;
};

// What a verb does that may take long: on a terminal one line that is rewritten; otherwise one line after 2 s, one for
// each later step that is under way 2 s after the last line, and one every 30 s. The line is written by a thread of its
// own, because the verb is busy.
class WorkProgress {
 public:
  // `simulated`: how many runs were simulated so far; any thread may call it. Empty: it simulates none. `allowed_s`:
  // the time that the verb may take; 0: any.
  WorkProgress(std::string verb, std::function<std::uint64_t()> simulated, double allowed_s = 0.0);
  ~WorkProgress();
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  void begin(std::string_view step);
  // Of the step; tells how long the rest takes.
  void count(std::size_t done, std::size_t all);
  void hide();  // until the next line: something else is written
  // A line that stays.
  void say(std::string_view line);

 private:
  std::string text() const;
  void watch();
  void clear_line();

  const std::string verb_;
  const std::function<std::uint64_t()> simulated_;
  const double allowed_s_;
  const bool terminal_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable leaving_;
  std::string step_;
  std::chrono::steady_clock::time_point step_began_ = began_;
  std::size_t done_ = 0, all_ = 0;
  bool line_open_ = false, is_leaving_ = false, is_step_told_ = false;
  std::thread thread_;
};

// While a results file with many runs is read. Null: it has few, and is read at once.
std::unique_ptr<WorkProgress> reading_progress(const std::string& verb, std::uint64_t runs);

}  // namespace fleetproof::cli
