// What a follower and its zone-server tell each other, and what the server keeps on its disk of each follower.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/agents/byte_fields.hpp"
#include "core/agents/open_orders.hpp"
#include "core/agents/shapes.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents::central {

// One controller call: drives a lane, or picks, drops or charges where the AGV then stands.
struct Step {
  enum class Kind : std::uint8_t { Drive, Pick, Drop, Charge };
  Kind kind = Kind::Drive;
  std::uint32_t what = FP_NONE;  // Drive: the lane; Pick and Drop: the order
  bool drives() const { return kind == Kind::Drive; }
  bool charges() const { return kind == Kind::Charge; }
  friend bool operator==(const Step&, const Step&) = default;
  void fields(auto& io) {
    io(kind, what);
    io.require(static_cast<std::uint8_t>(kind) <= static_cast<std::uint8_t>(Kind::Charge));
  }
};

// Which way a message is about: an AGV begins one at rest, for one boot of the server and of its own computer.
struct WayNumber {
  std::uint32_t server_boot = 0, agv_boot = 0;
  friend bool operator==(const WayNumber&, const WayNumber&) = default;
  void fields(auto& io) { io(server_boot, agv_boot); }
  // "way 1.2": for people who read a trace.
  std::string name() const { return "way " + std::to_string(server_boot) + "." + std::to_string(agv_boot); }
};

// From a follower. All numbers of steps and orders count from the beginning of its way.
struct State {
  WayNumber way;
  bool stands = false;        // the way has begun; false: the AGV does not rest yet, or does not know its place
  std::uint32_t station = 0;  // where the way began, and with which heading
  Vec heading{1.0, 0.0};
  std::uint32_t load = FP_NONE;  // the order whose load was on board then
  std::uint32_t known = 0;       // it has so many steps
  std::uint32_t done = 0;        // and has left so many behind: its body covers no floor of them alone
  std::uint32_t number = 0;      // of this message, since the boot
  double battery = 1.0;
  bool out_of_order = false;
  bool has_work = false;          // as the newest Grant says
  std::uint32_t first_order = 0;  // the number of the first of these
  std::vector<Order> orders;      // that the server may not have
  void fields(auto& io) {
    constexpr double kRounding = 1e-9;
    io.mark(0xB1);
    io(way, stands, station, heading.x, heading.y, load, known, done);
    io(number, battery, out_of_order, has_work, first_order, orders);
    io.require(std::abs(length(heading) - 1.0) < kRounding && done <= known);
  }
};

// From the server. Without steps, it says which boot of the server is the present one, and what has arrived.
struct Grant {
  WayNumber way;
  std::uint32_t first = 0;  // the number of the first of these steps
  std::vector<Step> steps;
  std::uint32_t orders = 0;  // the server has so many orders of this way
  bool has_work = false;     // an open order is for this AGV
  void fields(auto& io) {
    io.mark(0xB2);
    io(way, first, steps, orders, has_work);
  }
};

// A station to go to, and what to do there.
struct Goal {
  std::uint32_t station = FP_NONE;
  Step step;
  void fields(auto& io) { io(station, step); }
};

// What an AGV is to do.
struct Work {
  std::vector<Goal> goals;   // that nothing was granted for
  std::uint32_t orders = 0;  // of its present way, so many are known
  bool charging = false;     // it is at a charger, or on the last steps to one
};

// All that the server has told an AGV, and that is not done.
struct AgvRecord {
  State state;  // as if the AGV had begun its way where the path begins that the book has for it
  Grant grant;  // all steps from there
  Work work;    // how many orders are known, the grant says
  std::uint32_t era() const { return state.way.server_boot; }
  void fields(auto& io) {
    io.mark(0xB3);
    io(state, grant, work.goals, work.charging);
  }
};

// No message is longer than FP_MESSAGE_BYTES_MAX.
inline constexpr std::size_t kMostOrdersInAMessage = 48, kMostStepsInAMessage = 120;

}  // namespace fleetproof::agents::central
