// Streams held from another world, in families whose worlds are often refused and drawn again.
#include <gtest/gtest.h>

#include "generators/formats/layout_file.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::held_world_test {
namespace {

WorldSpec crowded() {
  WorldSpec spec;
  spec.layout = std::string("dense-crossing/stress");  // with so large a fleet a third of the draws has no room
  spec.fleet_size = 12;
  spec.vehicles[0].type.footprint = {3.9, 2.7};
  return spec;
}

std::vector<StationId> starts(const Scenario& scenario) {
  std::vector<StationId> stations;
  for (const AgvSetup& agv : scenario.agvs) stations.push_back(agv.start);
  return stations;
}

TEST(HeldWorld, ALayoutStaysItselfHoweverOftenTheRestIsDrawnAgain) {
  std::uint64_t refused_when_held_from = 0, refused_after = 0, other_starts = 0;
  for (std::uint64_t held_seed = 0; held_seed < 20; ++held_seed) {
    RejectionCounts first, later;
    const Scenario reference = generate_world(crowded(), held_seed, first);
    WorldSpec layout_held = crowded(), both_held = crowded();
    layout_held.held = {{Stream::Layout}, held_seed};
    both_held.held = {{Stream::Layout, Stream::Placement}, held_seed};
    for (std::uint64_t seed = 100; seed < 105; ++seed) {
      const Scenario one = generate_world(layout_held, seed, later), two = generate_world(both_held, seed, later);
      EXPECT_EQ(to_text(one.map->layout()), to_text(reference.map->layout())) << held_seed << " " << seed;
      EXPECT_EQ(to_text(two.map->layout()), to_text(reference.map->layout())) << held_seed << " " << seed;
      EXPECT_EQ(starts(two), starts(reference)) << held_seed << " " << seed;
      EXPECT_EQ(two.seed, seed);
      EXPECT_EQ(two.stream_seeds,
                (std::vector<StreamSeed>{{Stream::Layout, held_seed}, {Stream::Placement, held_seed}}));
      other_starts += starts(one) != starts(reference);
    }
    refused_when_held_from += first.worlds_rejected;
    refused_after += later.worlds_rejected;
  }
  EXPECT_GT(refused_when_held_from, 5U) << "else this test shows nothing";
  EXPECT_GT(refused_after, 0U) << "else this test shows nothing";
  EXPECT_GT(other_starts, 90U);
}

}  // namespace
}  // namespace fleetproof::held_world_test
