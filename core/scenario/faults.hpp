#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/base/words.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// Something that goes wrong with one AGV, at a time that the scenario fixes: drawn by a generator, or written by hand.
struct Fault {
  // The numbers are part of the trace digest.
  enum class Kind : std::uint8_t {
    Breakdown = 1,       // brakes, is out of order while it lasts, then goes on
    ProtectiveStop = 2,  // brakes, stands while it lasts, then goes on
    LoadDrop = 3,        // the load falls off and lies on the floor while it lasts; nothing happens to an empty AGV
    Restart = 4,         // the agent loses its memory and is away while it lasts; the AGV finishes what it was doing
    Freeze = 5,          // the agent does not answer while it lasts, and then sees everything at once
  };
  Kind kind = Kind::Breakdown;
  AgvId agv;
  Duration at{};                           // since the start of the run, or since the AGV took up that transport's load
  std::optional<std::uint32_t> transport;  // number among the AGV's own
  Duration lasts{};
  // LoadDrop only: the load on the floor, with its centre seen from the AGV's (along its heading, and to its left), and
  // aligned with it.
  Footprint load{.length_m = 1.2, .width_m = 0.8};
  double ahead_m = -1.6, left_m = 0.0;
};
constexpr const char* name_of(Fault::Kind kind) {
  switch (kind) {
    case Fault::Kind::Breakdown:
      return "breakdown";
    case Fault::Kind::ProtectiveStop:
      return "protective-stop";
    case Fault::Kind::LoadDrop:
      return "load-drop";
    case Fault::Kind::Restart:
      return "restart";
    case Fault::Kind::Freeze:
      return "freeze";
  }
  return kNoWord;
}
// Whether the fault holds its AGV where it is for as long as it lasts: the AGV brakes, stands and then goes on. What
// does not get done meanwhile is nobody's fault.
constexpr bool holds_agv(Fault::Kind kind) {
  return kind == Fault::Kind::Breakdown || kind == Fault::Kind::ProtectiveStop;
}

// The laser scanner of an AGV: it stops the AGV when a body stands in its protective field, and lets it go on some time
// after it is clear. The field is a rectangle before the front: v * reaction + v^2 / (2 deceleration) + margin long,
// and margin wider than the AGV on either side.
struct ScannerSetup {
  bool on = false;
  double reaction_s = 0.08;  // it looks as often
  double margin_m = 0.15;    // more than the safety distance, or it does not keep it
  double resume_s = 2.0;     // after the field is clear

  friend bool operator==(const ScannerSetup&, const ScannerSetup&) = default;
};

// What the operator is called for. The numbers are part of the trace digest.
enum class Assist : std::uint8_t {
  Battery = 1,     // it is empty: is changed
  Jam = 2,         // a scanner has held its AGV for long: the field is muted until it is clear, and the AGV sent on
  Contact = 3,     // the AGV is out of order after a contact: is taken off the floor and set down at a station
                   // (core/engine/recovery.hpp)
  Standstill = 4,  // no action began or ended for `stuck_after` although transports are open: one agent is restarted
};

// The person who helps, somebody for each call. Only a contact lets him move an AGV: he takes it off the floor, ends
// what holds it, changes the battery if that is empty, and sets it down, with its load, as soon as the place is clear
// by the safety distance of every body, of where its present drive or turn takes it, and of the lanes that AGVs have
// begun to drive or will drive next; he tries every second. The agent starts there, without memory and with the next
// boot number; orders not done are told again. What the contact was counted as stays. At a standstill he restarts the
// agent whose AGV, with a transport open, has begun and ended nothing for the longest (of equals the first) and which
// nothing else holds; he is called again when that has helped nobody for another `stuck_after`. A restart is no action:
// whether the run ends stuck is judged as ever.
struct OperatorSetup {
  bool on = false;
  double least_s = 60.0, most_s = 300.0;  // from call to help, uniform
  double battery = 1.0;                   // level after the change

  friend bool operator==(const OperatorSetup&, const OperatorSetup&) = default;
};

}  // namespace fleetproof
