#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/path.hpp"
#include "core/agents/protocol_messages.hpp"
#include "core/agents/settings.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// Paths that an AGV holds and requests are together no longer than this: whoever knows where an AGV is knows how far
// its hulls can extend.
double longest_claim_m(const MapView& map);

// What one knows of another AGV of the fleet.
struct Neighbour {
  bool known = false;
  Status status;  // the newest it sent

  // It was there after that instant of one's own clock; negative: never proved.
  Vec proved_position_m;
  std::int64_t proved_after_ns = -1;

  // Its newest request, and what one made of it.
  Epoch request_epoch = 0;
  Epoch closed_epoch = 0;  // requests up to this one are history
  Epoch granted_epoch = 0;
  std::int64_t demand_ns = 0;
  Path request;
  bool request_is_open() const { return request_epoch > closed_epoch; }

  // Its answers to one's own request.
  Epoch asked_epoch = 0;
  Epoch granted_us_epoch = 0;
  Epoch deferred_us_epoch = 0;
  std::uint32_t times_asked = 0;
  std::int64_t ask_at_ns = 0;
  std::int64_t silent_since_ns = 0;
};

class Neighbours {
 public:
  Neighbours(const MapView& map, HullGeometry& geometry, const fp_briefing& briefing, const Settings& settings = {});

  std::uint32_t fleet_count() const { return static_cast<std::uint32_t>(neighbours_.size()); }
  std::uint32_t self() const { return self_; }
  Neighbour& of(std::uint32_t agv) { return neighbours_[agv]; }
  const Neighbour& of(std::uint32_t agv) const { return neighbours_[agv]; }
  // Calls `f(agv, neighbour)` for everyone else.
  template <class F>
  void for_each(F f) {
    for (std::uint32_t agv = 0; agv < fleet_count(); ++agv) {
      if (agv != self_) f(agv, neighbours_[agv]);
    }
  }

  enum class News : std::uint8_t { Refused, Same, Changed };

  // Takes note of what a message tells about its sender. Refused if it cannot be: no such AGV, no such path. Changed if
  // the sender now stands, waits or holds otherwise than known. Messages may come in any order.
  News note(std::uint32_t sender, const Message& message, std::int64_t now_ns);

  // True only if it is certain that no hull which `agv` holds or requests at this instant comes near one's own hull of
  // `path`. Needs neither a bound on delays nor common clocks: the other's STATE acknowledges a stamp of one's own, so
  // it is younger than that. Only one's own clock is read; how wrong it may run is within a margin. So is how far off
  // and how late the position was that the other perceived.
  bool surely_beyond(std::uint32_t agv, const Path& path, std::int64_t now_ns);

  // The next part of the table of newest stamps; tables of large fleets take several messages.
  void tell_heard_from(HeardFrom& heard);

  // The stamp for a message sent now; never 0. A clock that starts below zero counts as zero until it is there.
  static std::uint32_t stamp_ms(std::int64_t now_ns) {
    return static_cast<std::uint32_t>(std::max<std::int64_t>(now_ns, 0) / 1'000'000) + 1;
  }

 private:
  void note_acknowledgement(Neighbour& neighbour, const Message& message, std::int64_t now_ns);

  const MapView& map_;
  HullGeometry& geometry_;
  std::uint32_t self_;
  std::vector<Neighbour> neighbours_;  // by AGV; one's own entry is unused
  std::vector<double> fastest_mps_;    // by AGV, with what a clock may be wrong
  double position_margin_m_, position_late_s_;
  double claim_m_;
  std::uint32_t next_heard_ = 0;
};

}  // namespace fleetproof::agents
