#pragma once

#include <deque>
#include <vector>

#include "core/law.hpp"

namespace fleetproof::test {

// The timeline of one body, built by hand: it stands where it is told to and then waits, drives and turns.
class Timeline {
 public:
  Timeline(EntityId entity, const Pose& start, const Footprint& footprint = {});

  Timeline& wait_until(double t_s);
  Timeline& drive(const Curve& curve, const MotionLimits& limits = {});
  Timeline& drive_straight(double length_m) ;
  Timeline& turn(double angle_rad);
  // Ends the last piece early, as a breakdown does.
  Timeline& cut_short_at(double t_s);

  SimTime now() const { return now_; }
  const Pose& pose() const { return pose_; }
  // Pieces up to `end`, which cuts the last one, or is filled with rest. `planned` keeps the ends as they were announced.
  std::vector<Piece> until(SimTime end) const;

 private:
  void add(Piece piece, SimTime end);

  EntityId entity_;
  Footprint footprint_;
  Pose pose_;
  SimTime now_ = kStart;
  std::deque<Curve> curves_;  // a deque: pieces point into it
  std::vector<Piece> pieces_;
};

// In which order a law hears of pieces that end at the same instant.
enum class Order { ByEntity, Backwards, AllEndsFirst };

// A run of nothing but pieces.
struct Scene {
  Scenario scenario;
  SimTime end = kStart;
  std::deque<Timeline> bodies;

  Scene(std::size_t agvs, double end_s, std::size_t obstacles = 0);
  Timeline& add(const Pose& start, const Footprint& footprint = {});
};

// Announces the scene to a fresh law as a world does, and returns what it finds.
LawFindings play(const Scene& scene, MakeLaw make, Order order = Order::ByEntity);
LawFindings play(const Scene& scene, std::string_view law, Order order = Order::ByEntity);

inline Pose facing(double x_m, double y_m, double heading_x, double heading_y) { return {Vec2(x_m, y_m), Vec2(heading_x, heading_y)}; }

}  // namespace fleetproof::test
