#include <gtest/gtest.h>

#include "core/agents/agent_type.hpp"
#include "core/agents/hull_lock.hpp"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/fake_warehouse.hpp"
#include "tests/agents/junction.hpp"

namespace fleetproof::agents::aisle_test {
namespace {

using testing::DrawnMap;
using testing::FakeRadio;
using testing::FakeWarehouse;
using testing::TestFleet;
using testing::watch_holds;

constexpr std::uint32_t kStops = 24;

// A two-way aisle whose two ends are joined by a one-way street with a place to wait beside each end. No stop in the
// aisle cuts off any other stop, so an AGV may wait at each of them; but two AGVs cannot pass.
struct Aisle {
  Aisle() {
    for (std::uint32_t i = 0; i < kStops; ++i) drawn.station(0, 2.4 * i, FP_STORAGE);
    for (std::uint32_t i = 0; i + 1 < kStops; ++i) drawn.segment(i, i + 1);
    const double top_m = 2.4 * (kStops - 1);
    const auto south = drawn.station(0, -4), corner = drawn.station(8, -4), other_corner = drawn.station(8, top_m + 4),
               north = drawn.station(0, top_m + 4);
    drawn.segment(south, 0), drawn.segment(kStops - 1, north);
    drawn.segment(north, other_corner, false), drawn.segment(other_corner, corner, false);
    drawn.segment(corner, south, false);
  }
  DrawnMap drawn;
};

// hull-lock without the convention of aisles, so that AGVs meet in them.
constinit const fp_agent_type kMeetsInAisles =
    faulty_hull_lock<LockOptions{.progress = {.one_way_aisles = false}}>("meets-in-aisles", "for this test");

struct Tally : testing::Tally {
  std::uint32_t southward = 0;  // activations on a lane that leads south in the middle of the aisle
};

// Every AGV carries loads from one end of the aisle to the other and back.
Tally carry(const fp_agent_type& type, const FakeRadio& radio, std::uint32_t agvs, std::uint32_t orders,
            std::uint32_t seeds) {
  Aisle aisle;
  const TestFleet fleet(aisle.drawn.map(), agvs);
  std::vector<std::uint32_t> starts;
  for (std::uint32_t id = 0; id < agvs; ++id) starts.push_back(1 + id * (kStops - 2) / agvs);
  Tally tally;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    FakeWarehouse warehouse(aisle.drawn, fleet, starts, type, radio, seed);
    for (std::uint32_t id = 0; id < agvs; ++id) {
      warehouse.heading(id, 0.0, 1.0);
      for (std::uint32_t i = 0; i < orders; ++i) {
        const bool up = (i + id) % 2 == 0;
        warehouse.order(id, 0.1 * (id + 1), up ? 2 + i : kStops - 3 - i, up ? kStops - 3 - i : 2 + i);
      }
    }
    watch_holds(warehouse, fleet, tally);
    const auto watch = warehouse.after_activation;
    warehouse.after_activation = [&](std::uint32_t id) {
      watch(id);
      const fp_lane* lane = warehouse.lane_of(id);
      const bool in_the_middle = lane != nullptr && lane->from > kStops / 3 && lane->from < 2 * kStops / 3;
      if (in_the_middle && lane->to < lane->from) ++tally.southward;
    };
    warehouse.run(3000.0, agvs * orders);
    finish(warehouse, tally);
  }
  return tally;
}

// Each wants to go where the other comes from. The younger demand must leave the way of the older one until that one is
// where it wants to go: if every step made a demand younger, both would go up and down for ever.
TEST(Aisle, ThoseThatMeetInItGetPastEachOther) {
  for (const FakeRadio& radio : {FakeRadio{0.0, 0.1, false, 0.0}, {0.0, 2.0, true, 0.0}, {0.4, 2.0, true, 0.1}}) {
    const Tally tally = carry(kMeetsInAisles, radio, 3, 4, 6);
    EXPECT_EQ(tally.conflicting_holds, 0U);
    EXPECT_EQ(tally.violations, 0U);
    EXPECT_EQ(tally.drops, 12 * tally.runs) << "latest " << tally.latest_drop_s << " s";
  }
}

// The street leads from the north to the south, so the fleet drives the aisle to the north, but for a stop that it has
// just passed. AGVs that want to enter the aisle from both ends do not meet inside.
TEST(Aisle, ACrowdedFleetDrivesItOneWay) {
  for (const FakeRadio& radio : {FakeRadio{0.0, 0.1, false, 0.0}, {0.4, 2.0, true, 0.1}}) {
    for (const std::uint32_t agvs : {2U, 3U}) {
      const Tally tally = carry(kHullLock, radio, agvs, 4, 6);
      EXPECT_EQ(tally.conflicting_holds, 0U);
      EXPECT_EQ(tally.violations, 0U);
      EXPECT_EQ(tally.drops, 4 * agvs * tally.runs) << "latest " << tally.latest_drop_s << " s";
      EXPECT_EQ(tally.southward, 0U);
    }
  }
  EXPECT_GT(carry(kMeetsInAisles, FakeRadio{0.0, 0.1, false, 0.0}, 2, 4, 1).southward, 0U);
}

}  // namespace
}  // namespace fleetproof::agents::aisle_test
