// What an AGV knows about the other AGVs, and which of them matter to it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/path.hpp"
#include "core/agents/protocol_messages.hpp"
#include "core/agents/settings.hpp"
#include "core/agents/zone_set.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// The other AGVs that matter to an AGV: in a fleet that is divided into zones those that announce a zone of its own, in
// other fleets all.
class Audience {
 public:
  Audience(std::uint32_t self, std::uint32_t fleet_count, bool divided)
      : divided_(divided), hears_of_all_(!divided || fleet_count <= HeardFrom::kMax) {
    for (std::uint32_t agv = 0; !divided && agv < fleet_count; ++agv) {
      if (agv != self) agvs_.push_back(agv);
    }
  }

  // Whether the fleet is so large that an AGV only talks to those in its zones.
  bool is_divided() const { return divided_; }
  // Whether an AGV hears of the whole fleet now and then: not in a divided fleet of more AGVs than one message has room
  // to acknowledge.
  bool hears_of_all() const { return hears_of_all_; }
  const ZoneSet& own_zones() const { return own_zones_; }
  // By ascending number.
  std::span<const std::uint32_t> agvs() const { return agvs_; }

  // Requires of these two: the fleet is divided. After the own zones have changed, each AGV must be noted again.
  void set_own_zones(const ZoneSet& zones) {
    own_zones_ = zones;
    agvs_.clear();
  }
  void note(std::uint32_t agv, const ZoneSet& zones) {
    const auto at = std::ranges::lower_bound(agvs_, agv);
    const bool is_there = at != agvs_.end() && *at == agv, belongs = zones.meets(own_zones_);
    if (belongs && !is_there) agvs_.insert(at, agv);
    if (!belongs && is_there) agvs_.erase(at);
  }

 private:
  bool divided_, hears_of_all_;
  ZoneSet own_zones_;
  std::vector<std::uint32_t> agvs_;
};

// The held and the requested path of an AGV are together no longer than this. The place of an AGV therefore limits how
// far its hulls extend.
double longest_claim_m(const MapView& map);

// When a message that may have been lost is sent again: at each of the first calls of `is_due`, then at every fourth.
struct Repeats {
  static constexpr std::uint32_t kQuick = 6;
  std::uint32_t calls = 0;

  bool is_due() {
    ++calls;
    return calls <= kQuick || calls % 4 == 0;
  }
};

// What this AGV knows about another AGV of the fleet.
struct Neighbour {
  bool known = false;
  Status status;  // the newest status that the other AGV sent
  ZoneSet zones;  // that the same message announces, in a divided fleet
  WayBytes way_bytes;
  // Takes what the message says of its ways; `ahead`: the announced way, with its beginning.
  void take_way(const Message& message, const Path& ahead) {
    status.held = message.status.held;
    status.ahead = ahead;
    zones = message.zones;
    way_bytes.keep(message.way_bytes, message.tells_zones);
  }

  // The other AGV was at this position after this instant of the own clock; negative: never proved.
  struct ProvedPlace {
    Vec position_m;
    std::int64_t after_ns = -1;
    Vec velocity_mps;  // between the position before and this one; only for agents that guess
  };
  ProvedPlace proved;

  // What it knows about the way of this AGV, and this AGV about its way.
  std::uint32_t heard_us_ms = 0;  // the newest stamp of this AGV that it says to have heard
  bool is_fresh = false;          // its newest status was sent since this boot of this AGV
  std::uint32_t way_changes = 0;  // how often its held or its announced way changed
  // The last answer of is_apart, and of what.
  struct Apart {
    Epoch request = 0;
    std::uint32_t way_changes = 0;
    bool is = false;
  };
  Apart apart;

