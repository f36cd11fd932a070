#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/clearance/clearance_over_time.hpp"
#include "core/engine/company.hpp"
#include "core/motion/activity.hpp"
#include "core/outcome/law.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// An AGV, an obstacle or a fallen load. Its current piece is its spatial relation to the floor, as a function of time.
struct Body {
  bool on_floor = false;  // else it has no piece
  Piece piece;
  bool is_agv = false;
};

struct Load {
  TransportId transport;
  // The AGV that has to carry out the transport. Of an open one: that which has taken the load up, until the load
  // leaves it elsewhere than at its destination; else invalid.
  AgvId carrier;
  Holder holder;
  StationId destination;
  bool is_open = false;       // the scenario gives the transport to no AGV
  bool was_taken_up = false;  // by an AGV, ever
  bool is_delivered() const { return holder == Holder{Holder::Kind::Station, destination.value}; }
  // The transport is over: the load is at its destination, or out of the warehouse.
  bool is_over() const { return is_delivered() || holder.is_gone(); }
};

struct TouchPrediction {
  SimTime at;
  EntityId a, b;
  std::uint64_t piece_a = 0, piece_b = 0;  // stale once either body has another piece
};

// The state of the warehouse (Sect. 3.2): the bodies and loads of one run, and what happens to them. Laws observe its
// pieces; they cannot change it.
class World {
 public:
  // `sink` may be null.
  World(const Scenario& scenario, std::span<const std::unique_ptr<Law>> laws, TraceSink* sink = nullptr);

  std::size_t entity_count() const { return bodies_.size(); }
  const Body& body(EntityId id) const { return bodies_[id.index()]; }
  Pose pose_of(EntityId id, SimTime t) const { return body(id).piece.pose_at(t); }

  // Ends the body's current piece at `next.begin` and begins the next one.
  void continue_with(EntityId id, const Piece& next);
  void put_on_floor(EntityId id, const Footprint& footprint, const Pose& pose, SimTime t);
  void take_off_floor(EntityId id, SimTime t);
  // Whether every body is farther than `margin_m` from a place at `t`, which is now.
  bool is_free(const OrientedRectangle& place, double margin_m, SimTime t) const;
  // The same, and every body that moves stays so with its whole present piece, boxed.
  bool stays_free(const OrientedRectangle& place, double margin_m, SimTime t) const;
  // First touch of each other body within both current pieces, appended to `out`; pairs that touched before are left
  // out.
  void predict_touches(EntityId id, std::vector<TouchPrediction>& out);
  void remember_touch(EntityId a, EntityId b);
  bool have_touched(EntityId a, EntityId b) const;
  // The operator has moved the body away from everything it touched.
  void forget_touches(EntityId id);
  void finish(SimTime end);

  std::span<const Load> loads() const { return loads_; }
  // Without a valid carrier, the transport is open.
  LoadId add_load(TransportId transport, AgvId carrier, StationId at, StationId destination);
  const Load& load(LoadId id) const { return loads_[id.index()]; }
  void move_load(LoadId load, Holder to);
  // The oldest load that `agv` has to fetch at `station`, or else that of the oldest open transport there; invalid if
  // there is none.
  LoadId waiting_load(AgvId agv, StationId station) const;
  // Whether the AGV may take it up there.
  bool is_waiting(LoadId load, AgvId agv, StationId station) const;
  LoadId carried_load(AgvId agv) const { return carried_[agv.index()]; }
  // Invalid if the transport has not been released.
  LoadId load_of(TransportId transport) const;

 private:
  void begin(Body& body, const Piece& piece);
  void announce_end(const Piece& piece);

  const Scenario& scenario_;
  std::span<const std::unique_ptr<Law>> laws_;
  struct Listeners {
    std::vector<Law*> to_beginnings, to_ends, to_company;  // of pieces
  };
  Listeners listeners_;
  TraceSink* sink_;
  std::vector<Body> bodies_;
  Company company_;  // of the pieces under way
  std::vector<Load> loads_;
  std::vector<LoadId> carried_;                 // by AGV; invalid: none
  std::vector<std::vector<LoadId>> loads_of_;   // by AGV: those of its transports, oldest first
  std::vector<LoadId> open_loads_;              // those of open transports, oldest first
  std::vector<LoadId> load_of_;                 // by transport; invalid: not released
  std::vector<std::vector<EntityId>> touched_;  // by body
  std::uint64_t pieces_ = 0;
  EvaluationCount evaluations_;
};

}  // namespace fleetproof
