#include "core/agents/membership.hpp"

#include <algorithm>

namespace fleetproof::agents {
namespace {

constexpr std::uint32_t kCallsPerIntroduction = 2;

}  // namespace

void Membership::announce(const ZoneSet& zones, std::uint32_t since_ms) {
  joined_.keep_if([&](std::uint16_t zone) { return zones.contains(zone); });
  for (Application& application : applications_)
    application.zones.keep_if([&](std::uint16_t zone) { return zones.contains(zone); });
  std::erase_if(applications_, [](const Application& application) { return application.zones.empty(); });
  for (Application& application : applications_) {  // some contacts were for zones that it has left
    std::erase_if(application.contacts, [&](const Contact& contact) { return has_heard(application, contact); });
    finish(application);
  }
  std::erase_if(applications_, [](const Application& application) { return application.is_done(); });
  ZoneSet added = zones;
  added.keep_if([&](std::uint16_t zone) { return !announced_.contains(zone); });
  announced_ = zones;
  if (!added.empty()) apply(added, since_ms);
}

void Membership::apply(const ZoneSet& zones, std::uint32_t since_ms) {
  has_news_ = true;
  const std::size_t first = applications_.size();
  for (const std::uint16_t zone : zones.all()) {
    const std::uint32_t registrar = map_.registrar_of(zone);
    auto at = std::find_if(applications_.begin() + static_cast<std::ptrdiff_t>(first), applications_.end(),
                           [&](const Application& a) { return a.registrar == registrar; });
    if (at == applications_.end()) {
      applications_.emplace_back();
      at = applications_.end() - 1;
      at->registrar = registrar;
      at->since_ms = since_ms;
    }
    at->zones.add(zone);
  }
  // Those that are known to be there are told at once, not only when the roll has come.
  for (std::size_t i = first; i < applications_.size(); ++i) {
    neighbours_.for_each_known([&](std::uint32_t agv, const Neighbour& n) {
      if (n.zones.meets(applications_[i].zones)) add_contact(applications_[i], {agv, 0, 0});
    });
  }
}

void Membership::add_contact(Application& application, const RollEntry& entry) {
  if (entry.agv == neighbours_.self()) return;
  const auto same = std::ranges::find(application.contacts, entry.agv, &Contact::agv);
  if (same != application.contacts.end()) {
    if (is_older(same->known, entry)) same->known = entry;
    return;
  }
  const Contact contact{entry.agv, entry};
  if (!has_heard(application, contact)) application.contacts.push_back(contact);
}

bool Membership::has_heard(const Application& application, const Contact& contact) const {
  const Neighbour& n = neighbours_.of(contact.agv);
  if (!n.known || is_older(newest_of(contact.agv, n), contact.known)) return false;
  return !n.zones.meets(application.zones) || n.heard_us_ms >= application.since_ms;
}

void Membership::look_at(std::uint32_t agv) {
  for (Application& application : applications_) {
    std::erase_if(application.contacts,
                  [&](const Contact& contact) { return contact.agv == agv && has_heard(application, contact); });
    finish(application);
  }
  std::erase_if(applications_, [](const Application& application) { return application.is_done(); });
}

void Membership::finish(Application& application) {
  if (!application.is_done()) return;
  for (const std::uint16_t zone : application.zones.all()) joined_.add(zone);
}

// The registrar had heard a message that announces the zones when it wrote the roll: each AGV that comes later finds
// this one on the roll.
void Membership::note_roll(std::uint32_t registrar, const Message& message) {
  for (Application& application : applications_) {
    if (application.registrar != registrar || !message.about.contains_all(application.zones) ||
        application.from != message.roll.from || message.roll.stamp_ms < application.since_ms)
      continue;
    for (const RollEntry& entry : message.roll.all()) {
      if (entry.agv < neighbours_.fleet_count()) add_contact(application, entry);
    }
    has_news_ = true;
    application.from = message.roll.next;
    application.is_sent = false;
    application.reminders = {};
    finish(application);
  }
  std::erase_if(applications_, [](const Application& application) { return application.is_done(); });
}

void Membership::append_due(bool repeat, const ZoneSet& urgent, std::vector<Due>& due) {
  has_news_ = false;
  for (Application& application : applications_)
    append_due(application, repeat && application.reminders.is_due(application.zones.meets(urgent)), due);
  if (!repeat) return;
  introductions_.resize(map_.registrar_count());
  for (std::uint32_t i = 0; i < map_.registrar_count(); ++i) {
    const std::uint32_t registrar = map_.registrar(i);
    const bool knows_us = registrar == neighbours_.self() || neighbours_.of(registrar).heard_us_ms > 0;
    if (!knows_us && introductions_[i]++ % kCallsPerIntroduction == 0) due.push_back({registrar, true, {}, 0});
  }
}

void Membership::append_due(Application& application, bool again, std::vector<Due>& due) {
  if (application.from != FP_NONE && (!application.is_sent || again))
    due.push_back({application.registrar, true, application.zones, application.from});
  application.is_sent = true;
  for (Contact& contact : application.contacts) {
    if (!contact.is_told || again) due.push_back({contact.agv, false, {}, 0});
    contact.is_told = true;
  }
}

}  // namespace fleetproof::agents