  // Its newest request, and the answer of this AGV.
  Epoch request_epoch = 0;
  Epoch closed_epoch = 0;  // requests up to this epoch are over
  Epoch granted_epoch = 0;
  std::int64_t demand_ns = 0;
  Path request;
  bool request_is_open() const { return request_epoch > closed_epoch; }
  // Whether a request conflicts with a path of this AGV, for one version of that path.
  struct Clash {
    Epoch request = 0;
    std::uint32_t version = 0;
    bool is = false;
  };
  Clash with_held, with_request;  // the last answers
  bool asks_us = false;           // the newest message about that request names this AGV among those that must consent
  bool knows_defer = false;       // and says that this AGV has deferred
  Epoch deferred_epoch = 0;       // the newest epoch to which this AGV answered DEFER
  Repeats answer_repeats;

  // Its answers to the request of this AGV.
  Epoch asked_epoch = 0;    // the newest epoch of this AGV towards it
  bool is_missing = false;  // its consent to that epoch
  Epoch granted_us_epoch = 0;
  Epoch deferred_us_epoch = 0;
  std::int64_t silent_since_ns = 0;
  Repeats request_repeats;

  // In a divided fleet: the newest message of this AGV to it, and its condition then; whether the other AGV has
  // announced another way since.
  std::int64_t told_at_ns = -1;
  std::uint8_t told_condition = 0;
  bool owes_acknowledgement = false;
};

// The record of every AGV of which nothing is known.
const Neighbour& unknown_neighbour();

// Its newest message that is known. Requires: one is known.
inline RollEntry newest_of(std::uint32_t agv, const Neighbour& n) {
  return {agv, boot_of(n.status.epoch), n.status.stamp_ms};
}

// The stamp for a message that is sent now; never 0. A clock that shows less than zero counts as zero.
inline std::uint32_t stamp_ms_at(std::int64_t now_ns) {
  return static_cast<std::uint32_t>(std::max<std::int64_t>(now_ns, 0) / 1'000'000) + 1;
}

// A path of this AGV, and how often it has changed.
struct OwnPath {
  const Path& path;
  std::uint32_t version;
};

// What another AGV does inside the hull of a path: it stands and waits, or it holds floor there.
enum class Inside : std::uint8_t { Waiting, Holding };

class Neighbours {
 public:
  // Stamps are ahead of the clock by less than this, those of a former self too.
  static constexpr std::uint32_t kStampsAhead_ms = 100;

  Neighbours(const MapView& map, HullGeometry& geometry, const fp_briefing& briefing, const Settings& settings = {},
             const LockOptions& options = {});

  std::uint32_t fleet_count() const { return static_cast<std::uint32_t>(records_.size()); }
  std::uint32_t self() const { return self_; }
  double claim_limit_m() const { return claim_m_; }
  // Grows whenever anything changes that counts for a choice of ways: who the others are, where they are or go, whether
  // they wait or work, and what they ask for.
  std::uint64_t changes() const { return changes_; }
  // A record stays where it is. AGVs that this one never meets have none: it is made when somebody may change it.
  Neighbour& of(std::uint32_t agv) {
    if (records_[agv] == nullptr) records_[agv] = std::make_unique_for_overwrite<Neighbour>();
    return *records_[agv];
  }
  const Neighbour& of(std::uint32_t agv) const {
    return records_[agv] == nullptr ? unknown_neighbour() : *records_[agv];
  }
  // Calls `f(agv, neighbour)` for each AGV of the audience.
  template <class F>
  void for_each(F f) {
    for (const std::uint32_t agv : audience_.agvs()) f(agv, of(agv));
  }

  // The same, from this AGV on and round.
  template <class F>
  void for_each_from(std::uint32_t first, F f) {
    const auto agvs = audience_.agvs();
    auto next = static_cast<std::size_t>(std::ranges::lower_bound(agvs, first) - agvs.begin());
    for (std::size_t i = 0; i < agvs.size(); ++i, ++next) {
      if (next == agvs.size()) next = 0;
      f(agvs[next], of(agvs[next]));
    }
  }

  // Calls `f(agv, neighbour)` for every other AGV of which a message is known. Requires: `f` notes no message.
  template <class F>
  void for_each_known(F f) const {
    for (const std::uint32_t agv : known_) f(agv, of(agv));
  }

