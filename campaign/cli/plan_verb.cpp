#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/batch/pilot.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/batch/time_budget.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "core/base/json_text.hpp"
#include "reports/evidence/evidence.hpp"
#include "reports/evidence/gate_bounds.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::chrono::seconds kPilotLength{5};
constexpr std::size_t kCellsTold = 5;

struct PlanWords {
  std::string campaign, max_time;
  std::optional<std::uint64_t> jobs;
  bool json = false;
};

// What a number of replicates gives, if no run fails.
struct Reach {
  std::uint64_t replicates = 0;
  double time_s = 0.0;
};

struct Forecast {
  CampaignPlan plan;
  Pilot pilot;
  Reach file;                                     // the replicates of the file
  std::optional<Reach> budget;                    // those that fit into --max-time
  std::vector<std::vector<std::uint32_t>> gates;  // the cells that each gate judges
  std::vector<GateCells> gate_cells;
  std::vector<GateRecord> rules;  // the gates, with their tables
};

// The part of a campaign's time that some cells take.
double share_of(const Forecast& forecast, const std::vector<std::uint32_t>& cells) {
  double sum_s = 0.0;
  for (const std::uint32_t cell : cells) sum_s += forecast.pilot.cells[cell].mean_s;
  return sum_s / std::max(1e-12, forecast.pilot.replicate_s());
}

std::vector<std::uint32_t> cells_of_no_gate(const Forecast& forecast) {
  std::vector<bool> judged(forecast.pilot.cells.size(), false);
  for (const auto& gate : forecast.gates) {
    for (const std::uint32_t cell : gate) judged[cell] = true;
  }
  std::vector<std::uint32_t> cells;
  for (std::uint32_t cell = 0; cell < judged.size(); ++cell) {
    if (!judged[cell]) cells.push_back(cell);
  }
  return cells;
}

struct Cost {
  std::string what;
  std::size_t cells = 0;
  double share = 0.0;
};

// The cells with one value of a factor, most expensive value first.
template <class ValueOf>
std::vector<Cost> costs_by(const Forecast& forecast, ValueOf value_of) {
  std::map<std::string, std::vector<std::uint32_t>> groups;
  for (const CellRecord& cell : forecast.plan.cells()) groups[value_of(cell)].push_back(cell.index);
  std::vector<Cost> costs;
  for (const auto& [value, cells] : groups) costs.push_back({value, cells.size(), share_of(forecast, cells)});
  std::ranges::stable_sort(costs, std::ranges::greater{}, &Cost::share);
  return costs;
}

struct CostTable {
  std::string factor;
  std::vector<Cost> costs;
};

std::vector<CostTable> cost_tables(const Forecast& forecast) {
  std::vector<CostTable> tables;
  const auto add = [&](std::string factor, auto value_of) {
    tables.push_back({std::move(factor), costs_by(forecast, value_of)});
    if (tables.back().costs.size() < 2) tables.pop_back();
  };
  add("agent", [](const CellRecord& cell) { return cell.agent; });
  add("layout", [](const CellRecord& cell) { return cell.layout; });
  add("fleet", [](const CellRecord& cell) { return fmt::format("{} AGVs", cell.fleet_size); });
  add("radio", [](const CellRecord& cell) { return factor_spans(cell.lowest, cell.highest); });
  return tables;
}

std::vector<Cost> most_expensive_cells(const Forecast& forecast) {
  auto costs = costs_by(forecast, [](const CellRecord& cell) {
    return fmt::format("{}, {}, {} AGVs, {}", cell.agent, cell.layout, cell.fleet_size,
                       factor_spans(cell.lowest, cell.highest));
  });
  costs.resize(std::min(kCellsTold, costs.size()));
  return costs;
}

bool counts_only(const Forecast& forecast) { return forecast.plan.kind == CampaignKind::Search; }

