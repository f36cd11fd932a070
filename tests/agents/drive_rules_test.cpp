#include "core/agents/drive_rules.hpp"

#include <gtest/gtest.h>

#include <string>

#include "drawn_map.hpp"

namespace fleetproof::agents::drive_rules_test {
namespace {

// Lanes by their ends: those that an AGV without a load may drive and from which it comes back as it is (b), those
// where it has to pick a load first (p), and those that it may not drive (-). Then the same with a load.
std::string lanes_of(testing::DrawnMap& drawn) {
  const MapView map(drawn.map());
  const DriveRules rules(map, 0);
  std::string text;
  for (const bool loaded : {false, true}) {
    for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane)
      text += rules.leads_back(lane, loaded) ? 'b' : rules.is_usable(lane, loaded) ? 'p' : '-';
    text += loaded ? "" : " ";
  }
  return text;
}

TEST(DriveRules, ALaneThatAllMayDriveLeadsBack) {
  testing::DrawnMap drawn;
  for (double x_m : {0.0, 5.0, 10.0}) drawn.station(x_m, 0.0);
  drawn.segment(0, 1), drawn.segment(1, 2);
  EXPECT_EQ(lanes_of(drawn), "bbbb bbbb");
}

// 0 - 1 - 2 and a source at 3: an AGV that drives there comes back with a load only.
TEST(DriveRules, AnEmptyAgvDoesNotComeBackFromASource) {
  testing::DrawnMap drawn;
  for (double x_m : {0.0, 5.0, 10.0}) drawn.station(x_m, 0.0);
  drawn.station(5.0, 5.0, FP_STORAGE);
  drawn.segment(0, 1), drawn.segment(1, 2), drawn.segment(1, 3);
  drawn.permit(1, 3, FP_EMPTY_ONLY);
  drawn.permit(3, 1, FP_LOADED_ONLY);
  EXPECT_EQ(lanes_of(drawn), "bbbbp- bbbb-b") << "into the source, and out of it";
}

// A ring 0 to 5, one-way, with a lane for loads alone from 3 to 4: who passes 2 without a load has to pick one at 3.
TEST(DriveRules, NorFromTheLanesThatOnlyLeadThere) {
  testing::DrawnMap drawn;
  for (std::uint32_t i = 0; i < 6; ++i) drawn.station(i < 3 ? 5.0 * i : 25.0 - 5.0 * i, i < 3 ? 0.0 : 5.0, FP_STORAGE);
  for (std::uint32_t i = 0; i < 6; ++i) drawn.segment(i, (i + 1) % 6, false);
  drawn.segment(1, 5, false);  // so that AGVs without a load come back from 1
  drawn.permit(3, 4, FP_LOADED_ONLY);
  EXPECT_EQ(lanes_of(drawn), "bpp-bbb bbbbbbb") << "0-1, 1-2, 2-3, 3-4, 4-5, 5-0, 1-5";
}

}  // namespace
}  // namespace fleetproof::agents::drive_rules_test
