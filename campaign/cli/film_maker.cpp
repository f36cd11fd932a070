#include "campaign/cli/film_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/recorded_elsewhere.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/run/replay.hpp"
#include "campaign/run/run_one.hpp"
#include "campaign/watch/film_frames.hpp"
#include "campaign/workers/run_host.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {
namespace {

StripSubject subject_of(const FailingRun& run, const RunRecord& stored) {
  if (run.worst) return {run.worst->closest_at, run.worst->a, run.worst->b};
  if (run.incident) return {run.incident->last, run.incident->a, run.incident->b, false};
  return {at_ns(static_cast<std::int64_t>(stored.outcome.simulated_ns)), {}, {}, false};
}

// Makes the strips of one archive.
class FilmMaker {
 public:
  FilmMaker(const ArchiveReader& archive, const std::string& archive_path)
      : archive_(archive), path_(archive_path), plan_(parse_plan(archive.campaign().plan_json)), source_(plan_) {}

  html::FilmStrip strip(const FailingRun& run) {
    const auto stored = archive_.run(run.run_index);
    ensure(stored.has_value(), "a failing run is in its archive");
    StripSubject subject = subject_of(run, *stored);
    subject.stops_there = run.worst && run.worst->contact && plan_.contact_stops;
    auto stills = blank_stills(subject, at_ns(static_cast<std::int64_t>(stored->outcome.simulated_ns)));
    const ReplayResult result = compare_runs(*stored, simulate_again(run.run_index, stills));
    html::FilmStrip strip;
    if (result.verdict != ReplayVerdict::Reproduced) {
      strip.note =
          "No film strip: simulated again for this page, the run came out differently (" + result.explanation + ").";
      return strip;
    }
    return strip_of(stills, subject, source_.scenario(run.run_index));
  }

 private:
  RunRecord simulate_again(std::uint64_t run_index, std::vector<Still>& stills) {
    const AgentFactor& agent = plan_.agent_of_cell(run_index);
    const auto& plugins = archive_.campaign().plugin_agents;
    auto camera = std::make_unique<StillCamera>(stills);
    if (const auto recording = archive_.recording(run_index)) return play(run_index, *recording, std::move(camera));
    if (std::ranges::find(plugins, agent.name) == plugins.end())
      return RunOne(plan_, reference_)(run_index, nullptr, {}, std::move(camera));
    return play(run_index, recorded_again(run_index, agent), std::move(camera));
  }

  RunRecord play(std::uint64_t run_index, const std::string& recording, std::unique_ptr<StillCamera> camera) {
    RunWatch watch;
    watch.play = recording;
    return RunOne(plan_, reference_)(run_index, nullptr, watch, std::move(camera));
  }

  // A campaign records failures that break a distance, crash or hang; one that stalled is recorded now.
  std::string recorded_again(std::uint64_t run_index, const AgentFactor& agent) {
    AgentPrograms programs;
    meet_plugins(path_, archive_.campaign(), {&agent, 1}, {}, programs, &AgentPrograms::know);
    return recorded_elsewhere(source_.scenario(run_index), case_agent(plan_, agent), programs);
  }

  const ArchiveReader& archive_;
  std::string path_;
  CampaignPlan plan_;
  ScenarioSource source_;
  AgentPrograms reference_;
};

html::FilmStrip without_frames(const std::string& why) {
  html::FilmStrip strip;
  strip.note = "No film strip: " + why;
  return strip;
}

}  // namespace

std::map<std::uint64_t, html::FilmStrip> film_strips(const ArchiveReader& archive, const std::string& archive_path,
                                                     const FailureGroups& failures) {
  std::map<std::uint64_t, html::FilmStrip> strips;
  const auto groups = failures.list(archive.plan());
  if (groups.empty()) return strips;
  std::unique_ptr<FilmMaker> maker;
  std::string no_plan;
  try {
    maker = std::make_unique<FilmMaker>(archive, archive_path);
  } catch (const InputError& unreadable) {
    no_plan = unreadable.what();
  } catch (const EngineError& unreadable) {
    no_plan = unreadable.what();
  }
  for (const auto& group : groups) {
    html::FilmStrip& strip = strips[group.worst.run_index];
    if (strips.size() > kMostStrips) {
      strip = without_frames(fmt::format("this page shows only the first {} groups as strips.", kMostStrips));
      continue;
    }
    try {
      strip = maker ? maker->strip(group.worst) : without_frames(no_plan);
    } catch (const InputError& error) {
      strip = without_frames(error.what());
    } catch (const EngineError& error) {
      strip = without_frames(error.what());
    }
  }
  return strips;
}

}  // namespace fleetproof::cli
