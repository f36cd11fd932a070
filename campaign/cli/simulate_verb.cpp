#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>

#include <nlohmann/json.hpp>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/recorded_elsewhere.hpp"
#include "campaign/cli/run_observers.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/case_file.hpp"
#include "campaign/run/case_run.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/watch/run_text.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/engine/simulation.hpp"
#include "core/scenario/scripted_agent.hpp"
#include "generators/formats/purpose_words.hpp"
#include "laws/comparison.hpp"
#include "laws/exact_law.hpp"
#include "laws/laws.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

struct SimulateWords {
  std::string scenario, agent, law, config;
  std::vector<std::string> plugins, computers;
  std::string granularity;
  std::optional<std::uint64_t> draw, radio_draw;
  ObserverWords observed;
  bool json = false, in_process = false, global_symbols = false;
  std::string agent_place;  // what names the agent: the option, or the key of the scenario file
};

// Divided, not multiplied: the double nearest to the decimal number.
double millionths(std::int64_t value) { return static_cast<double>(value) / 1e6; }

Json to_json(const Violation& violation, const Scenario& scenario) {
  return {{"entities", {body_name(scenario, violation.a), body_name(scenario, violation.b)}},
          {"first_s", to_seconds(violation.first)},
          {"first_ns", to_ns(violation.first)},
          {"last_s", to_seconds(violation.last)},
          {"last_ns", to_ns(violation.last)},
          {"min_clearance_m", millionths(violation.min_clearance_um)},
          {"min_clearance_um", violation.min_clearance_um},
          {"at_s", to_seconds(violation.closest_at)},
          {"at_ns", to_ns(violation.closest_at)},
          {"contact", violation.contact},
          {"level", name_of(level_of(violation))},
          {"entity_kinds", violation.b.index() < scenario.agvs.size() ? "AGV-AGV" : "AGV-obstacle"},
          {"relative_speed_mps", millionths(violation.relative_speed_um_s)},
          {"relative_speed_um_s", violation.relative_speed_um_s},
          {"normal_speed_mps", millionths(violation.normal_speed_um_s)},
          {"normal_speed_um_s", violation.normal_speed_um_s},
          {"x_m", millionths(violation.x_um)},
          {"x_um", violation.x_um},
          {"y_m", millionths(violation.y_um)},
          {"y_um", violation.y_um}};
}

Json to_json(const Incident& incident, const Scenario& scenario) {
  const IncidentKindInfo& info = info_of(incident.kind);
  const auto name = [&](EntityId id) { return id.valid() ? Json(body_name(scenario, id)) : Json(nullptr); };
  return {{"kind", info.name},
          {"a", name(incident.a)},
          {"b", name(incident.b)},
          {"first_s", to_seconds(incident.first)},
          {"first_ns", to_ns(incident.first)},
          {"last_s", to_seconds(incident.last)},
          {"last_ns", to_ns(incident.last)},
          {"value", incident.value},
          {"unit", info.unit}};
}

// "1s", "2.5ms", "0.0025". At least a microsecond: with shorter steps, a run has so many snapshots that it takes too
// long.
double granularity_s(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc{} || (unit != "" && unit != "s" && unit != "ms")) {
    throw InputError("--granularity", fmt::format("\"{}\" is no duration; write 1s, 2.5ms or plain seconds", text));
  }
  const double in_seconds = unit == "ms" ? value / 1000.0 : value;
  if (!(in_seconds >= 1e-6 && in_seconds <= 1e6))
    throw InputError("--granularity", fmt::format("is {} s; it lies from 0.000001 to 1000000 s", in_seconds));
  return in_seconds;
}

struct Observers {
  std::vector<std::unique_ptr<Law>> laws;  // the judge first
  const Law* compared_with = nullptr;      // safety-distance, beside a published rule
  const TimelineKeeper* timelines = nullptr;
  std::vector<Difference> differences(const Scenario& scenario) const {
    if (compared_with == nullptr) return {};
    return compare(scenario, laws.front()->findings(), compared_with->findings(), *timelines);
  }
};

