#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <ctime>
#include <memory>

#include "campaign/batch/campaign.hpp"
#include "campaign/batch/session_log.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/batch/time_budget.hpp"
#include "campaign/cli/archive_name.hpp"
#include "campaign/cli/attempt_log.hpp"
#include "campaign/cli/campaign_end.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/shard_words.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/findings/known_cases.hpp"
#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/plan_check.hpp"
#include "campaign/run/release.hpp"
#include "campaign/shrink/case_host.hpp"
#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"
#include "storage/beside.hpp"
#include "storage/target_file.hpp"

namespace fleetproof::cli {
namespace {

// Instead of what the campaign file says.
struct ChosenPlan {
  std::optional<std::uint64_t> replicates, seed;
  std::string keep;
};

struct TimeWords {
  std::string max_time, until;
};

struct RunWords {
  std::string campaign, archive;
  std::optional<std::uint64_t> jobs;
  ChosenPlan plan;
  std::optional<std::uint64_t> fail_fast;
  std::string ledger, findings;
  TimeWords time;
  ShardWords shard;
  bool overwrite = false, allow_drift = false, until_verdict = false, exit_zero = false, json = false;
};

std::atomic<bool> status_wanted{false};

void on_status_signal(int) { status_wanted = true; }

// After the shorter of two budgets; none if neither is given.
std::optional<std::chrono::steady_clock::time_point> deadline_of(const RunWords& words) {
  std::optional<std::chrono::seconds> budget;
  if (!words.time.max_time.empty()) budget = duration_of(words.time.max_time, "--max-time");
  if (!words.time.until.empty()) {
    const auto until = time_until(words.time.until, std::time(nullptr), "--until");
    budget = budget ? std::min(*budget, until) : until;
  }
  return budget ? std::optional(std::chrono::steady_clock::now() + *budget) : std::nullopt;
}

// `worker_logs` follows when the results file has its name.
RunOptions run_options(const RunWords& words) {
  RunOptions options;
  options.deadline = deadline_of(words);
  options.workers = worker_count(words.jobs);
  if (words.fail_fast && *words.fail_fast < 1) throw InputError("--fail-fast", "is 0; it is at least 1");
  options.fail_fast = words.fail_fast.value_or(0);
  options.allow_drift = words.allow_drift;
  options.until_verdict = words.until_verdict;
  options.overwrite = words.overwrite;
  options.interrupted = &interrupted();
  options.audits = true;
  return options;
}

// The command that goes on with the campaign, with the words that say what the campaign is.
std::string resume_command(const RunWords& words) {
  std::string command = fmt::format("fleetproof run {}", shell_word(words.campaign));
  if (!words.shard.given()) command += fmt::format(" --db {}", shell_word(words.archive));
  if (words.plan.replicates) command += fmt::format(" --replicates {}", *words.plan.replicates);
  if (words.plan.seed) command += fmt::format(" --seed {}", *words.plan.seed);
  if (!words.plan.keep.empty()) command += " --keep " + words.plan.keep;
  if (words.allow_drift) command += " --allow-drift";
  return command;
}

// The options that change the plan of the file, as typed.
std::string overrides(const RunWords& words) {
  std::string text;
  if (words.plan.seed) text += fmt::format("--seed {} ", *words.plan.seed);
  if (words.plan.replicates) text += fmt::format("--replicates {} ", *words.plan.replicates);
  if (!text.empty()) text.pop_back();
  return text;
}

int finish(const CampaignResult& result, const RunWords& words, AttemptLog& attempt) {
  talk("{} of {} runs stored in {} after {:.1f} s ({:.0f} runs/s)\n", result.stored, result.progress.planned,
       words.archive, result.progress.elapsed_s,
       static_cast<double>(result.progress.simulated) / std::max(1e-9, result.progress.elapsed_s));
  const int signal_number = interrupted().load();
  if (!result.complete())
    talk("{}: the file says that it is incomplete; go on: {}\n", signal_number != 0 ? "interrupted" : "stopped early",
         resume_command(words));
  if (!result.audit_failure.empty()) {
    talk("the audits ended early: {}; the runs themselves are not affected\n", result.audit_failure);
  } else if (result.complete() && result.progress.audits_open > 0) {
    talk("{} of its runs are still to be audited; go on: {}\n", result.progress.audits_open, resume_command(words));
  }
  const int exit_code = tell_verdict(words.archive, attempt, {words.json, words.exit_zero});
  return signal_number != 0 ? exit_code_of_signal(signal_number) : exit_code;
}

// Before the campaign, and apart from it.
void play_findings(const RunWords& words, const CampaignPlan& plan, const AgentPrograms& programs,
                   const RunOptions& options) {
  if (words.findings.empty()) return;
  const FindingsFile file(words.findings);
  if (file.findings().empty()) throw InputError("--findings", fmt::format("there is no finding in {}", words.findings));
  std::size_t failing = 0, all = 0;
  const auto go_on = [&] { return !must_stop(options); };
  try {
    for (const PlayedCase& played : play_known_cases(file, plan, programs, options.workers, go_on)) {
      ++all;
      if (!played.fails_so) continue;
      ++failing;
      talk("{} {} with {}: {}\n", played.id, played.status == IssueStatus::Fixed ? "is back" : "fails as it did",
           played.agent, played.outcome);
    }
  } catch (const GivenUp&) {
    talk("the time is over; the known cases were not all played\n");
    return;
  }
  talk("{} of {} known cases fail as they did; they count in no claim\n", failing, all);
}

// What a shard does not do, by name.
void refuse_beside_shard(const RunWords& words) {
  struct Refused {
    bool given;
    const char *option, *remedy;
  };
  for (const auto& [given, option, remedy] :
       {Refused{!words.archive.empty(), "--db", "a shard writes to the folder --out; give --db to `fleetproof merge`"},
        Refused{words.until_verdict, "--until-verdict",
                "a shard sees a part of the runs; give it to `fleetproof merge`"},
        Refused{words.fail_fast.has_value(), "--fail-fast",
                "a shard sees a part of the runs; give it to `fleetproof merge`"},
        Refused{!words.findings.empty(), "--findings", "play them once, with `fleetproof retest`"},
        Refused{!words.ledger.empty(), "--ledger", "`fleetproof merge` writes the ledger; give it to that"},
        Refused{words.overwrite, "--overwrite", "a published chunk is never replaced; begin in another folder --out"},
        Refused{words.allow_drift, "--allow-drift",
                "all shards are made by one program; begin in another folder --out"},
        Refused{words.exit_zero, "--exit-zero", "a shard gives no verdict; give it to `fleetproof merge`"},
        Refused{words.json, "--json", "a shard has no report; give it to `fleetproof merge`"}}) {
    if (given) throw InputError(option, fmt::format("cannot stand beside --shard: {}", remedy));
  }
}

void listen_to_signals() {
  listen_to_interrupts();
  std::signal(SIGUSR1, on_status_signal);
}

int run(RunWords words) {
  if (words.shard.given()) refuse_beside_shard(words);
  RunOptions options = run_options(words);
  AgentPrograms programs;
  CampaignFile file = load_campaign(words.campaign, programs);
  if (words.plan.replicates) file.plan.replicates = *words.plan.replicates;
  if (words.plan.seed) file.plan.seed = *words.plan.seed;
  if (words.plan.replicates) check_plan(file.plan, "--replicates");
  file.plan.keep = keep_of(words.plan.keep).value_or(file.plan.keep);
  if (words.shard.given()) {
    listen_to_signals();
    return simulate_shard(words.shard, {.file = file,
                                        .programs = programs,
                                        .options = options,
                                        .overrides = overrides(words),
                                        .resume_command = resume_command(words),
                                        .fresh_seed = file.fresh_seed && !words.plan.seed,
                                        .wants_status = [] { return status_wanted.exchange(false); }});
  }
  if (words.archive.empty()) words.archive = archive_name_of(file.plan.name);
  options.worker_logs = beside(words.archive, "");
  const bool goes_on = !words.overwrite && (is_name_taken(words.archive) || is_name_taken(words.archive + ".partial"));
  options.earlier_logs = goes_on ? EarlierLogs::Stay : EarlierLogs::AreRemoved;
  play_findings(words, file.plan, programs, options);
  listen_to_signals();
  AttemptLog attempt(words.ledger, {.record = campaign_record(file.plan, programs),
                                    .planned_runs = file.plan.run_count(),
                                    .archive = words.archive,
                                    .release = release_digest(file.plan, programs),
                                    .fresh_seed = file.fresh_seed && !words.plan.seed,
                                    .overwrite = words.overwrite});
  CampaignResult result;
  {
    ProgressTalk talk(file.plan, object_agents(file.plan, programs), words.archive, options.workers);
    const SessionLog session(words.archive);
    CampaignListener listener = talk.listener();
    listener.started = [&, tell = listener.started] {
      attempt.begin();
      session.begin(options, programs,
                    {.ledger = attempt.path(),
                     .overrides = overrides(words),
                     .attempt = attempt.id(),
                     .ledger_line = attempt.line(),
                     .campaign_file = absolute_name(words.campaign)});
      tell();
    };
    listener.took_over = [&](const TakenOver& taken) { session.took_over(taken); };
    listener.wants_status = [] { return status_wanted.exchange(false); };
    say_where_fleets_are(file.places,
                         [&] { result = run_campaign(file.plan, programs, words.archive, options, listener); });
    session.end(result, interrupted().load());
  }
  return finish(result, words, attempt);
}

}  // namespace

Action prepare_run(Options& options) {
  auto words = std::make_shared<RunWords>();
  options.positional("CAMPAIGN", words->campaign, "campaign file (TOML)");
  options.option("--db", words->archive,
                 "results file to write, or to go on with (default: the campaign's name and .db, in this folder)");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.option("--replicates", words->plan.replicates, "instead of the file's number of replicates");
  options.option("--seed", words->plan.seed, "instead of the file's seed");
  options.option("--max-time", words->time.max_time, "stop cleanly after this time, as in 90, 45m or 5h30m");
  options.option("--until", words->time.until, "stop cleanly at this time of day, as in 06:00");
  options.option("--fail-fast", words->fail_fast, "stop after so many failed runs, in order of run index");
  options.flag("--until-verdict", words->until_verdict, "stop when the gates have given the verdict");
  options.option("--keep", words->plan.keep,
                 "rows that the published file keeps: all or failing; instead of the file's");
  options.option("--findings", words->findings,
                 "first play the smallest cases of this findings file; they count in no claim");
  options.option("--ledger", words->ledger,
                 "ledger of the attempts to make a claim (default: attempts.jsonl beside the results file)");
  add_shard_options(options, words->shard);
  options.flag("--overwrite", words->overwrite, "begin again, and replace an existing results file");
  options.flag("--allow-drift", words->allow_drift,
               "go on in a file of another build or plug-in; then nothing is demonstrated");
  options.flag("--exit-zero", words->exit_zero, "end with exit code 0 whatever the verdict is; 3 stays 3");
  options.flag("--json", words->json, "print the report as JSON");
  return [words] { return run(*words); };
}

}  // namespace fleetproof::cli
