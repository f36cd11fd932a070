#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

// What a FakeWarehouse consists of.
namespace fleetproof::agents::testing {

class FakeWarehouse;

struct FakeRadio {
  double loss = 0.0;
  double delay_s = 0.0;
  bool uniform = false;     // on 0 .. delay, so that messages overtake each other
  double duplicates = 0.0;  // share of receptions that come a second time, later
};

struct FakeHandle {
  FakeWarehouse* warehouse;
  std::uint32_t id;
};

struct FakeMessage {
  std::uint32_t sender;
  std::string bytes;
};

struct FakeOrder {
  std::uint32_t id, from, to;
};

// Until an instant, an AGV perceives a heading that it had before.
struct LateHeading {
  std::int64_t until_ns = 0;
  double x = 1.0, y = 0.0;
};

struct FakeAgv {
  FakeHandle handle{};
  fp_briefing briefing{};
  void* agent = nullptr;
  std::uint32_t station = 0;
  LateHeading late;
  fp_pose perceived(fp_pose as_it_is, std::int64_t now_ns) const {
    if (now_ns < late.until_ns) as_it_is.heading_x = late.x, as_it_is.heading_y = late.y;
    return as_it_is;
  }
  fp_pose pose{};
  const fp_lane* lane = nullptr;  // being driven
  const fp_lane* next = nullptr;  // to be driven afterwards; the warehouse stops every AGV between two lanes
  std::int64_t turn_begins_ns = 0, drive_begins_ns = 0, drive_ends_ns = 0;
  bool busy = false, loaded = false, stopped = false;
  std::uint32_t doing = FP_IDLE;
  double battery = 1.0;
  std::int64_t charging_since_ns = 0;
  std::deque<FakeOrder> orders;  // not done
  std::uint32_t carried = 0;     // the order of the load on board
  std::deque<FakeMessage> inbox;
  FakeMessage in_hand;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> timers;  // number, stamp
};

}  // namespace fleetproof::agents::testing
