#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "campaign/campaign.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/run_one.hpp"
#include "generators/scenario_file.hpp"
#include "generators/validator.hpp"

namespace fleetproof::cli {
namespace {

// One run per cell until a second is over: enough for an estimate, and every world of the first replicate that it reaches is really built.
double mean_run_s(const CampaignPlan& plan, const AgentPrograms& programs) {
  using Clock = std::chrono::steady_clock;
  const RunOne run_one(plan, programs);
  const auto begin = Clock::now();
  std::uint64_t runs = 0;
  double elapsed_s = 0.0;
  while (runs < plan.cell_count() && elapsed_s < 1.0) {
    run_one(runs++);
    elapsed_s = std::chrono::duration<double>(Clock::now() - begin).count();
  }
  return elapsed_s / static_cast<double>(runs);
}

void check_campaign(const std::string& path) {
  AgentPrograms programs;
  const CampaignFile file = load_campaign(path, programs);
  const CampaignPlan& plan = file.plan;
  build_first_worlds(plan);
  const double total_s = mean_run_s(plan, programs) * static_cast<double>(plan.run_count());
  fmt::print("{}: ok, {} cells x {} replicates = {} runs of {:g} s; about {:.0f} s of one core\n", path, plan.cell_count(), plan.replicates, plan.run_count(),
             plan.horizon_s, total_s);
}

void check_scenario(const std::string& path) {
  const Scenario scenario = read_scenario(path);
  for (const auto& problem : problems_of(scenario)) fmt::print(stderr, "warning: {}: {}\n", path, problem.sentence);
  fmt::print("{}: ok, {} stations, {} segments, {} AGVs, {:g} s\n", path, scenario.map->station_count(), scenario.map->segment_count(), scenario.agvs.size(),
             to_seconds(scenario.horizon));
}

int check(const std::vector<std::string>& files) {
  for (const std::string& file : files) file.ends_with(".json") ? check_scenario(file) : check_campaign(file);
  return kDemonstrated;
}

}  // namespace

Action prepare_check(Options& options) {
  auto files = std::make_shared<std::vector<std::string>>();
  options.positionals("FILE", *files, "campaign files (TOML) or scenario files (JSON)");
  return [files] { return check(*files); };
}

}  // namespace fleetproof::cli