double bound_without_failure(const Forecast& forecast, std::size_t index, std::uint64_t replicates) {
  return gate_bounds(forecast.rules[index], 0, replicates, forecast.gate_cells[index]).upper;
}

std::optional<std::uint64_t> replicates_without_failure(const Forecast& forecast, std::size_t index) {
  return units_to_pass(forecast.rules[index], 0, 0, forecast.gate_cells[index]);
}

void print_gate(const Forecast& forecast, std::size_t index) {
  const GateRecord& gate = forecast.plan.gates[index];
  const std::size_t cells = forecast.gates[index].size();
  put("gate {}: {}, limit {} at confidence {}\n", in_quotes(gate.name), count_text(cells, "cell"), limit_text(gate),
      percent(gate.confidence));
  if (cells == 0 || counts_only(forecast)) {
    put("  {}\n", cells == 0 ? "no cell lies in its region" : "a search gives counts, no bounds");
    return;
  }
  const auto tell = [&](const Reach& reach, std::string_view whose) {
    put("  {} ({}): the bound is {} if none fails\n", count_text(reach.replicates, "replicate"), whose,
        value_text(gate, bound_without_failure(forecast, index, reach.replicates), rounded_up));
  };
  tell(forecast.file, "of the file");
  if (forecast.budget) tell(*forecast.budget, "in the time given");
  if (const auto needed = replicates_without_failure(forecast, index))
    put("  {} without a failure meet the limit: {}\n", count_text(*needed, "replicate"),
        duration_text(forecast.pilot.forecast_s(*needed)));
}

void print_costs(const Forecast& forecast) {
  put("where the time goes:\n");
  for (const CostTable& table : cost_tables(forecast)) {
    std::vector<std::string> parts;
    for (const Cost& cost : table.costs) parts.push_back(fmt::format("{} {}", cost.what, percent(cost.share)));
    if (parts.size() > kCellsTold) {
      parts.resize(kCellsTold);
      parts.push_back("...");
    }
    put("  by {}: {}\n", table.factor, joined(parts, "; "));
  }
  put("  most expensive cells:\n");
  for (const Cost& cost : most_expensive_cells(forecast)) put("    {}: {}\n", cost.what, percent(cost.share));
  const auto spare = cells_of_no_gate(forecast);
  if (!forecast.gates.empty() && !spare.empty())
    put("  {} of {} are judged by no gate and take {}: cut these first\n", spare.size(),
        count_text(forecast.pilot.cells.size(), "cell"), percent(share_of(forecast, spare)));
}

void print_text(const PlanWords& words, const Forecast& forecast) {
  const Pilot& pilot = forecast.pilot;
  put("{}: {} x {} = {} of {:g} s\n", words.campaign, count_text(pilot.cells.size(), "cell"),
      count_text(forecast.plan.replicates, "replicate"), count_text(forecast.plan.run_count(), "run"),
      forecast.plan.horizon_s);
  put("pilot: {} in {:.1f} s with {}: {:.1f} runs/s\n", count_text(pilot.runs, "run"), pilot.elapsed_s,
      count_text(static_cast<std::uint64_t>(pilot.workers), "worker"), pilot.runs_per_s());
  put("{}: about {}, if the machine stays as busy as in the pilot\n", count_text(forecast.file.replicates, "replicate"),
      duration_text(forecast.file.time_s));
  if (forecast.budget)
    put("in {}: {}, {}\n", duration_text(forecast.budget->time_s), count_text(forecast.budget->replicates, "replicate"),
        count_text(forecast.budget->replicates * pilot.cells.size(), "run"));
  for (std::size_t gate = 0; gate < forecast.gates.size(); ++gate) print_gate(forecast, gate);
  print_costs(forecast);
}

Json json_of(const Reach& reach) { return {{"replicates", reach.replicates}, {"time_s", reach.time_s}}; }

