#include "campaign/watch/film_floor.hpp"

#include <algorithm>
#include <cmath>

#include "campaign/watch/run_text.hpp"
#include "campaign/watch/trace_context.hpp"

namespace fleetproof {
namespace {

// Between points of a track the page follows a cubic. Over so much turning, or so much change of the curvature, the
// cubic stays within a tenth of a millimetre of the curve.
constexpr double kMostTurn_rad = 0.2;
constexpr int kMostLaneSteps = 2000;

std::int64_t thousandth(std::int64_t ns) { return (ns >= 0 ? ns + 500 : ns - 500) / 1000; }

web::TrackPoint point_at(const Curve& curve, double way_m) {
  const Pose pose = curve.pose_at(way_m);
  return {film_um(pose.position_m.x()), film_um(pose.position_m.y()), film_urad(pose.heading), film_um(way_m)};
}

void add_points(web::Track& track, const Curve& curve) {
  track.points.push_back(point_at(curve, 0.0));
  double begin_m = 0.0;
  for (std::size_t part = 0; part < curve.parts().size(); ++part) {
    const double end_m = curve.ends_m()[part], length_m = end_m - begin_m;
    const MostBending& most = curve.parts()[part].most();
    const double turns = std::max(most.per_m * length_m, std::sqrt(most.per_m2) * length_m) / kMostTurn_rad;
    const int steps = std::clamp(static_cast<int>(std::ceil(turns)), 1, kMostLaneSteps);
    for (int i = 1; i <= steps; ++i) track.points.push_back(point_at(curve, begin_m + length_m * i / steps));
    begin_m = end_m;
  }
}

std::size_t outline_of(web::Film& film, const Footprint& footprint) {
  const web::Outline outline{film_um(footprint.length_m), film_um(footprint.width_m),
                             film_um(footprint.centre_ahead_m)};
  const auto known = std::ranges::find(film.outlines, outline);
  if (known != film.outlines.end()) return static_cast<std::size_t>(known - film.outlines.begin());
  film.outlines.push_back(outline);
  return film.outlines.size() - 1;
}

std::vector<web::Phase> phases_of(const MotionProfile& profile) {
  std::vector<web::Phase> phases;
  double begin_s = 0.0;
  for (std::size_t phase = 0; phase < 3; ++phase) {
    const double end_s = profile.phase_ends_s()[phase];
    if (end_s > begin_s)
      phases.push_back({film_us(seconds(begin_s)), film_um(profile.position(begin_s)),
                        film_um(profile.speed_in_phase(phase, begin_s)),
                        film_um(profile.acceleration_in_phase(phase))});
    begin_s = end_s;
  }
  return phases;
}

web::MotionPiece motion_of(web::Film& film, const Scenario& scenario, const Piece& piece) {
  web::MotionPiece motion;
  motion.body = piece.entity.index();
  motion.outline = outline_of(film, piece.footprint);
  motion.begin_us = film_us(piece.begin);
  motion.end_us = film_us(piece.end);
  const Pose start = piece.pose_at(piece.begin);
  motion.x_um = film_um(start.position_m.x());
  motion.y_um = film_um(start.position_m.y());
  motion.heading_urad = film_urad(start.heading);
  if (piece.manner == Manner::Rest) return motion;
  motion.phases = phases_of(piece.profile);
  motion.planned_way = film_um(piece.manner == Manner::Turn ? piece.turn_rad : piece.profile.distance());
  motion.moving = piece.manner == Manner::Turn ? web::Moving::Turns : web::Moving::Drives;
  if (piece.manner == Manner::Turn) return motion;
  motion.track = piece.segment.index();
  motion.against_track = lane_of(*scenario.map, piece).from != scenario.map->segment(piece.segment).from;
  motion.tail_first = piece.curve->is_tail_first();
  motion.way_begin_um = film_um(piece.way_begin_m);
  return motion;
}

web::BodyKind kind_of(const Scenario& scenario, EntityId id) {
  if (scenario.is_agv(id)) return web::BodyKind::Agv;
  if (scenario.is_computer(id)) return web::BodyKind::Computer;
  return id < scenario.first_fallen_load() ? web::BodyKind::Obstacle : web::BodyKind::Load;
}

}  // namespace

std::int64_t film_us(SimTime t) { return thousandth(to_ns(t)); }
std::int64_t film_us(Duration d) { return thousandth(d.count()); }
std::int64_t film_um(double value_m) { return std::llround(value_m * 1e6); }
std::int64_t film_urad(const Vec2& heading) { return std::llround(std::atan2(heading.y(), heading.x()) * 1e6); }

void add_floor(web::Film& film, const Scenario& scenario) {
  const Layout& layout = scenario.map->layout();
  film.safety_distance_um = film_um(scenario.law.safety_distance_m);
  film.floor_low_x_um = film_um(layout.floor_low_m.x());
  film.floor_low_y_um = film_um(layout.floor_low_m.y());
  film.floor_high_x_um = film_um(layout.floor_high_m.x());
  film.floor_high_y_um = film_um(layout.floor_high_m.y());
  for (const Segment& segment : layout.segments) {
    web::Track track;
    track.name = segment.name;
    add_points(track, segment_curve(layout, segment));
    film.tracks.push_back(std::move(track));
  }
  for (const Station& station : layout.stations)
    film.stations.push_back({station.name, film_um(station.position_m.x()), film_um(station.position_m.y())});
  for (std::size_t i = 0; i < scenario.entity_count(); ++i) {
    web::Body& body = film.bodies.emplace_back(body_name(scenario, EntityId{i}), kind_of(scenario, EntityId{i}));
    if (!scenario.is_computer(EntityId{i})) continue;
    if (const auto& at_m = scenario.computer(EntityId{i}).at_m)
      body.antenna = web::FloorPlace{film_um(at_m->x()), film_um(at_m->y())};
  }
}

void add_motion(web::Film& film, const Scenario& scenario, std::span<const Piece> pieces) {
  for (const Piece& piece : pieces) {
    // A page counts in microseconds: there a shorter piece takes no time, and the next one begins at its pose.
    if (film_us(piece.begin) < film_us(piece.end)) film.pieces.push_back(motion_of(film, scenario, piece));
  }
}

}  // namespace fleetproof