// The named judge, and the default set of laws beside it. A law that does not judge clearances observes alone.
Observers observers_of(const std::string& name, const Scenario& scenario) {
  const auto* law = find_law(name);
  if (law == nullptr) {
    auto names = names_of(laws());
    names.emplace_back("exact");
    throw InputError("--law",
                     fmt::format("\"{}\" is not a law{} (see: fleetproof list laws)", name, name_hint(name, names)));
  }
  Observers observers;
  if (law != &judge_of_violations()) observers.laws.push_back(law->make(scenario));
  const bool published = is_to_compare_with(*law);
  if (!observers.laws.empty() && !published) return observers;
  std::ranges::move(make_default_laws(scenario, scenario.law.leave_out), std::back_inserter(observers.laws));
  if (!published) return observers;
  // A published rule knows no exemptions, so an exempt violation that it files is no mistake.
  observers.laws[1] = make_exact_law(scenario);
  observers.compared_with = observers.laws[1].get();
  auto timelines = std::make_unique<TimelineKeeper>(scenario);
  observers.timelines = timelines.get();
  observers.laws.push_back(std::move(timelines));
  return observers;
}

// Only a judge of clearances measures the smallest clearance.
bool measures_clearance(const SimulateWords& words) { return find_law(words.law) == &judge_of_violations(); }

// What a published law counted for each drive activity, as the paper tells it; empty for all other laws.
Json drives_json(const Scenario& scenario, const std::vector<DriveChecks>& drives) {
  auto json = Json::array();
  for (const auto& [agv, begin, end, perimeter_checks] : drives)
    json.push_back({{"agv", body_name(scenario, agv)},
                    {"begin_s", to_seconds(begin)},
                    {"end_s", to_seconds(end)},
                    {"perimeter_checks", perimeter_checks}});
  return json;
}

void print_json(const Scenario& scenario, const Outcome& outcome, const SimulateWords& words,
                const Observers& observers, const ExpectedOutcome& found) {
  Json json;
  json["schema_version"] = 1;
  json["scenario"] = scenario.name;
  json["agent"] = words.agent;
  json["law"] = find_law(words.law)->name;
  json["exempt_purposes"] = purposes_text(scenario.law.exempt_purposes);
  json["exempt_radius_m"] = scenario.law.exempt_radius_m;
  json["exempt_pairs"] = Json::array();
  for (const auto& [one, other] : scenario.law.exempt_pairs) json["exempt_pairs"].push_back({one, other});
  json["outcome"] = name_of(outcome.outcome_class());
  if (scenario.expected != ExpectedOutcome{}) {
    json["expected"] = {{"failure", scenario.expected.failure},
                        {"found", found.failure},
                        {"same_failure", scenario.expected.failure == found.failure},
                        {"same_run", scenario.expected == found}};
  }
  json["violations"] = Json::array();
  for (const Violation& violation : outcome.violations) json["violations"].push_back(to_json(violation, scenario));
  json["incidents"] = Json::array();
  for (const Incident& incident : outcome.incidents) json["incidents"].push_back(to_json(incident, scenario));
  json["met"] = Json::array();
  for (const ProbeCount& probe : outcome.probes)
    json["met"].push_back({{"source", name_of(probe.source)}, {"name", probe.name}, {"count", probe.count}});
  if (observers.compared_with != nullptr) {
    json["compared_with"] = judge_of_violations().name;
    json["differences"] = Json::array();
    for (const Difference& difference : observers.differences(scenario)) {
      json["differences"].push_back({{"what", difference.missed ? "missed" : "accused wrongly"},
                                     {"cause", name_of(difference.cause)},
                                     {"violation", to_json(difference.violation, scenario)}});
    }
  }
  json["clearance_measured"] = measures_clearance(words);
  json["min_clearance_m"] = nullptr;
  json["min_clearance_um"] = nullptr;
  if (outcome.min_clearance_um) {
    json["min_clearance_m"] = millionths(*outcome.min_clearance_um);
    json["min_clearance_um"] = *outcome.min_clearance_um;
  }
  for (const CounterInfo& counter : kCounters) json["counters"][counter.name] = outcome.counters.*counter.member;
  json["drives"] = drives_json(scenario, observers.laws.front()->findings().drives);
  json["digest"] = fmt::format("{:016x}", outcome.digest);
  if (!outcome.message.empty()) json["message"] = outcome.message;
  put_text(shown_json(json));
}

