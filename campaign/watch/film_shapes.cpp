#include "campaign/watch/film_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>

#include "campaign/watch/run_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

constexpr Duration kShapeStep = std::chrono::milliseconds(1);
constexpr Duration kAround = std::chrono::seconds(2);  // about a violation, if a size is varied
constexpr double kSamePlace_m = 1e-3;

// All that a body might have covered at an instant, had one thing been otherwise.
struct Shapes {
  std::vector<OrientedRectangle> bodies;
  double radius_m = 0.0;  // of discs about their centres instead, if it is not zero
};
using Otherwise = std::function<Shapes(SimTime)>;

double distance_m(const Shapes& shapes, const OrientedRectangle& other) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const OrientedRectangle& body : shapes.bodies) least_m = std::min(least_m, clearance_m(body, other));
  return least_m - shapes.radius_m;
}

// Cut, so that no more is promised than is kept.
std::string in_centimetres(double value_m) { return fmt::format("{:.2f} m", std::floor(value_m * 100.0) / 100.0); }

// One of two bodies that broke the safety distance, with what it did then.
class ShapeStory {
 public:
  ShapeStory(const Scenario& scenario, const PiecesOfBodies& bodies, const Violation& v, EntityId one, EntityId other,
             SimTime end)
      : scenario_(scenario), bodies_(bodies), v_(v), one_(one), other_(other), end_(end) {}

  std::vector<std::string> sentences() {
    piece_ = piece_at(bodies_, one_, v_.first);
    if (piece_ == nullptr || piece_at(bodies_, other_, v_.first) == nullptr) return {};
    if (piece_->manner == Manner::Turn) tell_turn();
    if (piece_->manner == Manner::Drive && !piece_->curve->is_straight()) tell_bend();
    if (is_agv(one_)) tell_load();
    if (is_agv(one_) && is_agv(other_)) tell_size();
    return std::move(told_);
  }

 private:
  bool is_agv(EntityId id) const { return id.index() < scenario_.agvs.size(); }
  std::string name(EntityId id) const { return printable(body_name(scenario_, id)); }
  const VehicleType& type(EntityId agv) const { return scenario_.vehicle_types[scenario_.agvs[agv.index()].type]; }

  // The least distance that is kept from the other body; none if it is below the safety distance.
  std::optional<double> kept_m(SimTime from, SimTime to, const Otherwise& otherwise) const {
    double least_m = std::numeric_limits<double>::infinity();
    for (SimTime t = from;; t = std::min(t + kShapeStep, to)) {
      const Piece* other = piece_at(bodies_, other_, t);
      if (other != nullptr && piece_at(bodies_, one_, t) != nullptr)
        least_m = std::min(least_m, distance_m(otherwise(t), other->body_at(t)));
      if (least_m < scenario_.law.safety_distance_m) return std::nullopt;
      if (t >= to) return least_m < std::numeric_limits<double>::infinity() ? std::optional(least_m) : std::nullopt;
    }
  }
  std::optional<double> kept_in_piece_m(const Otherwise& otherwise) const {
    return kept_m(piece_->begin, std::min(piece_->end, end_), otherwise);
  }

  void tell_turn() {
    const Piece& turn = *piece_;
    // As planned, also if the turn was cut short.
    const Pose after{turn.start.position_m, rotated(turn.start.heading, unit_vector(turn.turn_rad))};
    const OrientedRectangle stands = placed(turn.footprint, turn.start), will_stand = placed(turn.footprint, after);
    const auto kept = kept_in_piece_m([&](SimTime) { return Shapes{{stands, will_stand}}; });
    if (kept)
      told_.push_back(fmt::format(
          "As they moved, it took the sweep of the turn on the spot of {}: with the heading before the turn, and with "
          "that "
          "after it, {} keeps {} from {}. As it turns, its corners reach {} from its axis.",
          name(one_), name(one_), in_centimetres(*kept), name(other_), in_centimetres(turn.footprint.reach_m())));
    const double radius_m = turn.footprint.length_m / 2.0 + std::abs(turn.footprint.centre_ahead_m);
    const OrientedRectangle axis{turn.start.position_m, Vec2::UnitX(), 0.0, 0.0};
    const auto disc = kept_in_piece_m([&](SimTime) { return Shapes{{axis}, radius_m}; });
    if (disc)
      told_.push_back(
          fmt::format("As they moved, it took the corners of {} in its turn on the spot: a disc about its axis that "
                      "reaches to the ends of {}, "
                      "{}, keeps {} from {}. Its corners are {} from the axis.",
                      name(one_), name(one_), in_centimetres(radius_m), in_centimetres(*disc), name(other_),
                      in_centimetres(turn.footprint.reach_m())));
  }

  void tell_bend() {
    const Piece& drive = *piece_;
    const Curve& curve = *drive.curve;
    const Vec2 from = curve.pose_at(0.0).position_m, way = curve.pose_at(curve.length_m()).position_m - from;
    if (!(way.norm() > 0.0)) return;
    const Vec2 along = way.normalized(), heading = curve.is_tail_first() ? Vec2(-along) : along;
    const auto kept = kept_in_piece_m([&](SimTime t) {
      const Pose pose{from + drive.way_at(t) / curve.length_m() * way, heading};
      return Shapes{{placed(drive.footprint, pose)}};
    });
    if (!kept) return;
    double aside_m = 0.0;
    for (int i = 1; i < 100; ++i) {
      const Vec2 at = curve.pose_at(curve.length_m() * i / 100.0).position_m - from;
      aside_m = std::max(aside_m, std::abs(cross(along, at)));
    }
    told_.push_back(fmt::format(
        "As they moved, it took the bend of the lane of {}: on the straight line between the ends of that lane, {} "
        "keeps {} from {}. The lane goes up to {} aside of the line.",
        name(one_), name(one_), in_centimetres(*kept), name(other_), in_centimetres(aside_m)));
  }

