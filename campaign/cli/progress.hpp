#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "campaign/batch/campaign.hpp"

namespace fleetproof::cli {

// The progress of a running campaign, on stderr. A terminal shows one line that is rewritten at most ten times a
// second; otherwise there is one line every 30 s. The first failure of each agent is printed at once, with its replay
// line, and so is each run that is beyond its limit of CPU time and is repeated.
class ProgressTalk {
 public:
  // `plugins`: the agents that come from shared objects. `archive_path` empty: there is none, and no replay line.
  ProgressTalk(const CampaignPlan& plan, std::vector<std::string> plugins, std::string archive_path, int workers);
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
  const std::vector<std::string> plugins_;
  const std::string archive_path_;
  const bool terminal_;
  std::vector<std::string> told_agents_;
  std::set<std::uint64_t> told_repeats_;  // runs
  double last_line_s_ = 0.0;
  bool line_open_ = false;
};

}  // namespace fleetproof::cli
