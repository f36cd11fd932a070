#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <memory>
#include <thread>

#include "campaign/batch/campaign.hpp"
#include "campaign/batch/session_log.hpp"
#include "campaign/cli/archive_name.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/render.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/plan_check.hpp"
#include "core/base/error.hpp"
#include "reports/report.hpp"

namespace fleetproof::cli {
namespace {

struct RunWords {
  std::string campaign, archive;
  std::optional<std::uint64_t> jobs, replicates, seed;
  std::optional<double> max_time_s;
  bool overwrite = false, json = false;
};

std::atomic<int> interrupted{0};

// First signal: finish the runs that are under way and keep them. Second signal: exit at once; the live file stays as
// it was at its last commit.
void on_signal(int number) {
  if (interrupted.exchange(number) != 0) std::_Exit(128 + number);
}

RunOptions run_options(const RunWords& words) {
  RunOptions options;
  const std::uint64_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::uint64_t workers = words.jobs.value_or(cores);
  if (workers < 1 || workers > 1024)
    throw InputError("--jobs", fmt::format("is {}; it lies between 1 and 1024", workers));
  options.workers = static_cast<int>(workers);
  if (words.max_time_s) {
    if (!(*words.max_time_s >= 1.0 && *words.max_time_s <= 1e9)) throw InputError("--max-time", "must be at least 1 s");
    options.max_time = std::chrono::seconds(static_cast<long>(*words.max_time_s));
  }
  options.overwrite = words.overwrite;
  options.interrupted = &interrupted;
  options.worker_logs = std::filesystem::path(words.archive).replace_extension().string();
  return options;
}

int finish(const CampaignResult& result, const RunWords& words) {
  talk("{} of {} runs stored in {} after {:.1f} s ({:.0f} runs/s)\n", result.stored, result.progress.planned,
       words.archive, result.progress.elapsed_s,
       static_cast<double>(result.progress.done) / std::max(1e-9, result.progress.elapsed_s));
  const int signal_number = interrupted.load();
  if (signal_number != 0) talk("interrupted: the file holds the runs finished so far and says that it is incomplete\n");
  const ReportInput input = read_report_input(ArchiveReader(words.archive), words.archive);
  if (words.json) {
    put_text(render(input, "json"));
  } else {
    put_text(render(input, "summary"));
    put("report: fleetproof report {}\n", shell_word(words.archive));
  }
  return signal_number != 0 ? 128 + signal_number : input.exit_code;
}

int run(RunWords words) {
  AgentPrograms programs;
  CampaignFile file = load_campaign(words.campaign, programs);
  if (words.replicates) file.plan.replicates = *words.replicates;
  if (words.seed) file.plan.seed = *words.seed;
  if (words.replicates) check_plan(file.plan, "--replicates");
  if (words.archive.empty()) words.archive = archive_name_of(file.plan.name);
  const RunOptions options = run_options(words);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGHUP, on_signal);
  CampaignResult result;
  {
    ProgressTalk talk(file.plan, plugin_agents(file.plan, programs), words.archive, options.workers);
    const std::string started_utc = utc_now();
    result = run_campaign(file.plan, programs, words.archive, options, talk.listener());
    append_session(words.archive, started_utc, options, result);
  }
  return finish(result, words);
}

}  // namespace

Action prepare_run(Options& options) {
  auto words = std::make_shared<RunWords>();
  options.positional("CAMPAIGN", words->campaign, "campaign file (TOML)");
  options.option("--db", words->archive,
                 "campaign file to write (default: the campaign's name and .db, in this folder)");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.option("--replicates", words->replicates, "instead of the file's number of replicates");
  options.option("--seed", words->seed, "instead of the file's seed");
  options.option("--max-time", words->max_time_s, "stop cleanly after so many seconds");
  options.flag("--overwrite", words->overwrite, "replace an existing campaign file");
  options.flag("--json", words->json, "print the report as JSON");
  return [words] { return run(*words); };
}

}  // namespace fleetproof::cli