  // The way that it drove, with another size.
  std::optional<double> kept_with_m(const Footprint& footprint) const {
    return kept_m(std::max(kStart, v_.first - kAround), std::min(end_, v_.last + kAround),
                  [&](SimTime t) { return Shapes{{placed(footprint, piece_at(bodies_, one_, t)->pose_at(t))}}; });
  }

  void tell_load() {
    const Footprint& bare = type(one_).footprint;
    if (piece_->footprint == bare) return;
    const auto kept = kept_with_m(bare);
    if (!kept) return;
    told_.push_back(fmt::format(
        "As they moved, it took the load of {}: without it, {} keeps {} from {}. The load makes it {:.2f} m longer and "
        "{:.2f} m wider.",
        name(one_), name(one_), in_centimetres(*kept), name(other_), piece_->footprint.length_m - bare.length_m,
        piece_->footprint.width_m - bare.width_m));
  }

  void tell_size() {
    const Footprint &mine = type(one_).footprint, &others = type(other_).footprint;
    if (!(mine.reach_m() > others.reach_m())) return;
    const bool loaded = piece_->footprint != mine;
    const auto kept = kept_with_m(type(other_).footprint_with(loaded));
    if (!kept) return;
    told_.push_back(fmt::format(
        "As they moved, it took the size of {}: with the size of {}, it would keep {} from it. {} is {}, {} is {}.",
        name(one_), name(other_), in_centimetres(*kept), name(one_), size_text(mine), name(other_), size_text(others)));
  }
  static std::string size_text(const Footprint& footprint) {
    std::string text = fmt::format("{:.2f} m by {:.2f} m", footprint.length_m, footprint.width_m);
    if (footprint.centre_ahead_m != 0.0)
      text += fmt::format(", its centre {:.2f} m ahead of its axis", footprint.centre_ahead_m);
    return text;
  }

  const Scenario& scenario_;
  const PiecesOfBodies& bodies_;
  const Violation& v_;
  EntityId one_, other_;
  SimTime end_;
  const Piece* piece_ = nullptr;
  std::vector<std::string> told_;
};

// Where an AGV is in the terms of the map: on a lane between two stations, or at one. In words, with the stations.
struct MapPlace {
  std::string text;
  std::set<StationId> stations;
};

std::optional<MapPlace> map_place(const Scenario& scenario, const PiecesOfBodies& bodies, EntityId agv, SimTime at) {
  const Piece* piece = piece_at(bodies, agv, at);
  if (piece == nullptr || agv.index() >= scenario.agvs.size()) return std::nullopt;
  const auto& stations = scenario.map->layout().stations;
  const Vec2 position = piece->pose_at(at).position_m;
  if (piece->manner != Manner::Drive) {
    for (std::size_t i = 0; i < stations.size(); ++i) {
      if ((stations[i].position_m - position).norm() < kSamePlace_m)
        return MapPlace{"at " + printable(stations[i].name), {StationId{i}}};
    }
  }
  const Piece* drive = nullptr;  // it rests on the lane of its last drive
  for (const Piece* each : bodies.at(agv)) {
    if (each->begin <= at && each->manner == Manner::Drive) drive = each;
  }
  if (drive == nullptr) return std::nullopt;
  const Segment& lane = scenario.map->segment(drive->segment);
  return MapPlace{fmt::format("on the lane between {} and {}", printable(stations[lane.from.index()].name),
                              printable(stations[lane.to.index()].name)),
                  {lane.from, lane.to}};
}

void tell_places(const Scenario& scenario, const PiecesOfBodies& bodies, const Violation& v,
                 std::vector<std::string>& told) {
  const auto one = map_place(scenario, bodies, v.a, v.first), other = map_place(scenario, bodies, v.b, v.first);
  if (!one || !other) return;
  const auto is_shared = [&](StationId id) { return other->stations.contains(id); };
  if (std::ranges::any_of(one->stations, is_shared)) return;
  told.push_back(fmt::format(
      "{} was {}, {} {}: these share no station and no segment. Only their shapes on the floor come too close.",
      printable(body_name(scenario, v.a)), one->text, printable(body_name(scenario, v.b)), other->text));
}

}  // namespace

std::vector<std::string> shape_sentences(const Scenario& scenario, const PiecesOfBodies& bodies, const Violation& v,
                                         SimTime end) {
  std::vector<std::string> told = ShapeStory(scenario, bodies, v, v.a, v.b, end).sentences();
  for (std::string& sentence : ShapeStory(scenario, bodies, v, v.b, v.a, end).sentences())
    told.push_back(std::move(sentence));
  tell_places(scenario, bodies, v, told);
  if (2.0 * static_cast<double>(v.min_clearance_um) > scenario.law.safety_distance_m * 1e6)
    told.push_back(fmt::format("They keep more than half of the safety distance: {:.3f} m of {:.2f} m.",
                               static_cast<double>(v.min_clearance_um / 1000) / 1e3, scenario.law.safety_distance_m));
  return told;
}

}  // namespace fleetproof