Json json_of(const std::vector<Cost>& costs) {
  auto list = Json::array();
  for (const Cost& cost : costs) list.push_back({{"what", cost.what}, {"cells", cost.cells}, {"share", cost.share}});
  return list;
}

Json json_of_gate(const Forecast& forecast, std::size_t index) {
  const GateRecord& gate = forecast.plan.gates[index];
  Json json = {{"name", gate.name},
               {"cells", forecast.gates[index].size()},
               {"limit", gate.limit},
               {"confidence", gate.confidence}};
  if (forecast.gates[index].empty() || counts_only(forecast)) return json;
  json["bound_of_file"] = bound_without_failure(forecast, index, forecast.file.replicates);
  if (forecast.budget) json["bound_in_time"] = bound_without_failure(forecast, index, forecast.budget->replicates);
  if (const auto needed = replicates_without_failure(forecast, index))
    json["limit_met_by"] = json_of(Reach{*needed, forecast.pilot.forecast_s(*needed)});
  return json;
}

void print_json(const Forecast& forecast) {
  const Pilot& pilot = forecast.pilot;
  Json json = {{"schema_version", 1},
               {"cells", pilot.cells.size()},
               {"workers", pilot.workers},
               {"pilot", {{"runs", pilot.runs}, {"elapsed_s", pilot.elapsed_s}}},
               {"runs_per_s", pilot.runs_per_s()},
               {"file", json_of(forecast.file)}};
  if (forecast.budget) json["in_time"] = json_of(*forecast.budget);
  json["gates"] = Json::array();
  for (std::size_t gate = 0; gate < forecast.gates.size(); ++gate)
    json["gates"].push_back(json_of_gate(forecast, gate));
  for (const CostTable& table : cost_tables(forecast)) json["costs"][table.factor] = json_of(table.costs);
  json["costs"]["most_expensive_cells"] = json_of(most_expensive_cells(forecast));
  if (!forecast.gates.empty()) {
    const auto spare = cells_of_no_gate(forecast);
    json["costs"]["in_no_gate"] = {{"cells", spare.size()}, {"share", share_of(forecast, spare)}};
  }
  put_text(shown_json(json));
}

int plan(const PlanWords& words) {
  AgentPrograms programs;
  Forecast forecast;
  const CampaignFile file = load_campaign(words.campaign, programs);
  forecast.plan = file.plan;
  const int workers = worker_count(words.jobs);
  std::optional<std::chrono::seconds> budget;
  if (!words.max_time.empty()) budget = duration_of(words.max_time, "--max-time");
  try_first_worlds(forecast.plan, file.places);
  {
    WorkProgress progress("plan", nullptr, static_cast<double>(kPilotLength.count()));
    progress.begin("simulating the first replicates");
    forecast.pilot = run_pilot(forecast.plan, programs, workers, {.time = kPilotLength});
  }
  forecast.file = {forecast.plan.replicates, forecast.pilot.forecast_s(forecast.plan.replicates)};
  if (budget) {
    const auto time_s = static_cast<double>(budget->count());
    forecast.budget = {forecast.pilot.replicates_within(time_s), time_s};
  }
  const Evidence evidence(stored_plan(forecast.plan, programs));
  for (std::size_t gate = 0; gate < forecast.plan.gates.size(); ++gate) {
    forecast.gates.push_back(evidence.cells_of(gate));
    forecast.gate_cells.push_back(evidence.gate_cells(gate));
  }
  forecast.rules = evidence.gates();
  words.json ? print_json(forecast) : print_text(words, forecast);
  return kDemonstrated;
}

}  // namespace

Action prepare_plan(Options& options) {
  auto words = std::make_shared<PlanWords>();
  options.positional("CAMPAIGN", words->campaign, "campaign file (TOML)");
  options.option("--max-time", words->max_time, "also say what this time gives, as in 45m or 5h30m");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.flag("--json", words->json, "print JSON");
  return [words] { return plan(*words); };
}

}  // namespace fleetproof::cli
