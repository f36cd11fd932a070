#include "campaign/cli/film_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/run_text.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/run/replay.hpp"
#include "campaign/run/run_one.hpp"
#include "campaign/run/still_camera.hpp"
#include "campaign/workers/run_host.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof::cli {
namespace {

// What a strip is about: an instant, and the bodies that went wrong there.
struct Subject {
  SimTime at;
  EntityId a, b;
  bool is_quick = true;  // over in seconds; else it took minutes
};

Subject subject_of(const FailingRun& run, const RunRecord& stored) {
  if (run.worst) return {run.worst->closest_at, run.worst->a, run.worst->b, true};
  if (run.incident) return {run.incident->last, run.incident->a, run.incident->b, false};
  return {at_ns(static_cast<std::int64_t>(stored.outcome.simulated_ns)), {}, {}, false};
}

// Six instants around `subject.at`, fewer if the run is too short. What is over in seconds is shown in steps of
// seconds, a jam in steps ten times as long.
std::vector<Still> blank_stills(const Subject& subject, SimTime end) {
  std::set<SimTime> instants;
  const double pace = subject.is_quick ? 1.0 : 10.0;
  const double before_s = std::min(3.0 * pace, to_seconds(subject.at));
  for (const double part : {1.0, 2.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0, 0.0})
    instants.insert(std::max(kStart, subject.at - seconds(part * before_s)));
  // At the end of a run nothing comes after: one instant more before it.
  instants.insert(subject.at < end ? std::min(end, subject.at + seconds(pace)) : subject.at - seconds(0.5 * before_s));
  std::vector<Still> stills;
  for (const SimTime at : instants) stills.push_back({at, {}});
  return stills;
}

constexpr int kPointsOfACurve = 10;

void add_map(html::FilmStrip& strip, const LogicalMap& map) {
  for (const Lane& lane : map.lanes()) {
    // A segment that is driven both ways has two lanes on one line.
    if (map.segment(lane.segment).bidirectional && lane.from != map.segment(lane.segment).from) continue;
    std::vector<html::FloorPoint> points;
    const int steps = lane.curve.is_straight() ? 1 : kPointsOfACurve;
    for (int i = 0; i <= steps; ++i) {
      const Vec2 p = lane.curve.pose_at(lane.curve.length_m() * i / steps).position_m;
      points.push_back({p.x(), p.y()});
    }
    strip.lanes.push_back(std::move(points));
  }
  for (const Station& station : map.layout().stations)
    strip.stations.push_back({station.position_m.x(), station.position_m.y()});
}

// Of a load, shorter than on other pages: a frame is small.
std::string short_name(const Scenario& scenario, EntityId id) {
  return printable(body_name(scenario, id, "load of "), 20);
}

// A load that has not fallen yet, an obstacle that has not come yet, or an AGV that was taken off.
std::string absence_text(const Scenario& scenario, EntityId id) {
  std::string what = "load";
  if (id.index() < scenario.agvs.size() + scenario.obstacles.size()) what = "obstacle";
  if (id.index() < scenario.agvs.size()) what = short_name(scenario, id);
  return what + " not on the floor";
}

html::FilmFrame frame_of(const Still& still, const Subject& subject, const Scenario& scenario) {
  html::FilmFrame frame;
  frame.time_s = to_seconds(still.at);
  frame.is_worst = still.at == subject.at;
  const StillBody *first = nullptr, *second = nullptr;
  for (const StillBody& body : still.bodies) {
    if (body.entity == subject.a) first = &body;
    if (body.entity == subject.b) second = &body;
    const OrientedRectangle& place = body.place;
    html::FilmBody shown;
    shown.name = short_name(scenario, body.entity);
    shown.centre = {place.centre_m.x(), place.centre_m.y()};
    shown.heading = {place.heading.x(), place.heading.y()};
    shown.length_m = 2.0 * place.half_length_m;
    shown.width_m = 2.0 * place.half_width_m;
    shown.is_agv = body.entity.index() < scenario.agvs.size();
    shown.is_involved = body.entity == subject.a || body.entity == subject.b;
    frame.bodies.push_back(std::move(shown));
  }
  if (first != nullptr && second != nullptr)
    frame.clearance_m = std::max(0.0, clearance_m(first->place, second->place));
  else if (subject.a.valid() && subject.b.valid())
    frame.without_clearance = absence_text(scenario, first == nullptr ? subject.a : subject.b);
  return frame;
}

// Makes the strips of one archive.
class FilmMaker {
 public:
  FilmMaker(const ArchiveReader& archive, const std::string& archive_path)
      : archive_(archive), path_(archive_path), plan_(parse_plan(archive.campaign().plan_json)), source_(plan_) {}

  html::FilmStrip strip(const FailingRun& run) {
    const auto stored = archive_.run(run.run_index);
    ensure(stored.has_value(), "a failing run is in its archive");
    const Subject subject = subject_of(run, *stored);
    auto stills = blank_stills(subject, at_ns(static_cast<std::int64_t>(stored->outcome.simulated_ns)));
    const ReplayResult result = compare_runs(*stored, simulate_again(run.run_index, stills));
    html::FilmStrip strip;
    if (result.verdict != ReplayVerdict::Reproduced) {
      strip.note =
          "No film strip: simulated again for this page, the run came out differently (" + result.explanation + ").";
      return strip;
    }
    if (stills.front().bodies.empty()) {
      strip.note =
          "No film strip: control software in a shared object is drawn from the recording of its calls. Only runs that "
          "broke a distance, crashed or hung are recorded; this run did none of these (it stalled, for instance). The "
          "command above simulates it again.";
      return strip;
    }
    const Scenario scenario = source_.scenario(run.run_index);
    for (const Still& still : stills) strip.frames.push_back(frame_of(still, subject, scenario));
    add_map(strip, *scenario.map);
    if (!subject.is_quick) strip.least_side_m = 20.0;  // a jam has neighbours
    strip.safety_distance_m = scenario.law.safety_distance_m;
    return strip;
  }

 private:
  RunRecord simulate_again(std::uint64_t run_index, std::vector<Still>& stills) {
    const AgentFactor& agent = plan_.agent_of_cell(run_index);
    const auto& plugins = archive_.campaign().plugin_agents;
    auto camera = std::make_unique<StillCamera>(stills);
    if (const auto recording = archive_.recording(run_index)) return play(run_index, *recording, std::move(camera));
    if (std::ranges::find(plugins, agent.name) == plugins.end())
      return RunOne(plan_, reference_)(run_index, nullptr, {}, std::move(camera));
    RunRecord again = in_worker(run_index, agent);
    // Another outcome gets no frames, and needs no recording.
    if (again.recording.empty()) return again;
    return play(run_index, again.recording, std::move(camera));
  }

  RunRecord play(std::uint64_t run_index, const std::string& recording, std::unique_ptr<StillCamera> camera) {
    RunWatch watch;
    watch.play = recording;
    return RunOne(plan_, reference_)(run_index, nullptr, watch, std::move(camera));
  }

  RunRecord in_worker(std::uint64_t run_index, const AgentFactor& agent) {
    AgentPrograms programs;
    meet_plugins(path_, archive_.campaign(), {&agent, 1}, {}, programs, &AgentPrograms::know);
    RunHost host(plan_, programs, Hosting{});
    host.record(run_index % plan_.agents.size(), true);  // agents vary fastest
    auto record = host(run_index);
    ensure(record.has_value(), "a strip is not abandoned");
    return *std::move(record);
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
  const auto groups = failures.list(archive.gates());
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
