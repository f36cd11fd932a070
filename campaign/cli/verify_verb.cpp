#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/batch/verification.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/plan/plan_text.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "reports/page/wording.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof::cli {
namespace {

struct VerifyWords {
  std::string archive, sample = "1%";
  std::vector<std::string> plugins;
  std::optional<std::uint64_t> jobs;
  bool json = false;
};

// What was asked of the file before runs are simulated.
struct IntactFile {
  CampaignRecord campaign;
  std::uint64_t runs = 0, content_digest = 0;
};

// Reads every row and checks its checksum.
IntactFile read_intact(const std::string& path) {
  const ArchiveReader archive(path);
  return {archive.campaign(), archive.run_count(), archive.content_digest()};
}

void print_text(const VerifyWords& words, const IntactFile& file, const Verification& verification) {
  for (const Disagreement& run : verification.differing) {
    put("{}  run {}: {}: {}\n", name_of(run.verdict), run.run_index, run.agent, run.explanation);
    put("  {}\n", replay_command(words.archive, run.run_index));
  }
  put("{}: {}, every checksum holds; {} simulated again: {} agree, {} differ\n", words.archive,
      count_text(file.runs, "run"), verification.agreeing + verification.differing.size(), verification.agreeing,
      verification.differing.size());
}

void print_json(const VerifyWords& words, const IntactFile& file, const Verification& verification) {
  Json json = {{"schema_version", 1},
               {"runs", file.runs},
               {"simulated_again", verification.agreeing + verification.differing.size()},
               {"agree", verification.agreeing},
               {"differ", Json::array()}};
  for (const Disagreement& run : verification.differing) {
    json["differ"].push_back({{"run", run.run_index},
                              {"agent", run.agent},
                              {"verdict", name_of(run.verdict)},
                              {"explanation", run.explanation},
                              {"engine_at_fault", run.engine_at_fault},
                              {"replay", replay_command(words.archive, run.run_index)}});
  }
  put_text(shown_json(json));
}

int verify(const VerifyWords& words) {
  const int workers = worker_count(words.jobs);
  std::atomic<std::size_t> done = 0;
  std::optional<WorkProgress> progress;
  progress.emplace("verify", [&] { return done.load(); });
  progress->begin("reading every row of " + words.archive);
  const IntactFile file = read_intact(words.archive);
  const std::uint64_t size = sample_size(words.sample, file.runs);
  const CampaignPlan plan = parse_plan(file.campaign.plan_json);
  AgentPrograms programs;
  meet_plugins(words.archive, file.campaign, plan.agents, words.plugins, programs, &AgentPrograms::know);
  tell_rebuilt_plugins(file.campaign, plan.agents, programs);
  const auto sample = sample_of_runs(file.content_digest, file.runs, size);
  listen_to_interrupts();
  progress->begin("simulating runs again");
  const Verification verification =
      verify_runs(words.archive, plan, programs, sample, workers, [&](std::size_t compared) {
        progress->count(done = compared, sample.size());
        return !is_interrupted();
      });
  progress.reset();
  words.json ? print_json(words, file, verification) : print_text(words, file, verification);
  const auto& differing = verification.differing;
  if (is_interrupted()) {
    talk("interrupted: {} of {} were simulated again\n", done.load(), count_text(sample.size(), "run"));
    return exit_code_of_signal(interrupted());
  }
  if (std::ranges::any_of(differing, &Disagreement::engine_at_fault)) return kEngineFault;
  return differing.empty() && file.runs > 0 ? kDemonstrated : kNotDemonstrated;
}

}  // namespace

Action prepare_verify(Options& options) {
  auto words = std::make_shared<VerifyWords>();
  options.positional("DB", words->archive, "results file");
  options.option("--sample", words->sample, "how many runs to simulate again: 1% (default), 100%, or a number");
  options.option("--plugin", words->plugins,
                 "shared object or \"lockstep:COMMAND\" of an agent (default: what the campaign used)");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.flag("--json", words->json, "print JSON");
  return [words] { return verify(*words); };
}

}  // namespace fleetproof::cli
