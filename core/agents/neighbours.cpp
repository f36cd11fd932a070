#include "core/agents/neighbours.hpp"

#include <algorithm>
#include <utility>

#include "core/agents/facts.hpp"
#include "core/agents/fleet.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kUsualClaim_m = 40.0;
constexpr double kPositionMargin_m = 1.0;  // at least: rounding on the wire, deviation from the track
constexpr double kSpeedMargin = 1.1;       // clocks that run wrong by up to 1 % are within it

double work_out_longest_claim_m(const MapView& map) {
  double longest_lane_m = 0.0;
  for (std::uint32_t id = 0; id < map.lane_count(); ++id)
    longest_lane_m = std::max(longest_lane_m, map.lane(id).length_m);
  return std::max(kUsualClaim_m, 2.0 * longest_lane_m);
}

// Paths that repeat those of an earlier message were checked then, and are not checked again.
bool is_possible(const MapView& map, bool is_divided, const Neighbour& known, const Message& message) {
  const Status& status = message.status;
  if (is_divided != message.tells_zones) return false;
  if (status.requesting && number_of(status.epoch) == 0) return false;
  if (message.has_request() && !(known.request_epoch > 0 && known.request == message.request) &&
      !is_driveable(map, message.request))
    return false;
  if (message.repeats_way) return true;
  return (known.known && known.status.held == status.held) || is_driveable(map, status.held);
}

// The announced way, with its beginning. Requires: the held path can be driven.
Path way_ahead(const MapView& map, const Status& status) {
  Path ahead = end_of(map, status.held);
  ahead.count = status.ahead.count;
  std::ranges::copy(status.ahead.lanes(), ahead.lane_ids.begin());
  return ahead;
}

// Within the tolerance of hulls.
bool is_same(const Path& a, const Path& b) { return a == b && same_heading(a.heading, b.heading); }

}  // namespace

const Neighbour& unknown_neighbour() {
  static const Neighbour kUnknown{};
  return kUnknown;
}

// Worked out once for all AGVs.
double longest_claim_m(const MapView& map) {
  if (map.facts() == nullptr) return work_out_longest_claim_m(map);
  const auto derive = [](const fp_facts* from, std::uint64_t, fp_answer* to) {
    answer(*from, to, std::vector{work_out_longest_claim_m(MapView(*from))});
  };
  return ask<double>(*map.facts(), derive, 0).front();
}

Neighbours::Neighbours(const MapView& map, HullGeometry& geometry, const fp_briefing& briefing,
                       const Settings& settings, const LockOptions& options)
    : map_(map),
      geometry_(geometry),
      self_(briefing.self),
      records_(briefing.fleet_count),
      audience_(briefing.self, briefing.fleet_count, briefing.fleet_count >= settings.zones_from),
      position_margin_m_(std::max(kPositionMargin_m, 2.0 * settings.position_error_m)),
      position_late_s_(settings.position_late_s),
      claim_m_(longest_claim_m(map)),
      consent_(options.consent) {
  for (std::uint32_t i = 0; i < briefing.fleet_count; ++i) {
    const double deviation = agv_of(briefing, i).speed_deviation;
    fastest_mps_.push_back(kSpeedMargin * (1.0 + deviation) * highest_speed_mps(briefing, i));
  }
}

