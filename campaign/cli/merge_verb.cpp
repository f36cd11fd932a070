#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>

#include "campaign/batch/session_log.hpp"
#include "campaign/cli/archive_name.hpp"
#include "campaign/cli/attempt_log.hpp"
#include "campaign/cli/campaign_end.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/shards/merge.hpp"
#include "campaign/workers/worker_logs.hpp"
#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"
#include "reports/page/wording.hpp"
#include "storage/beside.hpp"
#include "storage/line_log.hpp"

namespace fleetproof::cli {
namespace {

struct MergeWords {
  std::vector<std::string> folders;
  std::string archive, ledger, keep;
  std::optional<std::uint64_t> fail_fast;
  bool overwrite = false, until_verdict = false, exit_zero = false, json = false;
};

// What the shards noted goes on beside the results file, once.
void copy_session_logs(const PublishedChunks& chunks, const std::string& archive) {
  for (const std::string& session : chunks.sessions()) {
    std::string lines = read_text_file_if_there(session_log_path(session)).value_or("");
    if (!lines.empty() && lines.back() != '\n') lines += '\n';
    const std::string log = session_log_path(archive);
    if (read_text_file_if_there(log).value_or("").find(lines) == std::string::npos) append_lines(log, lines);
  }
}

// So that `replay` finds what the agents of a run have printed in a shard.
void carry_worker_logs_over(const PublishedChunks& chunks, const std::string& archive) {
  std::vector<std::string> prefixes;
  for (const std::string& session : chunks.sessions()) prefixes.push_back(beside(session, ""));
  carry_logs_over(prefixes, beside(archive, ""));
}

AttemptLog::Campaign attempt_words(const PublishedChunks& chunks, const MergeWords& words) {
  AttemptLog::Campaign attempt{.record = chunks.campaign(),
                               .planned_runs = chunks.grid().runs(),
                               .archive = words.archive,
                               .release = {},
                               .fresh_seed = false,
                               .overwrite = words.overwrite};
  for (const std::string& session : chunks.sessions()) {
    attempt.release = remembered_release(session);
    attempt.fresh_seed = remembers_fresh_seed(session);
  }
  return attempt;
}

struct Interrupted {};

// After each chunk. A signal ends the merge there, and leaves nothing; once all is read, the file is written whole.
std::function<void(std::uint64_t)> counter_of(WorkProgress& progress, std::uint64_t chunks) {
  return [&progress, chunks](std::uint64_t done) {
    if (interrupted() != 0) throw Interrupted();
    progress.count(done, chunks);
    if (done == chunks) progress.begin("writing the results file");
  };
}

int put_together(MergeWords words) {
  if (words.fail_fast && *words.fail_fast < 1) throw InputError("--fail-fast", "is 0; it is at least 1");
  const std::optional<Keep> keep = keep_of(words.keep);
  const PublishedChunks chunks(words.folders);
  if (words.archive.empty()) words.archive = archive_name_of(chunks.campaign().name);
  AttemptLog attempt(words.ledger, attempt_words(chunks, words));
  const SessionLog session(words.archive);
  std::optional<WorkProgress> progress;
  progress.emplace("merge", nullptr);
  progress->begin("reading chunks");
  CampaignResult result;
  result.progress.planned = chunks.grid().runs();
  // Before the file gets its name: a merge that is killed behind that is an attempt, too.
  const auto begin = [&] {
    copy_session_logs(chunks, words.archive);
    carry_worker_logs_over(chunks, words.archive);
    attempt.begin();
    session.begin({}, AgentPrograms(),
                  {.ledger = attempt.path(),
                   .overrides = remembered_overrides(words.archive),
                   .attempt = attempt.id(),
                   .ledger_line = attempt.line()});
  };
  result.stored = result.progress.done = merge_chunks(chunks, words.archive,
                                                      {.overwrite = words.overwrite,
                                                       .until_verdict = words.until_verdict,
                                                       .fail_fast = words.fail_fast.value_or(0),
                                                       .keep = keep,
                                                       .publishes = begin,
                                                       .tick = counter_of(*progress, chunks.grid().count())});
  progress.reset();
  session.end(result, 0);
  talk("{} of {} put together in {}\n", result.stored, count_text(result.progress.planned, "run"), words.archive);
  const int verdict = tell_verdict(words.archive, attempt, {words.json, words.exit_zero});
  return interrupted() != 0 ? exit_code_of_signal(interrupted()) : verdict;
}

int merge(const MergeWords& words) {
  listen_to_interrupts();
  try {
    return put_together(words);
  } catch (const Interrupted&) {
    talk("interrupted before all chunks were read; nothing was written, and the same command begins anew\n");
    return exit_code_of_signal(interrupted());
  }
}

}  // namespace

Action prepare_merge(Options& options) {
  auto words = std::make_shared<MergeWords>();
  options.positionals("DIR", words->folders,
                      "folder of the shards; several, if the shards had no common disk and each wrote to its own");
  options.option("--db", words->archive,
                 "results file to write (default: the campaign's name and .db, in this folder)");
  options.option("--fail-fast", words->fail_fast, "keep the runs up to so many failed ones, in order of run index");
  options.flag("--until-verdict", words->until_verdict,
               "keep the runs up to where the gates had given the verdict; chunks after it may be missing");
  options.option("--keep", words->keep, "rows that the file keeps: all or failing; instead of the shards' word");
  options.option("--ledger", words->ledger,
                 "ledger of the attempts to make a claim (default: attempts.jsonl beside the results file)");
  options.flag("--overwrite", words->overwrite, "replace an existing results file");
  options.flag("--exit-zero", words->exit_zero, "end with exit code 0 whatever the verdict is; 2 and 3 stay");
  options.flag("--json", words->json, "print the report as JSON");
  return [words] { return merge(*words); };
}

}  // namespace fleetproof::cli
