#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/case_source.hpp"
#include "campaign/cli/explain_run.hpp"
#include "campaign/cli/explained_pages.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/explain/sentences.hpp"
#include "campaign/shrink/shrink.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof::cli {
namespace {

struct ExplainWords {
  CaseWords from;
  std::string runs, html, max_time = "120";
  std::optional<std::uint64_t> jobs, trials;
  bool json = false;
};

std::string file_in(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / (name + ".json")).string();
}
std::string name_of_claim(std::size_t number) { return fmt::format("{:03}", number); }

// The drives that the AGVs of the failure were on, and the numbers of the runs in which each begins as it did, or not.
Json set_offs_json(const Explanation& explanation) {
  const auto claims = claims_of(explanation);
  const auto number_of = [&](const Claim& claim) { return std::ranges::find(claims, &claim) - claims.begin() + 1; };
  const auto& map = *explanation.small.scenario.map;
  auto all = Json::array();
  for (const SetOff& set_off : explanation.set_offs) {
    auto held = Json::array(), begins = held;
    for (const Leave& leave : set_off.leaves) {
      for (const Claim& claim : leave.claims) held.push_back(number_of(claim));
      if (leave.without_others) begins.push_back(number_of(*leave.without_others));
      for (const GoAhead& key : leave.keys) held.push_back(number_of(key.claim));
    }
    all.push_back({{"agv", name_of_body(explanation.small.scenario, set_off.agv)},
                   {"from", map.station(set_off.drive.from).name},
                   {"to", map.station(set_off.drive.to).name},
                   {"at_s", to_seconds(set_off.drive.at - kStart)},
                   {"runs_without_it", std::move(held)},
                   {"runs_with_it", std::move(begins)}});
  }
  return all;
}

Json to_json(const Explanation& explanation) {
  const Scenario& small = explanation.small.scenario;
  Json json = {{"schema_version", 1},
               {"failure", text_of(explanation.pattern.kind)},
               {"telling_words", explanation.pattern.words.telling},
               {"at_s", to_seconds(explanation.original.failure.at - kStart)},
               {"small_at_s", to_seconds(explanation.small.failure.at - kStart)},
               {"search_ended", explanation.is_smallest},
               {"not_tried", explanation.not_tried},
               {"sentences", sentences_of(explanation)}};
  json["messages"] = Json::array();
  for (const MessageNeed& need : explanation.messages) {
    const GivenDelivery& delivery = need.message.delivery;
    json["messages"].push_back({{"number", need.message.number},
                                {"kind", need.message.kind},
                                {"sender", name_of_body(small, delivery.sender)},
                                {"receiver", name_of_body(small, delivery.receiver)},
                                {"sent_s", to_seconds(delivery.sent)},
                                {"lost", delivery.lost},
                                {"delay_s", to_seconds(delivery.delay)},
                                {"needed", need.is_needed},
                                {"saves_delay_s", nullptr},
                                {"too_late_delay_s", nullptr}});
    if (!need.latest) continue;
    json["messages"].back()["saves_delay_s"] = to_seconds(need.latest->in_time);
    json["messages"].back()["too_late_delay_s"] = to_seconds(need.latest->too_late);
  }
  json["runs"] = Json::array();
  for (const Claim* claim : claims_of(explanation))
    json["runs"].push_back(
        {{"number", json["runs"].size() + 1}, {"what", claim->sentence}, {"outcome", claim->outcome.failure}});
  json["set_offs"] = set_offs_json(explanation);
  json["shares"] = Json::array();
  for (const Share& share : explanation.shares)
    json["shares"].push_back(
        {{"if", share.what}, {"failing", share.failing()}, {"of", share.of}, {"failing_draws", share.failing_draws}});
  json["branches_each"] = kBranches;
  json["curve_of_no_return"] = Json::array();
  for (const Branching& branching : explanation.no_return.curve)
    json["curve_of_no_return"].push_back({{"at_s", to_seconds(branching.at - kStart)},
                                          {"failing", branching.failing()},
                                          {"failing_radio_draws", branching.failing_draws}});
  json["open_until_s"] = to_seconds(explanation.no_return.open_until - kStart);
  json["likely_from_s"] = json["certain_from_s"] = json["acted_by_s"] = nullptr;
  if (const auto at = explanation.no_return.likely_from) json["likely_from_s"] = to_seconds(*at - kStart);
  if (const auto at = explanation.no_return.certain_from) json["certain_from_s"] = to_seconds(*at - kStart);
  if (const auto at = explanation.no_return.acted_by) json["acted_by_s"] = to_seconds(*at - kStart);
  return json;
}