Neighbours::News Neighbours::note(std::uint32_t sender, const Message& message, std::int64_t now_ns) {
  const Status& status = message.status;
  if (sender >= fleet_count() || sender == self_) return News::Refused;
  const Neighbour& known = std::as_const(*this).of(sender);  // its paths can be driven
  if (!is_possible(map_, audience_.is_divided(), known, message)) return News::Refused;
  Path ahead;
  if (!message.repeats_way) ahead = way_ahead(map_, status);
  const bool same_way = message.repeats_way || known.status.ahead == ahead;
  if (!(known.known && same_way) && !is_driveable(map_, ahead)) return News::Refused;
  Neighbour& n = of(sender);
  News news = News::Same;
  const std::uint32_t boot = boot_of(status.epoch), newest_boot = boot_of(n.status.epoch);
  const bool is_newest = !n.known || boot > newest_boot ||
                         (boot == newest_boot && (status.stamp_ms >= n.status.stamp_ms || !consent_.stamps_count));
  if (is_newest) {
    const bool same_held = n.known && n.status.place_unknown == status.place_unknown &&
                           (message.repeats_way || is_same(n.status.held, status.held));
    const bool same = same_held && n.status.waiting == status.waiting && n.status.blocked == status.blocked &&
                      n.status.held_up == status.held_up && n.status.out_of_order == status.out_of_order;
    if (!same) news = News::Changed;
    if (!same || !message.repeats_way || n.status.idle != status.idle) ++changes_;
    if (!same_held || !same_way) ++n.way_changes;
    if (!same_way && ahead.count > 0) n.owes_acknowledgement = true;
    // In a divided fleet, what a former self said does not count.
    if (audience_.is_divided() && boot > newest_boot) n.heard_us_ms = 0, n.granted_us_epoch = n.deferred_us_epoch = 0;
    static_cast<Condition&>(n.status) = status;
    if (!message.repeats_way) {
      n.take_way(message, ahead);
      if (audience_.is_divided()) audience_.note(sender, n.zones);
    }
  }
  if (!n.known) known_.insert(std::ranges::lower_bound(known_, sender), sender);
  n.known = true;
  const Epoch closed = status.requesting ? status.epoch - 1 : next_request(status.epoch) - 1;
  if (n.request_is_open() && closed >= n.request_epoch) ++changes_;
  n.closed_epoch = std::max(n.closed_epoch, closed);
  if (message.has_request()) note_request(n, message, is_newest);
  if (!audience_.is_divided() || boot >= boot_of(n.status.epoch)) note_acknowledgement(n, message, now_ns);
  return news;
}

void Neighbours::set_own_zones(const ZoneSet& zones) {
  ++changes_;
  audience_.set_own_zones(zones);
  for_each_known([&](std::uint32_t agv, const Neighbour& n) { audience_.note(agv, n.zones); });
}

void Neighbours::note_request(Neighbour& neighbour, const Message& message, bool is_newest) {
  const Asked::Entry* const us = message.asked.of(self_);
  const Epoch epoch = message.status.epoch + (us != nullptr ? us->attempt : 0);
  if (epoch > neighbour.closed_epoch && epoch > neighbour.request_epoch) {
    ++changes_;
    neighbour.request_epoch = epoch;
    neighbour.demand_ns = message.demand_ns;
    neighbour.request = message.request;
    neighbour.asks_us = us != nullptr;
    neighbour.knows_defer = false;
  } else if (is_newest && request_of(epoch) == request_of(neighbour.request_epoch)) {
    neighbour.asks_us = us != nullptr;
    neighbour.knows_defer = us != nullptr && message.asked.has_deferred(*us);
  }
}

void Neighbours::note_acknowledgement(Neighbour& neighbour, const Message& message, std::int64_t now_ns) {
  const HeardFrom& heard = message.heard;
  if (self_ < heard.first || self_ - heard.first >= heard.count) return;
  const std::int64_t stamp_ms = heard.stamps_ms[self_ - heard.first];
  const std::int64_t sent_ns = (stamp_ms - 1) * 1'000'000;
  neighbour.heard_us_ms = std::max(neighbour.heard_us_ms, static_cast<std::uint32_t>(stamp_ms));
  if (stamp_ms == 0 || sent_ns > now_ns) return;
  neighbour.is_fresh = neighbour.is_fresh || stamp_ms >= fresh_from_ms_;
  if (message.status.position_is_new) note_place(neighbour, message, sent_ns);
}