// The command line decides, then the scenario file, then whether it has a script, then the one plug-in.
std::string agent_of(const SimulateWords& words, const Scenario& scenario, const AgentPrograms& programs) {
  if (!words.agent.empty()) return words.agent;
  if (!scenario.agent.empty()) return scenario.agent;
  if (std::ranges::any_of(scenario.agvs, [](const AgvSetup& agv) { return !agv.script.empty(); }))
    return std::string(kScriptedAgent);
  if (words.plugins.size() == 1) return words.plugins.front();
  std::vector<std::string> names;
  for (const AgentProgram& program : programs.all()) names.push_back(program.name);
  throw InputError("--agent",
                   fmt::format("neither the scenario file nor the command line names an agent, and no AGV has "
                               "a script; name one of {}, or load one with --plugin",
                               fmt::join(names, ", ")));
}

// Whether a saved case does what it did when it was saved.
std::string expectation_text(const ExpectedOutcome& expected, const ExpectedOutcome& found) {
  if (expected == found) return fmt::format("  as expected: {}\n", expected.failure);
  if (expected.failure == found.failure)
    return fmt::format("  expected: {}; it fails so, but the run went otherwise\n", expected.failure);
  return fmt::format("  NOT as expected: {} was expected, {} was found\n", expected.failure, found.failure);
}

// What a saved case does now: the failure for which it was saved, if it still has that one, although another may lead.
ExpectedOutcome found_now(const Scenario& scenario, const FleetSoftware& software, const RunWatch& watch) {
  const auto found_for = [&](FailureChoice choice, Outcome& outcome) {
    const CaseRun run = run_case(scenario, software, scenario.law.leave_out, Deliveries::Ignored, watch, choice);
    outcome = run.outcome;
    return expectation_of(run);
  };
  Outcome outcome;
  ExpectedOutcome found = found_for({}, outcome);
  const std::string& wanted = scenario.expected.failure;
  for (const RunFailure& failure : failures_of(outcome)) {
    if (found.failure == wanted) break;
    const bool is_wanted = wanted == failure.what || wanted.starts_with(failure.what + " (");
    if (is_wanted && failure.end_point) found = found_for({bit_of(*failure.end_point)}, outcome);
  }
  return found;
}

// The run is simulated once before its trace is printed, so that lines about the safety distance stand where they
// belong. In a debugger, a plug-in runs once.
std::vector<Violation> violations_before(const SimulateWords& words, const Scenario& scenario,
                                         const FleetSoftware& software, const RunWatch& watch) {
  if (!words.observed.trace.wanted() || words.in_process) return {};
  const Observers observers = observers_of(words.law, scenario);
  return simulate(scenario, software, observers.laws, nullptr, watch).violations;
}

// What is not built in runs in a worker process. What it did there is played here.
std::string recorded_in_worker(SimulateWords words, const Scenario& scenario) {
  if (words.in_process) return {};
  AgentPrograms known;
  words.agent = meet_agent(words.agent, words.plugins, known, &AgentPrograms::know, words.global_symbols);
  CaseAgent agent{words.agent, words.config, scenario.law.leave_out};
  agent.computers = computer_parts(scenario, words.plugins, known, &AgentPrograms::know, words.global_symbols);
  (void)known.parts_of(factor_of(agent), words.agent_place);
  known.require_computers(factor_of(agent), scenario, words.scenario + ": ");
  return recorded_elsewhere(scenario, agent, known);
}

