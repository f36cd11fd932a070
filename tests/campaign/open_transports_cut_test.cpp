// Scenarios with open transports of which something is taken out, or moved in time.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "campaign/shrink/number_edits.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/surgery.hpp"
#include "tests/core/row_of_tens.hpp"

namespace fleetproof::open_transports_cut_test {
namespace {

// Two AGVs, the first with a transport of its own; three open transports, with a fault at the third.
Scenario with_open_orders() {
  Scenario scenario = test::row_of_tens({0, 3});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(1.0)}};
  for (const double release_s : {2.0, 3.0, 4.0})
    scenario.open_orders.push_back({StationId{2U}, StationId{3U}, seconds(release_s)});
  scenario.open_orders[2].withdrawn = seconds(9.0);
  Fault fall = test::fault(Fault::Kind::LoadDrop, 1.0, 5.0);
  fall.agv = {};
  fall.transport = 2;
  scenario.faults = {fall};
  return scenario;
}

std::vector<double> releases(const Scenario& scenario) {
  std::vector<double> found;
  for (const TransportOrder& order : scenario.open_orders) found.push_back(to_seconds(order.release));
  return found;
}

TEST(OpenTransportsCut, ATransportThatGoesTakesItsFaultWithIt) {
  const Scenario scenario = with_open_orders();
  const Scenario less = with_transports(scenario, [](std::size_t i) { return i != 1; });  // the first open one
  EXPECT_EQ(releases(less), (std::vector<double>{3.0, 4.0}));
  ASSERT_EQ(less.faults.size(), 1U);
  EXPECT_EQ(less.faults[0].transport, 1U) << "the number of its transport now";
  EXPECT_TRUE(with_transports(scenario, [](std::size_t i) { return i != 3; }).faults.empty());
  EXPECT_TRUE(with_transports(scenario, [](std::size_t i) { return i != 0; }).agvs[0].transports.empty());
}

TEST(OpenTransportsCut, AnAgvThatGoesTakesNoOpenTransport) {
  const Scenario less = with_agvs(with_open_orders(), [](std::size_t i) { return i != 0; });
  EXPECT_EQ(less.open_orders.size(), 3U);
  ASSERT_EQ(less.faults.size(), 1U);
  EXPECT_FALSE(less.faults[0].agv.valid());
}

TEST(OpenTransportsCut, TheirStationsStay) {
  const Scenario less = with_segments(with_open_orders(), [](std::size_t) { return false; });
  ASSERT_EQ(less.map->station_count(), 4U);
  EXPECT_EQ(less.open_orders[0].from, StationId{2U});
  Scenario without = with_open_orders();
  without.open_orders.clear();
  EXPECT_EQ(with_segments(without, [](std::size_t) { return false; }).map->station_count(), 3U);
}

TEST(OpenTransportsCut, EarlierOnesAreWithdrawnEarlier) {
  const Scenario earlier = earlier_by(with_open_orders(), seconds(1.0));
  EXPECT_EQ(releases(earlier), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(earlier.open_orders[2].withdrawn, seconds(8.0));
  EXPECT_EQ(earlier.open_orders[0].withdrawn, kLongestDuration);
  EXPECT_EQ(earliest_instant(with_open_orders()), seconds(1.0));
}

TEST(OpenTransportsCut, AWithdrawalMayGo) {
  std::size_t gone = 0;
  for (const NumberEdit& edit : number_edits(with_open_orders())) {
    Scenario edited = with_open_orders();
    edit.apply(edited);
    gone += edited.open_orders[2].withdrawn == kLongestDuration ? 1 : 0;
  }
  EXPECT_EQ(gone, 1U);
}

TEST(OpenTransportsCut, InAnotherTimelineTheyShiftTogether) {
  const Scenario other = with_other_timeline(with_open_orders(), 7, seconds(60.0));
  const auto found = releases(other);
  EXPECT_GT(found[0], 2.0);
  EXPECT_NEAR(found[1] - found[0], 1.0, 1e-9);
  EXPECT_NEAR(to_seconds(other.open_orders[2].withdrawn) - found[2], 5.0, 1e-9);
}

}  // namespace
}  // namespace fleetproof::open_transports_cut_test