void Neighbours::note_place(Neighbour& neighbour, const Message& message, std::int64_t sent_ns) {
  if (sent_ns < neighbour.proved.after_ns) return;
  if (!consent_.places_spread && neighbour.proved.after_ns >= 0 && sent_ns > neighbour.proved.after_ns) {
    const double apart_s = static_cast<double>(sent_ns - neighbour.proved.after_ns) * 1e-9;
    neighbour.proved.velocity_mps = (message.status.position_m - neighbour.proved.position_m) * (1.0 / apart_s);
  }
  neighbour.proved.after_ns = sent_ns;
  neighbour.proved.position_m = message.status.position_m;
}

bool Neighbours::surely_beyond(std::uint32_t agv, const Path& path, std::int64_t now_ns) {
  const Neighbour& n = of(agv);
  if (n.proved.after_ns < 0) return false;
  const double age_s = consent_.proofs_age ? static_cast<double>(now_ns - n.proved.after_ns) * 1e-9 : 0.0;
  const double hulls_m = claim_m_ + geometry_.reach_m(agv) + geometry_.clearance_m();
  const Vec position_m = n.proved.position_m + n.proved.velocity_mps * (consent_.places_spread ? 0.0 : age_s);
  const double moved_m =
      fastest_mps_[agv] * ((consent_.places_spread ? age_s : 0.0) + position_late_s_) + position_margin_m_;
  const double needed_m = hulls_m + moved_m;
  if (length(position_m - map_.position_m(path.station)) <= needed_m)
    return false;  // mostly; saves looking at all parts
  return geometry_.distance_bound_m(position_m, self_, path) > needed_m;
}

bool Neighbours::is_apart(std::uint32_t agv, const Path& path, Epoch request) {
  Neighbour& n = of(agv);
  if (!is_fresh(agv) || n.status.place_unknown) return false;
  if (n.apart.request != request || n.apart.way_changes != n.way_changes) {
    n.apart = {request, n.way_changes, false};
    n.apart.is = !geometry_.conflict(self_, path, agv, n.status.held) &&
                 (n.status.ahead.empty() || !geometry_.conflict(self_, path, agv, n.status.ahead));
  }
  return n.apart.is;
}

bool Neighbours::is_inside(std::uint32_t agv, const Path& path, Inside what) {
  const Neighbour& n = of(agv);
  const bool counts = n.known && (what == Inside::Holding || n.status.waiting || n.status.out_of_order);
  return counts && geometry_.conflict(self_, path, agv, n.status.held);
}

std::uint32_t Neighbours::first_inside(const Path& path, Inside what) {
  std::uint32_t found = FP_NONE;
  for_each([&](std::uint32_t agv, const Neighbour&) {
    if (found == FP_NONE && is_inside(agv, path, what)) found = agv;
  });
  return found;
}

bool Neighbours::clashes(std::uint32_t agv, Neighbour::Clash& known, const OwnPath& own) {
  const Neighbour& n = of(agv);
  if (known.request != n.request_epoch || known.version != own.version)
    known = {n.request_epoch, own.version, geometry_.conflict(self_, own.path, agv, n.request)};
  return known.is;
}

void Neighbours::tell_heard_from(HeardFrom& heard, std::uint32_t agv) const {
  heard.first = agv;
  heard.count = 1;
  heard.stamps_ms[0] = of(agv).status.stamp_ms;
}

void Neighbours::tell_heard_from(HeardFrom& heard) {
  heard.first = next_heard_;
  heard.count = std::min(HeardFrom::kMax, fleet_count() - next_heard_);
  for (std::uint32_t i = 0; i < heard.count; ++i)
    heard.stamps_ms[i] = std::as_const(*this).of(next_heard_ + i).status.stamp_ms;
  next_heard_ = next_heard_ + heard.count == fleet_count() ? 0 : next_heard_ + heard.count;
}

}  // namespace fleetproof::agents
