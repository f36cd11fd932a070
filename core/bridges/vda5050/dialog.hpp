#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/agents/central/messages.hpp"
#include "core/bridges/vda5050/documents.hpp"
#include "core/bridges/vda5050/plant_names.hpp"

// What a master and one of its vehicles tell each other, between VDA 5050 and the book of the zone-server.
//
// A way (floor_book.hpp) begins behind a barrier: a cancelOrder with an actionId of its own. Messages of a master reach
// a vehicle in the order in which they were sent, or not at all; so once the vehicle tells how that action ended, no
// order from before is under way to it, and it has none. From where it then stands, the way goes on in legs: orders
// "1.2.3" (boot of the server, way, leg) whose base grows by updates. A leg is sent with the transfers at its first
// station, because nothing can be added to a node that is released. One update is under way at a time; it is sent
// again, unchanged, until the vehicle tells that it has it.
//
// The vehicle tells of an order that is not of the way, or of none after a leg: it has begun again. Then a new way
// begins.
namespace fleetproof::bridges::vda5050 {

// Of a leg: what was sent, and what the vehicle has.
struct Leg {
  std::uint32_t number = 0;       // from 1 on; 0: there is none
  std::uint32_t first_step = 0;   // of the way
  std::uint32_t station = 0;      // where it begins
  std::uint32_t update = 0;       // the newest one
  std::uint32_t update_from = 0;  // the step of this leg with which it begins
  bool is_known = true;           // the vehicle has it
  std::vector<agents::central::Step> steps;
  void fields(auto& io) { io(number, first_step, station, update, update_from, is_known, steps); }
};

class Dialog {
 public:
  Dialog(const agents::MapView& map, const PlantNames& names) : map_(map), names_(names) {}

  // A way begins: with the barrier.
  void begin(agents::central::WayNumber way);
  // As its former self left it.
  void recall(agents::central::WayNumber way, const Leg& leg, std::uint32_t station);
  const Leg& leg() const { return leg_; }
  bool is_joining() const { return is_joining_; }

  enum class Heard : std::uint8_t { Nothing, OfWay, BeganAgain };
  // What the book has to hear of this; only if it is of the way.
  Heard hear(const State& state, agents::central::State& to);
  // These steps follow what was sent. False: not now, or there are none.
  bool send(std::uint32_t first, std::vector<agents::central::Step> steps);

  // What has to be sent until it is known: the barrier, or the newest update. Without headers.
  std::optional<InstantActions> barrier() const;
  std::optional<Order> order() const;

 private:
  std::string way_name() const;
  std::string leg_name() const { return way_name() + "." + std::to_string(leg_.number); }
  std::string action_id(std::size_t step) const { return leg_name() + "/" + std::to_string(step); }
  bool has_former_leg(const State& state, std::uint32_t station) const;
  std::uint32_t steps_done(const State& state) const;
  std::uint32_t station_after(std::size_t steps) const;  // of the leg

  const agents::MapView& map_;
  const PlantNames& names_;
  agents::central::WayNumber way_;
  Leg leg_;
  std::uint32_t station_ = 0;  // where the way began
  std::uint32_t done_ = 0, heard_ = 0;
  bool is_joining_ = true;
};

}  // namespace fleetproof::bridges::vda5050
