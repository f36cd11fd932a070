#include "campaign/watch/pieces_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "campaign/watch/run_text.hpp"
#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "reports/formats/csv_tables.hpp"

namespace fleetproof {
namespace {

Json json_of(const Vec2& v) { return Json::array({v.x(), v.y()}); }

// From the start of the piece: each phase begins at begin_s with this way and speed.
Json motion_json(const MotionProfile& profile) {
  Json phases = Json::array();
  double begin_s = 0.0;
  for (std::size_t phase = 0; phase < 3; ++phase) {
    const double end_s = profile.phase_ends_s()[phase];
    if (end_s > begin_s)
      phases.push_back({{"begin_s", begin_s},
                        {"end_s", end_s},
                        {"way", profile.position(begin_s)},
                        {"speed", profile.speed_in_phase(phase, begin_s)},
                        {"acceleration", profile.acceleration_in_phase(phase)}});
    begin_s = end_s;
  }
  return phases;
}

// The points of the track as the layout has them, in the direction of travel: two of a straight segment, else those of
// cubic Bezier curves that share their ends.
Json track_json(const Scenario& scenario, const Piece& drive) {
  const Segment& segment = scenario.map->segment(drive.segment);
  std::vector<Vec2> points{scenario.map->station(segment.from).position_m};
  points.insert(points.end(), segment.control_points_m.begin(), segment.control_points_m.end());
  points.push_back(scenario.map->station(segment.to).position_m);
  const Vec2 begin_m = drive.curve->pose_at(0.0).position_m;
  if ((begin_m - points.back()).norm() < (begin_m - points.front()).norm()) std::ranges::reverse(points);
  Json track = Json::array();
  for (const Vec2& point : points) track.push_back(json_of(point));
  return track;
}

Json json_of(const Piece& piece, const Scenario& scenario) {
  Json json = {{"begin_ns", to_ns(piece.begin)},
               {"end_ns", to_ns(piece.end)},
               {"length_m", piece.footprint.length_m},
               {"width_m", piece.footprint.width_m},
               {"centre_ahead_m", piece.footprint.centre_ahead_m}};
  switch (piece.manner) {
    case Manner::Rest:
      json["manner"] = "rest";
      break;
    case Manner::Turn:
      json["manner"] = "turn";
      json["to_the_left"] = piece.turn_rad > 0.0;
      break;
    case Manner::Drive:
      json["manner"] = "drive";
      json["segment"] = scenario.map->segment(piece.segment).name;
      json["tail_first"] = piece.curve->is_tail_first();
      json["track_m"] = track_json(scenario, piece);
      json["way_begin_m"] = piece.way_begin_m;
      break;
  }
  const Pose start = piece.pose_at(piece.begin);
  json["position_m"] = json_of(start.position_m);
  json["heading"] = json_of(start.heading);
  if (piece.manner != Manner::Rest) json["motion"] = motion_json(piece.profile);
  return json;
}

std::map<EntityId, std::vector<const Piece*>> by_body(const std::vector<Piece>& pieces) {
  std::map<EntityId, std::vector<const Piece*>> bodies;
  for (const Piece& piece : pieces) bodies[piece.entity].push_back(&piece);
  return bodies;
}

}  // namespace

std::string pieces_json(const Scenario& scenario, const std::vector<Piece>& pieces) {
  Json bodies = Json::array();
  for (const auto& [body, of_body] : by_body(pieces)) {
    Json list = Json::array();
    for (const Piece* piece : of_body) list.push_back(json_of(*piece, scenario));
    bodies.push_back({{"body", body_name(scenario, body)}, {"pieces", std::move(list)}});
  }
  const Json json = {{"schema_version", 1},
                     {"scenario", scenario.name},
                     {"safety_distance_m", scenario.law.safety_distance_m},
                     {"bodies", std::move(bodies)}};
  return printable_json(json_text(json, 1)) + "\n";
}

std::string poses_csv(const Scenario& scenario, const std::vector<Piece>& pieces, Duration step) {
  std::string text = "body,t_s,x_m,y_m,heading_x,heading_y,speed_mps\n";
  for (const auto& [body, of_body] : by_body(pieces)) {
    const std::string name = csv_field(body_name(scenario, body));
    SimTime t = kStart;
    for (const Piece* piece : of_body) {
      while (t < piece->begin) t += step;
      for (; t <= piece->end; t += step) {
        const Pose pose = piece->pose_at(t);
        text += fmt::format("{},{},{},{},{},{},{}\n", name, to_seconds(t), pose.position_m.x(), pose.position_m.y(),
                            pose.heading.x(), pose.heading.y(), piece->speed_at(t));
      }
    }
  }
  return text;
}

}  // namespace fleetproof