// The agent with a program for each computer of the scenario. Throws InputError if it cannot play the scenario.
AgentFactor met_parts(SimulateWords& words, const Scenario& scenario, AgentPrograms& programs, MeetPlugin meet) {
  words.agent = meet_agent(words.agent, words.plugins, programs, meet, words.global_symbols);
  AgentFactor agent(words.agent);
  agent.computers = computer_parts(scenario, words.plugins, programs, meet, words.global_symbols);
  refuse_idle_symbols(words.global_symbols, agent, programs);
  for (const AgentProgram* part : programs.parts_of(agent, words.agent_place))
    require_room(*part, *scenario.map, scenario.agvs.size(), "the scenario", words.agent_place);
  require_distribution(programs.program(agent.program, words.agent_place), !scenario.open_orders.empty(),
                       !scenario.computers.empty(), words.agent_place);
  return agent;
}

std::uint32_t draw_number(std::uint64_t number, const char* option) {
  constexpr auto kMost = std::numeric_limits<std::uint32_t>::max();
  if (number < 1 || number > kMost) throw InputError(option, fmt::format("is {}; it lies from 1 to {}", number, kMost));
  return static_cast<std::uint32_t>(number);
}

// Other draws than the scenario's own. Then nothing is expected of it.
Scenario with_draws(const SimulateWords& words, Scenario scenario) {
  if (!words.draw && !words.radio_draw) return scenario;
  if (words.draw) scenario = with_other_draws(std::move(scenario), draw_number(*words.draw, "--draw"));
  if (words.radio_draw)
    scenario = with_other_radio(std::move(scenario), draw_number(*words.radio_draw, "--radio-draw"));
  scenario.expected = {};
  return scenario;
}

// What a replay page says of the run of a scenario file. A word that was not given is not in the command.
ReplayWords page_words(const SimulateWords& words) {
  std::string command = "fleetproof simulate " + shell_word(words.scenario) + " --agent " + shell_word(words.agent);
  for (const std::string& plugin : words.plugins) command += " --plugin " + shell_word(plugin);
  for (const std::string& computer : words.computers) command += " --computer " + shell_word(computer);
  if (words.global_symbols) command += " --global-symbols";
  if (!words.config.empty()) command += " --agent-config " + shell_word(words.config);
  if (words.law != judge_of_violations().name) command += " --law " + shell_word(words.law);
  if (words.draw) command += fmt::format(" --draw {}", *words.draw);
  if (words.radio_draw) command += fmt::format(" --radio-draw {}", *words.radio_draw);
  if (!words.granularity.empty()) command += " --granularity " + shell_word(words.granularity);
  return {command, {{"agent", words.agent}}};
}

