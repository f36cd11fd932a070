// In a divided fleet, an AGV only talks to those that it can meet. The floor is divided into zones (ZoneMap). Here is
// what the proof of lock_protocol.hpp needs of that.
//
// Terms
// - Each message of an AGV announces the zones of all that it holds and requests. A stay of i in the zone z is a
//   longest time in which every message of i announces z. It begins with a stamp that no message had before. A restart
//   does not end the stay in the zones of what the AGV holds, because the first message of the new self announces them.
// - The roll of z lists the AGVs whose newest message, as far as the registrar knows, announces z, each with the boot
//   and the stamp of that message. The registrar shows a roll only if it has heard from every other AGV of the fleet a
//   message that was sent since its own boot.
// - i is a member of z if three things are true. (1) It announces z. (2) It has got the roll of z from the registrar,
//   who had heard of this stay from this self of i; it wrote the roll at an instant a_i. (3) For each other AGV j on
//   the roll, i has heard a message of j that is not older than the roll says; and the newest one that it knows does
//   not announce z, or j has acknowledged a message of this stay, as said by this self of i. It remains a member until
//   it announces z no more, or restarts.
// - When a message of a newer boot of j arrives, i forgets what former selves of j acknowledged and granted, and from
//   then on ignores what comes late of them. So in (3), a self of j acknowledges that is not older than the roll says.
//
// The roll of z that the registrar writes at a_j contains i if it wrote one for this stay of i before, and the stay has
// not ended since: the registrar had heard of the stay, or, if it has restarted since, it has heard again from i. The
// same is true if i holds what its body covers at the start: its stay began with its first message. (R) A roll may come
// in parts; a_j is then the instant of the part in which i is or would be. The registrar itself is on the roll without
// boot and stamp: the roll is a message of its present self.
//
// Let i lock a path at t_i that has a zone z, and hold at t_j >= t_i what has that zone. Let j be a member of z at t_j,
// and a_j the instant of its roll; so j has not restarted since. A self of i or j is called present if it is the one
// that locked or locks.
//
// (Z1) At t_j, the newest message of i that j knows announces z, and contains what i still holds at t_j.
// - Let a_j be later than a_i. By (R), i is on the roll of j. So a self of i has acknowledged the stay of j in a
//   message sent at an instant u, and j knows this message or a newer one. All of them announce z. If u >= t_i, they
//   contain the path. If u < t_i, that self is not older than the roll says, and the present self was on the roll at
//   a_j > a_i. So the present self knew of the stay of j at u and did not take j for elsewhere at t_i: j had granted
//   the path or acknowledged it. That was the present self of j, because i knew a message of it. So j has heard of the
//   path, and the newest message that it knows contains it, by (N) of lock_protocol.hpp.
// - Let a_j be earlier than a_i. By (R), j is on the roll of i. So the present self of j had acknowledged the stay of i
//   before t_i, or had left; but its stay lasts from before a_j to t_j. So i did not take j for elsewhere at t_i, and
//   the rest is as above.
// - If i has not locked what it holds, because its body covers it since the start, then u is an instant at which all
//   messages contain it.
//
// (Z2) If j uses a GRANT of i at t_j, the self of i that gave it has not been followed by another one at t_i. Suppose
// it had. The present self of i became a member after that restart, so a_i is later, too. j is in the epoch of the
// GRANT, and with it in z, from before the restart to t_j.
// - If a_j is later than a_i, the roll of j says the boot of the present self, so j has heard from that self.
// - If a_j is earlier, j is on the roll of i. So j has acknowledged a message of the present self of i.
// In both cases, j has forgotten the GRANT before t_j, and ignores it if it comes again.
//
// The proof uses no assumption about delay, order or number of messages either.
//
// Nobody enters the zones of a registrar that is down, or that has restarted while another AGV of the fleet is down;
// nor a zone with somebody on the roll who is down. All others go on.
#pragma once

#include <cstdint>
#include <vector>

#include "core/agents/neighbours.hpp"
#include "core/agents/protocol_messages.hpp"
#include "core/agents/zone_map.hpp"

namespace fleetproof::agents {

// In which zones this AGV is a member, and how it becomes one. It announces a zone in each of its messages, asks the
// registrar of the zone for the roll, and tells each AGV of the roll. It is a member when each of them has heard of it,
// or says in a message at least as new as the roll that it has left. It stays a member until it announces the zone no
// more. Any two members of a zone know each other: (Z1) at the head of this file.
class Membership {
 public:
  // Requires: both outlive the object.
  Membership(const ZoneMap& map, Neighbours& neighbours) : map_(map), neighbours_(neighbours) {}

  // Every message must announce these zones.
  const ZoneSet& announced() const { return announced_; }
  bool is_member_of_all(const ZoneSet& zones) const { return joined_.contains_all(zones); }

  // From now on it announces these zones; each message with this stamp or a later one does. Applies for what is new.
  void announce(const ZoneSet& zones, std::uint32_t since_ms);
  // Something was heard from this AGV.
  void look_at(std::uint32_t agv);
  // What the registrar says.
  void note_roll(std::uint32_t registrar, const Message& message);

  // Whether something has not been said yet.
  bool has_news() const { return has_news_; }
  // What is to be said to one AGV.
  struct Due {
    std::uint32_t agv = FP_NONE;
    bool applies = false;  // for the roll of these zones, from this AGV on. Without zones: that this AGV exists
    ZoneSet zones;
    std::uint32_t from = 0;
  };
  // Appends what has not been said yet; if it is time to `repeat`, also what may have been lost, most often of the
  // zones that are urgent.
  void append_due(bool repeat, const ZoneSet& urgent, std::vector<Due>& due);

 private:
  // When something is said again. Answers take a while, and most applications are made long before they matter.
  struct Reminders {
    std::uint32_t calls = 0;
    bool is_due(bool is_urgent) { return ++calls % (is_urgent ? 2 : 6) == 0; }
  };
  // An AGV of the roll, and the message that the registrar knows of it.
  struct Contact {
    std::uint32_t agv = FP_NONE;
    RollEntry known;
    bool is_told = false;
  };
  // For zones of one registrar.
  struct Application {
    ZoneSet zones;
    std::uint32_t registrar = FP_NONE;
    std::uint32_t since_ms = 0;
    std::uint32_t from = 0;  // the part of the roll that begins with this AGV is missing; FP_NONE: none
    bool is_sent = false;
    Reminders reminders;
    std::vector<Contact> contacts;  // those that are not known to have heard of it

    bool is_done() const { return from == FP_NONE && contacts.empty(); }
  };

  void apply(const ZoneSet& zones, std::uint32_t since_ms);
  void add_contact(Application& application, const RollEntry& entry);
  bool has_heard(const Application& application, const Contact& contact) const;
  void finish(Application& application);
  void append_due(Application& application, bool again, std::vector<Due>& due);

  const ZoneMap& map_;
  Neighbours& neighbours_;
  ZoneSet announced_, joined_;
  std::vector<Application> applications_;
  bool has_news_ = false;                     // of them, something may not have been said
  std::vector<std::uint32_t> introductions_;  // to the registrars, by index: how often one might have been due
};

}  // namespace fleetproof::agents
