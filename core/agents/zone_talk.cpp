#include "core/agents/zone_talk.hpp"

#include <algorithm>

namespace fleetproof::agents {

bool Registrar::is_ready() {
  while (heard_from_ < neighbours_.fleet_count() && has_heard_from(heard_from_)) ++heard_from_;
  return heard_from_ == neighbours_.fleet_count();
}

void Registrar::fill_in(Roll& roll, const ZoneSet& zones, std::uint32_t applicant, std::uint32_t from) const {
  roll.from = from;
  roll.next = FP_NONE;
  roll.count = 0;
  for (std::uint32_t agv = from; agv < neighbours_.fleet_count(); ++agv) {
    if (agv == applicant) continue;
    const bool is_self = agv == neighbours_.self();
    const Neighbour& n = neighbours_.of(agv);
    if (!(is_self ? neighbours_.audience().own_zones() : n.zones).meets(zones)) continue;
    if (roll.count == Roll::kMax) {
      roll.next = agv;
      return;
    }
    roll.list[roll.count++] = is_self ? RollEntry{agv, 0, 0} : newest_of(agv, n);
  }
}

bool ZoneTalk::find_zones_of_request() {
  of_request_.clear();
  return map_.add_zones(neighbours_.self(), claim_.request, of_request_);
}

// Announces the zones of the held path and of the request, and those of the way on while there is room. It announces
// these early to be a member of them before it requests the way.
void ZoneTalk::announce() {
  const std::uint32_t self = neighbours_.self();
  ZoneSet zones;
  map_.add_zones(self, claim_.held, zones);
  if (!claim_.knows_place) map_.add_zones_around(self, claim_.held.station, zones);
  if (claim_.requesting) map_.add_zones(self, claim_.request, zones);
  map_.add_zones(self, claim_.way.path(), zones);
  if (zones == membership_.announced()) return;
  for (const std::uint16_t zone : membership_.announced().all()) {
    if (!zones.contains(zone)) to_tell_.push_back(map_.registrar_of(zone));
  }
  neighbours_.for_each([&](std::uint32_t agv, const Neighbour& n) {
    if (!n.zones.meets(zones)) to_tell_.push_back(agv);
  });
  const bool more = !membership_.announced().contains_all(zones);
  membership_.announce(zones, more ? messages_.begin_new_stamp() : 0);
  neighbours_.set_own_zones(zones);
}

void ZoneTalk::hear(std::uint32_t sender, const Message& message) {
  membership_.look_at(sender);
  const bool applies = message.kind == MessageKind::Join && !message.about.empty();
  if (applies) {
    std::erase_if(applicants_, [&](const Applicant& a) { return a.agv == sender && a.zones == message.about; });
    applicants_.push_back({sender, message.about, message.roll.from});
  }
  if (message.kind == MessageKind::Roll) membership_.note_roll(sender, message);
  if (!message.wants_answer || applies) return;
  neighbours_.of(sender).owes_acknowledgement = true;
  to_answer_.push_back(sender);
}

void ZoneTalk::talk(bool repeat) {
  due_.clear();
  membership_.append_due(repeat, claim_.requesting ? of_request_ : ZoneSet{}, due_);
  if (repeat && !neighbours_.is_first_boot() && !registrar_.is_ready())
    registrar_.for_each_missing([&](std::uint32_t agv) { due_.push_back({agv, false, {}, 0}); });
  for (const Membership::Due& due : due_) {
    if (!due.applies) {
      messages_.tell(due.agv, true);
    } else if (due.agv == neighbours_.self()) {
      take_own_roll(due);
    } else {
      apply(due);
    }
  }
  if (!applicants_.empty() && registrar_.is_ready()) {
    for (const Applicant& applicant : applicants_) send_roll(applicant);
    applicants_.clear();
  }
  for (const std::uint32_t agv : to_answer_) {
    if (neighbours_.of(agv).owes_acknowledgement) messages_.tell(agv, false);
  }
  for (const std::uint32_t agv : to_tell_) {
    if (agv != neighbours_.self() && neighbours_.of(agv).told_at_ns != controller_.now_ns()) messages_.tell(agv, false);
  }
  to_answer_.clear(), to_tell_.clear();
}

void ZoneTalk::apply(const Membership::Due& due) {
  if (!due.zones.empty()) controller_.sometimes("joins");
  Message message = messages_.begin(MessageKind::Join);
  message.wants_answer = true;
  message.about = due.zones;
  message.roll.from = due.from;
  messages_.send_to(due.agv, message);
}

void ZoneTalk::send_roll(const Applicant& applicant) {
  Message message = messages_.begin(MessageKind::Roll);
  message.about = applicant.zones;
  message.roll.stamp_ms = neighbours_.of(applicant.agv).status.stamp_ms;
  registrar_.fill_in(message.roll, applicant.zones, applicant.agv, applicant.from);
  messages_.send_to(applicant.agv, message);
}

// An AGV that is the registrar of its own zones.
void ZoneTalk::take_own_roll(const Membership::Due& due) {
  if (!registrar_.is_ready()) return;
  Message message;
  message.about = due.zones;
  message.roll.stamp_ms = FP_NONE;  // it knows what it announces
  registrar_.fill_in(message.roll, due.zones, neighbours_.self(), due.from);
  membership_.note_roll(neighbours_.self(), message);
}

}  // namespace fleetproof::agents
