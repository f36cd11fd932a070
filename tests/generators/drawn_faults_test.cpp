#include "generators/worlds/drawn_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "generators/worlds/world_maker.hpp"

namespace fleetproof::drawn_faults_test {
namespace {

std::vector<SensingSetup> clocks_of(const WorldSpec& spec, std::uint64_t seed) {
  RejectionCounts counts;
  std::vector<SensingSetup> clocks;
  for (const AgvSetup& agv : generate_world(spec, seed, counts).agvs) clocks.push_back(agv.sensing);
  return clocks;
}

bool agree(const std::vector<SensingSetup>& clocks) {
  return std::ranges::all_of(
      clocks, [](const SensingSetup& clock) { return clock.clock_offset_s == 0.0 && clock.clock_drift_ppm == 0.0; });
}

TEST(DrawnFaults, ClocksAgreeInTheShareOfWorldsThatIsAskedFor) {
  constexpr std::uint64_t kWorlds = 400;
  WorldSpec spec, always_wrong;
  spec.layout = always_wrong.layout = std::string("corridor-sidings");
  spec.fleet_size = always_wrong.fleet_size = 2;
  spec.faults.clock_offset_s = always_wrong.faults.clock_offset_s = 1.0;
  spec.faults.clock_drift_ppm = always_wrong.faults.clock_drift_ppm = 500.0;
  spec.faults.clocks_agree_share = 0.25;
  std::uint64_t agreeing = 0;
  for (std::uint64_t seed = 0; seed < kWorlds; ++seed) {
    const auto clocks = clocks_of(spec, seed), wrong = clocks_of(always_wrong, seed);
    EXPECT_FALSE(agree(wrong));
    if (agree(clocks)) {
      ++agreeing;
    } else {
      EXPECT_EQ(clocks, wrong) << "of world " << seed << "; the share must change no other draw";
    }
  }
  EXPECT_NEAR(static_cast<double>(agreeing), 0.25 * kWorlds, 4.0 * 8.7);  // four standard deviations
}

}  // namespace
}  // namespace fleetproof::drawn_faults_test
