#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/base/words.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// Something that goes wrong with one participant, an AGV or a computer, at an instant that the scenario fixes. It is
// drawn or listed by a user.
struct Fault {
  // The numbers are part of the trace digest.
  enum class Kind : std::uint8_t {
    Breakdown = 1,       // the AGV brakes, is out of order while the fault lasts, then goes on
    ProtectiveStop = 2,  // the AGV brakes, stands while the fault lasts, then goes on
    LoadDrop = 3,        // the load lies on the floor while the fault lasts; denied without a load, or without room
    Restart = 4,         // the agent loses its memory and is away while the fault lasts; the AGV finishes its action
    Freeze = 5,          // the agent receives no event while the fault lasts, and then all of them
    // Breakdown and restart in one: the AGV brakes, and its agent is away while the fault lasts. Of a computer: a
    // restart.
    PowerFailure = 6,
    DiskLoss = 7,  // a restart after which the disk is empty
    // The program alone knows what it means: it is told `word`, `number` and for how long. Denied if it does not know
    // the word.
    Named = 8,
  };
  Kind kind = Kind::Breakdown;
  EntityId agv;   // or a computer, where the kind strikes computers; invalid: the AGV that picks an open transport
  Duration at{};  // since the start of the run, or since the AGV picked the load of `transport`
  std::optional<std::uint32_t> transport;  // the number of a transport of this AGV, or of an open one
  Duration lasts{};
  // LoadDrop only: the load on the floor. It is aligned with the AGV. Its centre is `ahead_m` and `left_m` from the
  // centre of the AGV.
  Footprint load{.length_m = 1.2, .width_m = 0.8};
  double ahead_m = -1.6, left_m = 0.0;
  // Named only.
  std::string word{};
  std::uint32_t number = 0;
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
    case Fault::Kind::PowerFailure:
      return "power-failure";
    case Fault::Kind::DiskLoss:
      return "disk-loss";
    case Fault::Kind::Named:
      return "named";
  }
  return kNoWord;
}
// Whether the AGV brakes and stands while the fault lasts, and then goes on. The fleet is not accused of what it does
// not do in this time. Only a drive brakes: a turn on the spot ends at once, where it is.
constexpr bool holds_agv(Fault::Kind kind) {
  return kind == Fault::Kind::Breakdown || kind == Fault::Kind::ProtectiveStop || kind == Fault::Kind::PowerFailure;
}
// Whether the agent is away while the fault lasts, and starts anew after it.
constexpr bool stops_computer(Fault::Kind kind) {
  return kind == Fault::Kind::Restart || kind == Fault::Kind::PowerFailure || kind == Fault::Kind::DiskLoss;
}
// Whether the fault concerns the agent alone: it strikes an agent that runs, also if the AGV is out of order.
constexpr bool concerns_agent_alone(Fault::Kind kind) {
  return kind == Fault::Kind::Restart || kind == Fault::Kind::Freeze || kind == Fault::Kind::DiskLoss ||
         kind == Fault::Kind::Named;
}

// Whether a computer may have the fault.
constexpr bool strikes_computers(Fault::Kind kind) { return stops_computer(kind) || concerns_agent_alone(kind); }
// "restart"; of a named fault "named connection-cut 3".
std::string text_of(const Fault& fault);

// Why a run does not give what the scenario asks for: a fault that changes nothing, or an obstacle that does not come.
enum class Denial : std::uint8_t {
  OutOfOrder = 1,   // the AGV was out of order already
  AgentAway = 2,    // the agent was away already
  NoSuchLoad = 3,   // the AGV carried no load, or that of another transport
  NoRoom = 4,       // another body was in the place, or the AGV itself
  NotSent = 5,      // the message was never sent: one with a given delivery
  NoSuchKind = 6,   // no message was described so: of a kind that the radio spares
  UnknownWord = 7,  // the program does not know the word of a named fault
};
constexpr const char* name_of(Denial why) {
  switch (why) {
    case Denial::OutOfOrder:
      return "the AGV was out of order already";
    case Denial::AgentAway:
      return "the agent was away already";
    case Denial::NoSuchLoad:
      return "the AGV carried no such load";
    case Denial::NoRoom:
      return "no room: a body was in the place";
    case Denial::NotSent:
      return "no such message was sent";
    case Denial::NoSuchKind:
      return "no message was described so";
    case Denial::UnknownWord:
      return "the program does not know this fault";
  }
  return kNoWord;
}

// The laser scanner of an AGV. It stops the AGV when a body is in its protective field, and lets the AGV go on some
// time after the field is clear. The field is a rectangle before the end of the AGV that goes first. Its length is v *
// reaction + v^2 / (2 deceleration) + margin, but at most the range. On either side, it is wider than the AGV by the
// margin.
struct ScannerSetup {
  bool on = false;
  double reaction_s = 0.08;  // also the time between two looks
  double margin_m = 0.15;    // must be more than the safety distance to keep the safety distance
  double resume_s = 2.0;     // from a clear field until the AGV goes on
  double range_m = 0.0;      // 0: no limit; shorter than the braking way: the AGV stops too late

  friend bool operator==(const ScannerSetup&, const ScannerSetup&) = default;
};

// Why the operator is called. The numbers are part of the trace digest.
enum class Assist : std::uint8_t {
  Battery = 1,     // the battery is empty; the operator changes it
  Jam = 2,         // a scanner has held its AGV for long; the operator mutes the field until it is clear
  Contact = 3,     // the AGV is out of order after a contact; the operator takes it off the floor and sets it
                   // down at a station (core/engine/operator_actions.hpp)
  Standstill = 4,  // transports are open, and no AGV works or has worked for `stuck_after`; a program is restarted
};

// The operator helps AGVs; for each call, an operator is available. After a contact, the operator takes the AGV off the
// floor, ends its halts and changes an empty battery. It sets the AGV down with its load when the place is clear of all
// bodies and their present pieces by the safety distance, and of the lanes that AGVs drive now or next; it tries every
// second. The agent then starts with the next boot number, and open orders are sent again. The contact still counts. At
// a standstill, the operator first restarts the programs of all computers. If there are none, or if no work begins or
// ends for another `stuck_after`, the operator is called again and restarts the agent of the AGV that has begun and
// ended nothing for the longest time (of equals, the first). That AGV has an open transport, or there is one that no
// AGV is given; it has no activity under way, and no halt but one of its agent. And so on, until work begins. A restart
// is not an action and does not change whether the run ends stuck.
struct OperatorSetup {
  bool on = false;
  double least_s = 60.0, most_s = 300.0;  // from the call to the help, uniform
  double battery = 1.0;                   // the level after a change

  friend bool operator==(const OperatorSetup&, const OperatorSetup&) = default;
};

}  // namespace fleetproof
