#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <string_view>
#include <vector>

#include "core/geometry/rotation.hpp"
#include "core/outcome/law.hpp"
#include "laws/laws.hpp"
#include "tests/laws/teller.hpp"
#include "tests/support/at_seconds.hpp"

// Runs that consist of pieces only, built by hand, and how they are announced to a law.
namespace fleetproof::test {

// The timeline of one body: the body stands at its first place, then waits, drives and turns. Pieces point into the
// timeline. It may be moved, but never copied.
class Timeline {
 public:
  Timeline(EntityId entity, const Pose& start, const Footprint& footprint)
      : entity_(entity), footprint_(footprint), pose_(start) {}
  Timeline(Timeline&&) = default;
  Timeline& operator=(Timeline&&) = default;

  Timeline& wait_until(double t_s) {
    Piece piece = blank();
    piece.end = at_seconds(t_s);
    return add(piece);
  }

  Timeline& drive(const Curve& curve, const MotionLimits& limits = {}) {
    curves_.push_back(curve);
    Piece piece = blank();
    piece.manner = Manner::Drive;
    piece.curve = &curves_.back();
    piece.profile = MotionProfile(curve.length_m(), limits);
    piece.end = piece.begin + piece.profile.duration();
    return add(piece);
  }

  Timeline& drive(double length_m, const MotionLimits& limits = {}) {
    return drive(Curve::straight(pose_.position_m, pose_.position_m + length_m * pose_.heading), limits);
  }

  Timeline& turn(double angle_rad, const MotionLimits& limits = {1.0, 1.0, 1.0}) {
    Piece piece = blank();
    piece.manner = Manner::Turn;
    piece.turn_rad = angle_rad;
    piece.profile = MotionProfile(std::abs(angle_rad), limits);
    piece.end = piece.begin + piece.profile.duration();
    return add(piece);
  }

  // Ends the last piece early, as a breakdown does.
  Timeline& cut_short_at(double t_s) {
    Piece& last = pieces_.back();
    last.end = now_ = at_seconds(t_s);
    pose_ = last.pose_at(now_);
    return *this;
  }

  SimTime now() const { return now_; }
  const Pose& pose() const { return pose_; }

  // The pieces up to `end`, which cuts what goes beyond it and is reached by standing still.
  std::vector<Piece> until(SimTime end) const {
    std::vector<Piece> pieces;
    for (const Piece& piece : pieces_) {
      if (piece.begin < end) pieces.push_back(piece);
    }
    if (now_ < end || pieces.empty()) pieces.push_back(blank());
    pieces.back().end = end;
    return pieces;
  }

 private:
  Piece blank() const { return rest_piece(entity_, footprint_, pose_, now_); }

  Timeline& add(const Piece& piece) {
    pieces_.push_back(piece);
    now_ = piece.end;
    pose_ = piece.pose_at(now_);
    return *this;
  }

  EntityId entity_;
  Footprint footprint_;
  Pose pose_;
  SimTime now_ = kStart;
  std::deque<Curve> curves_;
  std::vector<Piece> pieces_;
};

// A run: a scenario as far as a law reads it, and what its bodies do. AGVs come first, obstacles last.
struct Scene {
  Scenario scenario;
  SimTime end;
  std::deque<Timeline> bodies;

  explicit Scene(double end_s) : end(at_seconds(end_s)) { scenario.map = std::make_shared<const LogicalMap>(Layout{}); }

  Timeline& agv(const Pose& start, const Footprint& footprint = {}) {
    scenario.agvs.emplace_back();
    return bodies.emplace_back(EntityId{bodies.size()}, start, footprint);
  }

  Timeline& obstacle(const Pose& pose, const Footprint& footprint = {}) {
    scenario.obstacles.push_back({"obstacle", footprint, pose});
    return bodies.emplace_back(EntityId{bodies.size()}, pose, footprint);
  }
};

inline Pose facing(double x_m, double y_m, double heading_x, double heading_y) {
  return {Vec2(x_m, y_m), Vec2(heading_x, heading_y)};
}

// The order in which pieces that end at the same instant are announced to a law.
enum class Order { ByEntity, Backwards, AllEndsFirst };

// Announces the pieces of a scene to a law as a world does.
class Announcer {
 public:
  Announcer(const Scene& scene, Law& law) : law_(law), teller_(law, scene.bodies.size()), end_(scene.end) {
    for (const Timeline& body : scene.bodies) pieces_.push_back(body.until(scene.end));
    current_.resize(pieces_.size());
    announced_.resize(pieces_.size());
  }

  void announce(Order order) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) start(i);
    while (true) {
      SimTime now = end_;
      for (std::size_t i = 0; i < pieces_.size(); ++i) now = std::min(now, piece(i).end);
      if (now == end_) break;
      at_instant(now, order);
    }
    for (std::size_t i : in_order(end_, order)) finish(i);
    law_.finish(end_);
  }

 private:
  const Piece& piece(std::size_t body) const { return pieces_[body][current_[body]]; }
  bool is_last(std::size_t body) const { return current_[body] + 1 == pieces_[body].size(); }

  void start(std::size_t body) {
    Piece& planned = announced_[body];  // it stays there, as the world's does
    planned = piece(body);
    planned.number = number_++;
    planned.end = planned.manner == Manner::Rest ? kForever : planned.begin + planned.profile.duration();
    planned.planned_box = planned.swept_box(planned.end);
    teller_.begins(planned);
  }
  void stop(std::size_t body) {
    announced_[body].end = piece(body).end;
    teller_.ends(announced_[body]);
  }

  // A body may have several pieces that end at `now`, those of no length.
  std::vector<std::size_t> in_order(SimTime now, Order order) const {
    std::vector<std::size_t> ending;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (piece(i).end == now) ending.push_back(i);
    }
    if (order == Order::Backwards) std::ranges::reverse(ending);
    return ending;
  }

  void at_instant(SimTime now, Order order) {
    for (auto ending = in_order(now, order); !ending.empty(); ending = in_order(now, order)) {
      if (order == Order::AllEndsFirst) {
        for (const std::size_t i : ending) stop(i);
      }
      for (const std::size_t i : ending) {
        if (order != Order::AllEndsFirst) stop(i);
        ++current_[i];
        start(i);
      }
    }
  }

  // Pieces of no length may stand at the very end.
  void finish(std::size_t body) {
    for (stop(body); !is_last(body); stop(body)) {
      ++current_[body];
      start(body);
    }
  }

  Law& law_;
  Teller teller_;
  SimTime end_;
  std::vector<std::vector<Piece>> pieces_;
  std::vector<std::size_t> current_;
  std::vector<Piece> announced_;  // by body
  std::uint64_t number_ = 0;
};

// What a fresh law finds in the scene.
inline LawResults play(const Scene& scene, MakeLaw make, Order order = Order::ByEntity) {
  const auto law = make(scene.scenario);
  Announcer(scene, *law).announce(order);
  return law->findings();
}

inline LawResults play(const Scene& scene, std::string_view law, Order order = Order::ByEntity) {
  return play(scene, find_law(law)->make, order);
}

}  // namespace fleetproof::test