// Each run that a sentence names, as a scenario file; shares and branches with their own draws.
void save_runs(const ExplainWords& words, const CaseSource& source, const Explanation& explanation) {
  if (words.runs.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(words.runs, error);
  if (error) throw InputError("--runs", fmt::format("{} cannot be made: {}", words.runs, error.message()));
  const auto save = [&](const Scenario& run, const std::string& name, const ExpectedOutcome& expected) {
    Scenario scenario = played_by(source.agent, run);
    scenario.expected = expected;
    write_whole({file_in(words.runs, name), "--runs", OutputKind::Scenario}, printable_json(to_text(scenario)));
  };
  std::size_t number = 0;
  for (const Claim* claim : claims_of(explanation)) save(claim->run, name_of_claim(++number), claim->outcome);
  number = 0;
  for (const Share& share : explanation.shares) save(share.run, fmt::format("share-{}", ++number), {});
  number = 0;
  for (const Branching& branching : explanation.no_return.curve)
    save(branching.run, fmt::format("branch-{}", ++number), {});
}

void put_runs(const std::string& folder, const CaseSource& source) {
  if (folder.empty()) return put("\n[n]: the run that shows it; --runs DIR writes each as a scenario file\n");
  put("\n[n]:       fleetproof simulate {}{}, and so on\n", file_in(folder, name_of_claim(1)), source.plugin);
  put("[share n]: fleetproof simulate {}{} --draw N, N from 1 to {}\n", file_in(folder, "share-1"), source.plugin,
      kRunsPerShare);
  put("branches:  fleetproof simulate {}{} --radio-draw N, N from 1 to {}\n", file_in(folder, "branch-1"),
      source.plugin, kBranches);
}

void put_curve(const NoReturn& curve) {
  if (curve.curve.empty()) return;
  put("\nbranches that fail, of {} with a new radio from then on:\n", kBranches);
  for (std::size_t i = 0; i < curve.curve.size(); ++i) {
    const Branching& branching = curve.curve[i];
    put("  {:2}  {:10.2f} s  {:2}  {}\n", i + 1, to_seconds(branching.at - kStart), branching.failing(),
        std::string(40 * branching.failing() / kBranches, '#'));
  }
}

int explain_case(const ExplainWords& words) {
  const WorkTime time(words.max_time);
  if (!words.html.empty()) require_page_folder(words.html);
  AgentPrograms programs;
  const CaseSource source = read_case(words.from, programs);
  const CaseHost host(source.agent, programs, worker_count(words.jobs));
  Explanation explanation;
  ExaminedCase examined;
  {
    WorkProgress progress(
        "explain", [&] { return host.simulated(); }, time.allowed_s());
    progress.begin("simulating the run again");
    examined = failing_case(host, source, time);
    explanation = explained({words.trials, !words.html.empty()}, host.looking_at(examined.choice), source, time,
                            examined.failing, progress);
    explanation.shapes = shapes_of(explanation.small, source.agent, programs);
    if (!words.html.empty()) {
      progress.begin("writing the pages");
      const TimeLimit limit(time.end_before(0.0), is_interrupted);
      write_pages(words.html, source, programs, explanation, [&] { return limit.is_over(); });
    }
  }
  keep_for_page(words.from, source, explanation);
  save_runs(words, source, explanation);
  if (words.json) {
    Json json = to_json(explanation);
    json["other_failures"] = examined.others;
    put_text(shown_json(json));
  } else {
    put("{}: {}\n", source.name, text_of(explanation.pattern.kind));
    if (!examined.others.empty()) put("{}\n", examined.others);
    for (const std::string& sentence : sentences_of(explanation)) put("- {}\n", sentence);
    put_curve(explanation.no_return);
    put_runs(words.runs, source);
  }
  return is_interrupted() ? exit_code_of_signal(interrupted()) : kDemonstrated;
}

}  // namespace

Action prepare_explain(Options& options) {
  auto words = std::make_shared<ExplainWords>();
  words->from.verb = "explain";
  add_case_options(options, words->from);
  options.option("--runs", words->runs, "write the runs that show what is said to this folder, as scenario files");
  options.option("--html", words->html,
                 "write pages to this folder: of the run (index.html), of its smallest case, of the runs that show it");
  options.option(
      "--max-time", words->max_time,
      "end after this time with what was found (default: 120 s); the smallest case takes half of it at most");
  options.option("--max-trials", words->trials,
                 "look for the smallest case with so many trials; the same everywhere if --max-time suffices");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.flag("--json", words->json, "print JSON");
  return [words] { return unless_given_up([&] { return explain_case(*words); }); };
}

}  // namespace fleetproof::cli