  const Audience& audience() const { return audience_; }
  void set_own_zones(const ZoneSet& zones);
  // Whether a message is known that the AGV sent since this boot of this AGV.
  bool is_fresh(std::uint32_t agv) const {
    const Neighbour* const n = records_[agv].get();
    return n != nullptr && n->known && (n->is_fresh || fresh_from_ms_ == 0);
  }

  enum class News : std::uint8_t { Refused, Same, Changed };

  // Stores what a message says about its sender. Refused: there is no such AGV or no such path. Changed: the place, the
  // waiting or the held path of the sender differs from what was known. Messages may arrive in any order.
  News note(std::uint32_t sender, const Message& message, std::int64_t now_ns);

  // True only if it is certain that no hull which `agv` holds or requests at this instant comes near the own hull of
  // `path`. This needs neither a bound on delays nor common clocks: the STATE of the other AGV acknowledges a stamp of
  // this AGV, so the STATE is younger than that stamp. Only the own clock is read. A margin covers the error of that
  // clock, and the error and the delay of the position that the other AGV perceived.
  bool surely_beyond(std::uint32_t agv, const Path& path, std::int64_t now_ns);

  // True only if `agv` knows its place, and the held path and the announced way, as it told them since this boot, keep
  // clear of the own hull of `path`. `request`: the epoch in which this AGV requests `path`.
  bool is_apart(std::uint32_t agv, const Path& path, Epoch request);
  // After a restart: what other AGVs sent before they heard a message of this instant or later may be older than this
  // boot. Then it does not say where they may drive now.
  void restarted_at(std::int64_t now_ns) { fresh_from_ms_ = stamp_ms_at(now_ns) + kStampsAhead_ms; }

  // An AGV that is known to do this inside the hull of `path`; FP_NONE if there is none.
  std::uint32_t first_inside(const Path& path, Inside what);
  bool is_inside(std::uint32_t agv, const Path& path, Inside what);
  // Whether the newest request of `agv` conflicts with a path of this AGV. `known`: the answer for an earlier version.
  bool clashes(std::uint32_t agv, Neighbour::Clash& known, const OwnPath& own);

  bool is_first_boot() const { return fresh_from_ms_ == 0; }

  // Fills in the newest stamp of one AGV.
  void tell_heard_from(HeardFrom& heard, std::uint32_t agv) const;
  // Fills in the next part of the table of newest stamps. The table of a large fleet needs several messages.
  void tell_heard_from(HeardFrom& heard);

 private:
  void note_request(Neighbour& neighbour, const Message& message, bool is_newest);
  void note_acknowledgement(Neighbour& neighbour, const Message& message, std::int64_t now_ns);
  void note_place(Neighbour& neighbour, const Message& message, std::int64_t sent_ns);

  const MapView& map_;
  HullGeometry& geometry_;
  std::uint32_t self_;
  std::vector<std::unique_ptr<Neighbour>> records_;  // by AGV
  std::vector<std::uint32_t> known_;                 // those of which a message is known, by ascending number
  Audience audience_;
  std::vector<double> fastest_mps_;  // by AGV; includes the error of a clock
  double position_margin_m_, position_late_s_;
  double claim_m_;
  ConsentOptions consent_;
  std::uint32_t fresh_from_ms_ = 0;
  std::uint32_t next_heard_ = 0;
  std::uint64_t changes_ = 0;
};

// Calls `f(agv, neighbour)` for each AGV that may matter to a way: the audience or, if a divided fleet is not large,
// all of which something is known.
template <class F>
void for_each_on_the_way(const Neighbours& neighbours, F f) {
  const Audience& audience = neighbours.audience();
  if (audience.is_divided() && audience.hears_of_all()) return neighbours.for_each_known(f);
  for (const std::uint32_t agv : audience.agvs()) f(agv, neighbours.of(agv));
}

}  // namespace fleetproof::agents
