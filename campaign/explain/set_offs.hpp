#pragma once

#include <span>
#include <string>
#include <vector>

#include "campaign/explain/claim.hpp"

namespace fleetproof {

// What a message may be an answer to: the last of its kind that had reached the sender.
struct Question {
  MessageDelivery message;
  std::size_t again = 0;                      // so many more of its kind were sent before the drive
  std::optional<MessageDelivery> last_again;  // the last of them
};

// What a message answers, as its agent says: a message of the AGV that asks this, the last that had reached the sender.
struct Answered {
  std::string request;                       // its name
  std::optional<MessageDelivery> asked;      // absent: no such message had reached the sender
  std::optional<MessageDelivery> asked_new;  // before the drive, the AGV had asked something else: the first time
};

// A message that held the key to a drive: without it alone, the AGV does not set off then.
struct GoAhead {
  MessageDelivery message;
  Claim claim;
  std::vector<Question> asked;  // of the AGV, one for each kind, the latest first; empty: the sender had heard nothing
  std::optional<Departure> sender_drive;  // the last of its sender before it was sent
  bool is_last_drive = false;             // and before the failure
  std::optional<Answered> answered{};     // absent: its agent does not say what it answers
};

// What an AGV that set off had from one other AGV.
struct Leave {
  EntityId from;
  std::vector<std::string> kinds;  // without all its messages of this kind, it does not set off then; "" is no word
  std::vector<Claim> claims;       // one for each kind
  // It sets off without any other of its messages. Absent: it does not, or there were no others.
  std::optional<Claim> without_others;
  std::vector<GoAhead> keys;  // the latest first
};

// The drive on which an AGV of the failure was, or its turn on the spot, and what let it begin.
struct SetOff {
  EntityId agv;
  Departure drive;            // of a turn, from and to are one station
  std::vector<Leave> leaves;  // of each other AGV that sent it anything in the time that is looked at

  bool is_turn() const { return drive.from == drive.to; }
};

// So long before a drive its messages are looked at.
inline constexpr Duration kLookedAt = std::chrono::seconds(10);

// Messages are lost one by one, and all of a kind from one sender, also those that it sends because others are lost;
// each in a run of its own. "Then" is within 5 ms. If the time of the host is over, GivenUp is thrown, and `found` has
// those that were found until then.
void add_set_offs(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
                  std::vector<SetOff>& found);

// The last that an AGV began until then. Null: none. Requires: departures in order of time.
const Departure* last_departure(std::span<const Departure> departures, EntityId agv, SimTime until);

// The drives, or turns on the spot, on which the bodies of the failure were when it came: at most one of each.
std::vector<Departure> failed_drives(const CaseRun& run, const Failure& failure);

// Whether the AGV begins this drive in the run then.
bool sets_off_then(const CaseRun& run, const Departure& drive);

}  // namespace fleetproof