int simulate_scenario(SimulateWords words) {
  refuse_results(words.scenario, fmt::format("name a run of it: fleetproof replay {} RUN", shell_word(words.scenario)));
  Scenario scenario = with_draws(words, read_case_file(words.scenario));
  take_computer_programs(scenario, words.computers, words.scenario);
  if (!words.granularity.empty()) scenario.law.snapshot_s = granularity_s(words.granularity);
  AgentPrograms programs;
  const bool names_agent = words.agent.empty() && !scenario.agent.empty();
  words.agent_place = names_agent ? words.scenario + ": /agent" : "--agent";
  words.agent = agent_of(words, scenario, programs);
  if (words.config.empty()) words.config = scenario.agent_config;
  std::optional<WorkProgress> progress;
  progress.emplace("simulate", nullptr);
  progress->begin("simulating the run");
  const std::string recording = recorded_in_worker(words, scenario);
  const bool is_played = !recording.empty();
  const AgentFactor agent =
      met_parts(words, scenario, programs, is_played ? &AgentPrograms::know : &AgentPrograms::load);
  // The published laws work on after the last event, where only the signal itself can end them.
  if (measures_clearance(words)) listen_to_interrupts();
  const TimeLimit limit({}, is_interrupted);
  RunWatch watch;
  watch.play = recording;
  watch.abandon = &limit.over();
  const FleetSoftware software =
      is_played ? programs.software_to_play(scenario) : programs.software(agent, words.config, scenario);
  watch.foreign = is_played ? nullptr : programs.handles_of(agent);
  const Observers observers = observers_of(words.law, scenario);
  std::optional<RunObservers> observed;
  if (words.observed.wanted())
    observed.emplace(words.observed, scenario, violations_before(words, scenario, software, watch), page_words(words));
  if (words.observed.trace.wanted()) progress.reset();  // the trace itself shows how far it is
  const Outcome outcome = simulate(scenario, software, observers.laws, observed ? &*observed : nullptr, watch);
  if (observed) observed->finish(outcome);
  const bool is_saved_case = scenario.expected != ExpectedOutcome{};
  const ExpectedOutcome found = is_saved_case ? found_now(scenario, software, watch) : ExpectedOutcome{};
  progress.reset();
  if (words.json) {
    print_json(scenario, outcome, words, observers, found);
  } else {
    put_text(outcome_text(scenario, outcome, measures_clearance(words)));
    if (observers.compared_with != nullptr)
      put_text(differences_text(scenario, observers.differences(scenario), find_law(words.law)->name));
  }
  if (!words.json && is_saved_case) put_text(expectation_text(scenario.expected, found));
  if (plays_scripts(words.agent) && outcome.counters.refused_calls > 0)
    talk("note: the controller refused {} of the script; see --trace --trace-kind refused\n",
         count_text(outcome.counters.refused_calls, "call"));
  if (outcome.engine_error) return kEngineFault;
  if (outcome.violation || outcome.contact) return kViolated;
  return outcome.outcome_class() == OutcomeClass::Clean ? kDemonstrated : kNotDemonstrated;
}

// A signal ends the run in its middle. What the trace has told until then stands.
int simulate_until_interrupted(const SimulateWords& words) {
  try {
    return simulate_scenario(words);
  } catch (const RunAbandoned&) {
    talk("interrupted before the end of the run; it has no outcome\n");
    return exit_code_of_signal(interrupted());
  }
}

}  // namespace

Action prepare_simulate(Options& options) {
  auto words = std::make_shared<SimulateWords>();
  words->law = judge_of_violations().name;
  options.positional("SCENARIO", words->scenario, "scenario file (JSON)");
  options.option("--agent", words->agent,
                 "control software under test (default: the scenario file's agent, or scripted if it has a script)");
  options.option("--agent-config", words->config,
                 "text handed to the agent as its own parameters (default: the scenario file's)");
  options.option("--plugin", words->plugins, "shared object or \"lockstep:COMMAND\" of an agent; may be repeated");
  add_computer_option(options, words->computers);
  add_symbols_option(options, words->global_symbols);
  options.option("--law", words->law, "law that judges (default: safety-distance, also called exact)");
  options.option("--granularity", words->granularity,
                 "snapshot step of the published laws: 1s, 2.5ms or plain seconds (default: the scenario's, 0.0025)");
  options.option("--draw,--luck", words->draw, "draw radio and agents anew: each number gives another run");
  options.option("--radio-draw,--radio-luck", words->radio_draw, "draw the radio anew, and nothing else");
  options.flag("--in-process", words->in_process, "run the agent in this process at once, for a debugger");
  options.flag("--json", words->json, "print JSON");
  add_observer_options(options, words->observed);
  return [words] { return simulate_until_interrupted(*words); };
}

}  // namespace fleetproof::cli
