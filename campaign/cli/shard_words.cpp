#include "campaign/cli/shard_words.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "campaign/batch/session_log.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/run/release.hpp"
#include "campaign/shards/shard_engine.hpp"
#include "campaign/shards/shard_run.hpp"
#include "core/base/error.hpp"
#include "reports/page/wording.hpp"
#include "storage/beside.hpp"

namespace fleetproof::cli {
namespace {

ShardChoice chosen_shard(const ShardWords& words) {
  if (words.shard.empty()) {
    const char* option = words.out.empty() ? "--shards" : "--out";
    throw InputError(option, "belongs to one shard of a campaign; name the shard with --shard i/n or --shard auto");
  }
  if (words.out.empty())
    throw InputError("--shard", "needs the folder that all shards of the campaign write to; name it with --out");
  if (words.shard == "auto") {
    return find_shard(
        [](const std::string& variable) -> std::optional<std::string> {
          const char* value = std::getenv(variable.c_str());
          return value == nullptr ? std::nullopt : std::optional<std::string>(value);
        },
        words.shards);
  }
  const Shard shard = parse_shard(words.shard, "--shard");
  if (words.shards && *words.shards != shard.count)
    throw InputError("--shards",
                     fmt::format("is {}, and --shard says {}; leave one of them out", *words.shards, text_of(shard)));
  return {shard, "--shard " + text_of(shard)};
}

void tell_plan(const ShardChoice& choice, const ChunkGrid& grid, const ChunkRange& owned, std::uint64_t published) {
  if (owned.count() == 0) {
    talk("shard {} ({}): none of the {} chunks, there are more shards than chunks\n", text_of(choice.shard),
         choice.source, grid.count());
    return;
  }
  talk("shard {} ({}): chunks {} to {} of {}, {} runs each; {} of them are published already\n", text_of(choice.shard),
       choice.source, owned.begin, owned.end - 1, grid.count(), grid.chunk_runs(), published);
}

}  // namespace

void add_shard_options(Options& options, ShardWords& words) {
  options.option("--shard", words.shard,
                 "simulate one part of the campaign: i/n, as in 3/8, or auto inside a job engine");
  options.option("--shards", words.shards,
                 "the number of shards, for --shard auto in an engine that does not tell it to a task");
  options.option("--out", words.out, "folder of all shards of the campaign; `fleetproof merge` puts them together");
}

int simulate_shard(const ShardWords& words, const ShardCall& call) {
  const ShardChoice choice = chosen_shard(words);
  const ShardFolder folder(words.out);
  folder.make();
  const std::string session_name = folder.new_session_name(choice.shard);
  const CampaignPlan& plan = call.file.plan;
  RunOptions options = call.options;
  options.worker_logs = beside(session_name, "");
  ShardResult result;
  {
    ProgressTalk progress(plan, object_agents(plan, call.programs), "", options.workers);
    const SessionLog session(session_name);
    ShardListener listener;
    listener.campaign = progress.listener();
    listener.campaign.wants_status = call.wants_status;
    listener.campaign.started = [&, tell = listener.campaign.started] {
      session.begin(options, call.programs,
                    {.ledger = {},
                     .overrides = call.overrides,
                     .shard = text_of(choice.shard),
                     .shard_source = choice.source,
                     .release = release_digest(plan, call.programs),
                     .fresh_seed = call.fresh_seed});
      tell();
    };
    listener.planned = [&](const ChunkRange& owned, std::uint64_t published) {
      tell_plan(choice, ChunkGrid(plan.run_count()), owned, published);
    };
    say_where_fleets_are(call.file.places,
                         [&] { result = run_shard(plan, call.programs, folder, choice.shard, options, listener); });
    session.end(result.runs, options.interrupted->load(), ShardChunks{result.owned, result.published});
  }
  if (!result.runs.audit_failure.empty())
    talk("the audits ended early: {}; the runs themselves are not affected\n", result.runs.audit_failure);
  put("shard {}: {} of {} published in {}; {} simulated\n", text_of(choice.shard), result.published,
      count_text(result.owned, "chunk"), words.out, count_text(result.runs.progress.simulated, "run"));
  if (result.complete()) return kDemonstrated;
  const int signal_number = options.interrupted->load();
  talk("{}: go on: {} --shard {} --out {}\n", signal_number != 0 ? "interrupted" : "stopped early", call.resume_command,
       text_of(choice.shard), shell_word(words.out));
  return signal_number != 0 ? exit_code_of_signal(signal_number) : kNotDemonstrated;
}

}  // namespace fleetproof::cli
