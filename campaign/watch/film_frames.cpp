#include "campaign/watch/film_frames.hpp"

#include <algorithm>
#include <set>

#include "campaign/watch/run_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/shown_time.hpp"

namespace fleetproof {
namespace {

constexpr int kPointsOfACurve = 10;
constexpr double kLeastAfter = 0.2;  // of a step: less than that looks the same

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
  if (id < scenario.first_fallen_load()) what = "obstacle";
  if (scenario.is_agv(id)) what = short_name(scenario, id);
  return what + " not on the floor";
}

html::FilmFrame frame_of(const Still& still, const StripSubject& subject, const Scenario& scenario) {
  html::FilmFrame frame;
  frame.time_s = shown_seconds(still.at);
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

}  // namespace

std::vector<Still> blank_stills(const StripSubject& subject, SimTime end) {
  std::set<SimTime> instants;
  const double pace = subject.is_quick ? 1.0 : 10.0;
  const double before_s = std::min(3.0 * pace, to_seconds(subject.at));
  // A jam right from the start has no approach: it is shown as it lasts.
  if (!subject.is_quick && before_s < pace) {
    instants = {kStart, subject.at};
    for (const double after_s : {10.0, 30.0, 60.0, 120.0})
      instants.insert(std::min(end, subject.at + seconds(after_s)));
  } else {
    for (const double part : {1.0, 2.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0, 0.0})
      instants.insert(std::max(kStart, subject.at - seconds(part * before_s)));
    // If nothing comes after, or next to nothing before the run ends: one instant more before it.
    const bool goes_on = !subject.stops_there && end - subject.at > seconds(kLeastAfter * pace);
    instants.insert(goes_on ? std::min(end, subject.at + seconds(pace)) : subject.at - seconds(0.5 * before_s));
  }
  std::vector<Still> stills;
  for (const SimTime at : instants) stills.push_back({at, {}});
  return stills;
}

html::FilmStrip strip_of(const std::vector<Still>& stills, const StripSubject& subject, const Scenario& scenario) {
  html::FilmStrip strip;
  for (const Still& still : stills) strip.frames.push_back(frame_of(still, subject, scenario));
  add_map(strip, *scenario.map);
  if (!subject.is_quick) strip.least_side_m = 20.0;  // a jam has neighbours
  strip.safety_distance_m = scenario.law.safety_distance_m;
  return strip;
}

}  // namespace fleetproof
