#include "campaign/cli/explained_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "campaign/cli/output_file.hpp"
#include "campaign/cli/recorded_elsewhere.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/explain/sentences.hpp"
#include "campaign/watch/film_floor.hpp"
#include "campaign/watch/film_shapes.hpp"
#include "campaign/watch/replay_file.hpp"
#include "core/base/error.hpp"
#include "core/engine/simulation.hpp"
#include "laws/laws.hpp"
#include "reports/page/side_record.hpp"
#include "reports/page/wording.hpp"
#include "reports/replay_page/replay_page.hpp"
#include "storage/beside.hpp"

namespace fleetproof::cli {
namespace {

constexpr const char *kRunPage = "index.html", *kSmallPage = "smallest.html";

Outcome watch_case(const Scenario& scenario, const CaseAgent& agent, const AgentPrograms& programs,
                   FilmRecorder& recorder) {
  const std::string recording = recorded_elsewhere(scenario, agent, programs);
  RunWatch watch;
  watch.play = recording;
  const FleetSoftware software = recording.empty() ? programs.software(factor_of(agent), agent.config, scenario)
                                                   : programs.software_to_play(scenario);
  return simulate(scenario, software, make_default_laws(scenario, agent.laws_left_out), &recorder, watch);
}

// The pages of one explanation, in one folder.
class Pages {
 public:
  Pages(const std::string& folder, const CaseSource& source, const AgentPrograms& programs, const Explanation& found)
      : folder_(folder), source_(source), programs_(programs), found_(found) {
    part_.run = explained_run(found, {});
    part_.command = fmt::format("fleetproof explain {}{}", source.command, source.plugin);
    part_.run_page = kRunPage;
    part_.small_page = kSmallPage;
  }

  void write(const std::function<bool()>& is_over) {
    const web::Film failing = film(found_.small.scenario, {}, {});
    const std::vector<const Claim*> claims = claims_of(found_);
    for (const Claim* claim : claims) {
      if (is_over()) break;
      web::ExplainedPart beside;
      beside.failing = &failing;
      beside.small_page = kSmallPage;
      const std::string remark = fmt::format("The smallest case with one thing changed: {}.", claim->sentence);
      put(web::page_of_run(part_.run_pages + 1), film(claim->run, remark, {}), beside);
      ++part_.run_pages;
    }
    part_.shows = web::ExplainedPart::Shows::Smallest;
    put(kSmallPage, failing, part_);
    part_.shows = web::ExplainedPart::Shows::Run;
    put(kRunPage, film(found_.original.scenario, {}, source_.name), part_);
    remove_old_ones();
    if (part_.run_pages < claims.size())
      talk("the time is over: {} of {} have a page\n", part_.run_pages, count_text(claims.size(), "run"));
  }

 private:
  // Of an explanation before, with more runs.
  void remove_old_ones() const {
    for (std::size_t number = part_.run_pages + 1;; ++number) {
      const auto old = std::filesystem::path(folder_) / web::page_of_run(number);
      if (!std::filesystem::exists(old)) return;
      require_writable({old.string(), "--html", OutputKind::ReplayPage});
      std::filesystem::remove(old);
    }
  }
  web::Film film(const Scenario& scenario, const std::string& remark, const std::string& name) const {
    FilmRecorder recorder(scenario);
    const Outcome outcome = watch_case(scenario, source_.agent, programs_, recorder);
    ReplayWords words{part_.command, {{"agent", source_.agent.program}}, {}};
    if (!name.empty()) words.facts.insert(words.facts.begin(), {"run", name});
    return film_of(recorder, scenario, outcome, words, remark);
  }
  void put(const std::string& name, const web::Film& film, const web::ExplainedPart& part) const {
    write_whole({(std::filesystem::path(folder_) / name).string(), "--html", OutputKind::ReplayPage},
                web::replay_page(film, part));
  }

  const std::string& folder_;
  const CaseSource& source_;
  const AgentPrograms& programs_;
  const Explanation& found_;
  web::ExplainedPart part_;
};

}  // namespace

std::string explained_name(const CampaignRecord& campaign, std::uint64_t run, const Outcome& outcome,
                           const std::string& failure) {
  return fmt::format("{} {} {} {}", hex_text(campaign.plan_hash), run, hex_text(outcome.digest), failure);
}

web::ExplainedRun explained_run(const Explanation& explanation, const std::string& of) {
  web::ExplainedRun run;
  run.of = of;
  run.failure = text_of(explanation.pattern.kind);
  const std::vector<Sentence> sentences = told(explanation);
  if (const Sentence* lead = leading(sentences)) run.lead = lead->lead.empty() ? lead->text : lead->lead;
  for (const Sentence& sentence : sentences)
    run.lines.push_back({sentence.text, sentence.at ? std::optional(film_us(*sentence.at)) : std::nullopt,
                         sentence.is_of_run, sentence.claims});
  run.branches = kBranches;
  run.is_whole = explanation.is_smallest && explanation.not_tried.empty();
  for (const Branching& branching : explanation.no_return.curve)
    run.curve.push_back({film_us(branching.at), branching.failing()});
  return run;
}

std::string explained_path(const std::string& archive_path, std::uint64_t run, const std::string& failure) {
  return beside(archive_path, fmt::format(".run-{}{}{}.explained.json", run, failure.empty() ? "" : "-", failure));
}

void keep_explained(const std::string& path, const web::ExplainedRun& run) {
  try {
    write_whole({path, "explain", OutputKind::FoundExplanation}, web::explained_text(run));
  } catch (const InputError& error) {  // what was found is printed all the same
    const std::string_view why = error.what();
    talk("note: not kept beside the results file: {}\n", why.substr(0, why.find("; choose another path")));
  }
}

web::ExplainedRun kept_explained(const std::string& path, const std::string& of) {
  struct File {
    std::optional<web::ExplainedRun> record;
    std::string trouble;
  };
  auto file = side_record<File>(path, web::parse_explained, "explain the run again.");
  if (file.record && file.record->of != of)
    file = {{}, path + " is of another run, or of other software: explain the run again."};
  if (!file.trouble.empty()) talk("note: {}\n", file.trouble);
  return file.record.value_or(web::ExplainedRun{});
}

std::vector<std::string> shapes_of(const FailingCase& failing, const CaseAgent& agent, const AgentPrograms& programs) {
  if (!failing.failure.is_violation) return {};
  FilmRecorder recorder(failing.scenario);
  const Outcome outcome = watch_case(failing.scenario, agent, programs, recorder);
  if (outcome.violations.empty()) return {};
  return shape_sentences(failing.scenario, pieces_of_bodies(recorder.pieces()), outcome.violations.front(),
                         at_ns(static_cast<std::int64_t>(outcome.simulated_ns)));
}

void require_page_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError("--html", fmt::format("{} cannot be made: {}", folder, error.message()));
  for (const char* page : {kRunPage, kSmallPage})
    require_writable({(std::filesystem::path(folder) / page).string(), "--html", OutputKind::ReplayPage});
}

void write_pages(const std::string& folder, const CaseSource& source, const AgentPrograms& programs,
                 const Explanation& explanation, const std::function<bool()>& is_over) {
  Pages(folder, source, programs, explanation).write(is_over);
}

}  // namespace fleetproof::cli
