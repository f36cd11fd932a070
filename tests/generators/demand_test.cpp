// Who orders what: hot spots, and orders that a user lists.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "core/base/error.hpp"
#include "damage.hpp"
#include "generators/map/reachability.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "generators/worlds/order_list.hpp"
#include "generators/worlds/transports.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::demand_test {
namespace {

using testing::HasSubstr;

// A ring of storage stations, then one to park and one to charge.
std::shared_ptr<const LogicalMap> ring(std::size_t storage) {
  Layout layout;
  layout.name = "ring";
  for (std::size_t i = 0; i < storage; ++i)
    layout.stations.push_back({"S" + std::to_string(i), {4.0 * static_cast<double>(i), 0.0}, Purpose::Storage});
  layout.stations.push_back({"park", {0.0, 8.0}, Purpose::Parking});
  layout.stations.push_back({"charge", {8.0, 8.0}, Purpose::Charging});
  for (std::size_t i = 0; i + 1 < layout.stations.size(); ++i) {
    layout.segments.push_back({"e" + std::to_string(i), StationId{i}, StationId{i + 1}, true, {}});
  }
  return std::make_shared<const LogicalMap>(layout);
}

std::map<std::uint32_t, double> shares(double skew, bool of_from) {
  WorldSpec spec;
  spec.layout = ring(8);
  spec.fleet_size = 1;
  spec.demand.hot_spot_skew = skew;
  spec.demand.transports_per_agv_hour = 3600.0;
  spec.horizon = std::chrono::hours(20);
  RejectionCounts counts;
  const Scenario s = generate_world(spec, 7, counts);
  std::map<std::uint32_t, double> found;
  for (const auto& t : s.agvs[0].transports)
    found[(of_from ? t.from : t.to).value] += 1.0 / static_cast<double>(s.agvs[0].transports.size());
  return found;
}

std::vector<double> largest_first(const std::map<std::uint32_t, double>& shares) {
  std::vector<double> sorted;
  for (const auto& [station, share] : shares) sorted.push_back(share);
  std::ranges::sort(sorted, std::greater<>());
  return sorted;
}

TEST(HotSpots, FollowZipfsLaw) {
  const double skew = 1.0;
  double sum = 0.0;
  for (int n = 1; n <= 8; ++n) sum += std::pow(n, -skew);
  const auto from = largest_first(shares(skew, true));
  ASSERT_EQ(from.size(), 8U);
  // 72 000 draws: a share of 0.37 has a standard deviation of 0.002.
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(from[i], std::pow(static_cast<double>(i + 1), -skew) / sum, 0.01) << i;
}

TEST(HotSpots, TheOtherEndIsDrawnFromTheRestByItsShare) {
  std::vector<double> weights, expected(8, 0.0);
  double sum = 0.0;
  for (int n = 1; n <= 8; ++n) weights.push_back(std::pow(n, -1.2));
  for (const double w : weights) sum += w;
  for (std::size_t to = 0; to < 8; ++to) {
    for (std::size_t from = 0; from < 8; ++from) {
      if (from != to) expected[to] += weights[from] / sum * weights[to] / (sum - weights[from]);
    }
  }
  const auto to = largest_first(shares(1.2, false));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(to[i], expected[i], 0.01) << i;
}

TEST(HotSpots, WithoutSkewTheDrawsAreThoseOfOld) {
  for (const auto& [station, share] : shares(0.0, true)) EXPECT_NEAR(share, 0.125, 0.01);
}

TEST(HotSpots, SpreadsStayInRange) {
  WorldSpec spec;
  RejectionCounts counts;
  spec.demand.hot_spot_skew = -0.1;
  EXPECT_THROW(generate_world(spec, 1, counts), InputError);
  spec.demand.hot_spot_skew = 4.1;
  EXPECT_THROW(generate_world(spec, 1, counts), InputError);
}

TEST(OrderEnds, AreNeverStationsForChargingOrParking) {
  Layout layout = ring(2)->layout();
  for (const auto& [purposes, expected] :
       {std::pair{Purpose::Storage, 2U}, {Purpose::Routing, 2U}, {Purpose::Parking, 4U}}) {
    layout.stations[0].purposes = layout.stations[1].purposes = purposes;
    const LogicalMap map(layout);
    const OrderEnds ends = order_ends(map, Reachability(map));
    EXPECT_EQ(ends.picks.size(), expected);
    EXPECT_EQ(ends.drops, ends.picks);
  }
}

Scenario with_orders(const std::string& text, std::uint32_t fleet = 2) {
  WorldSpec spec;
  spec.layout = ring(6);
  spec.fleet_size = fleet;
  spec.orders = std::make_shared<const OrderList>(parse_order_list(text, "plans/orders.csv"));
  RejectionCounts counts;
  return generate_world(spec, 3, counts);
}

TEST(ListedOrders, GoToTheNamedAgvOrRound) {
  const Scenario s = with_orders(
      "release_s,from,to,agv\n"
      "# in the morning\n"
      "20,S0,S1,\n"
      "5.5,S1,S2,\n"
      "30,S2,S3,1\n"
      "10,S3,S4,\n"
      "9999,S3,S4,\n");
  const auto told = [&](std::size_t agv) {
    std::string text;
    for (const auto& t : s.agvs[agv].transports)
      text += s.map->station(t.from).name + ">" + s.map->station(t.to).name + "@" +
              std::to_string(t.release.count() / 1'000'000) + " ";
    return text;
  };
  EXPECT_EQ(told(0), "S3>S4@10000 S0>S1@20000 ");
  EXPECT_EQ(told(1), "S1>S2@5500 S2>S3@30000 ") << "the fourth without an AGV falls to AGV 1, after the horizon";
  EXPECT_EQ(to_text(parse_scenario(to_text(s), "text")), to_text(s));
}

std::string refusal(const std::string& text) {
  try {
    with_orders(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ListedOrders, ErrorsNameFileLineAndField) {
  const std::string head = "release_s,from,to,agv\n";
  EXPECT_EQ(refusal(head + "1,S0,S1,0\n"), "accepted");
  EXPECT_EQ(refusal("release_s,from,to\n1,S0,S1\n"), "accepted");
  EXPECT_THAT(refusal(""), HasSubstr("orders.csv: has no orders"));
  EXPECT_THAT(refusal("release,from,to\n"), HasSubstr("orders.csv:1: \"release\" is not a column of orders"));
  EXPECT_THAT(refusal("release_s,form,to\n"), HasSubstr("did you mean \"from\"?"));
  EXPECT_THAT(refusal("release_s,from\n"), HasSubstr("orders.csv:1: column to is missing"));
  EXPECT_THAT(refusal("from,from,to\n"), HasSubstr("column \"from\" occurs twice"));
  EXPECT_THAT(refusal(head + "soon,S0,S1,0\n"), HasSubstr("orders.csv:2: release_s is \"soon\""));
  EXPECT_THAT(refusal(head + "-1,S0,S1,0\n"), HasSubstr("orders.csv:2: release_s is \"-1\""));
  EXPECT_THAT(refusal(head + "\n1,S0,,0\n"), HasSubstr("orders.csv:3: to is empty"));
  EXPECT_THAT(refusal(head + "1,S0,S0,0\n"), HasSubstr("orders.csv:2: to is \"S0\", where the order comes from"));
  EXPECT_THAT(refusal(head + "1,S0,S1,x\n"), HasSubstr("orders.csv:2: agv is \"x\""));
  EXPECT_THAT(refusal(head + "1,S0,S1,0,7\n"), HasSubstr("orders.csv:2: the line has 5 fields"));
  EXPECT_THAT(refusal(head + "1,S0,S1,2\n"), HasSubstr("orders.csv:2: agv is 2; a fleet of 2 has AGVs 0 to 1"));
  EXPECT_THAT(refusal(head + "1,S0,s1,0\n"),
              HasSubstr("orders.csv:2: to is \"s1\", but layout \"ring\" has no such station; did you mean \"S1\"?"));
  EXPECT_THAT(refusal(head + "1,S0,charge,0\n"),
              HasSubstr("orders.csv:2: to is \"charge\", a station for charging or parking"));
  EXPECT_THAT(refusal(head + "1,park,S1,0\n"),
              HasSubstr("orders.csv:2: from is \"park\", a station for charging or parking"));
  EXPECT_THAT(refusal(head + "1,S0,caf\xe9,0\n"), HasSubstr("orders.csv:2: to is \"caf\\xe9\"; a name is UTF-8"));
  EXPECT_THAT(refusal(head + "1,\"S0,S1,0\n"), HasSubstr("orders.csv:2: a double quote is not closed"));
}

TEST(ListedOrders, BearDamage) {
  const std::string text = "release_s,from,to,agv\n20,S0,S1,\n5.5,S1,\"S2\",1\n# remark\n30,S2,S3,0\n";
  const auto take = [](const std::string& damaged) { with_orders(damaged); };
  independent::bear_cuts(take, text, 100);
  independent::bear_damage(take, text, 2000, "0123456789-.,\"# \n\r\x80\xff");
}

TEST(ListedOrders, NeedALayoutThatStaysAndNoPairs) {
  WorldSpec spec;
  spec.orders = std::make_shared<const OrderList>(parse_order_list("release_s,from,to\n1,S0,S1\n", "o.csv"));
  RejectionCounts counts;
  EXPECT_THROW(generate_world(spec, 1, counts), InputError);
  spec.layout = ring(6);
  spec.placement = Placement::Adversarial;
  EXPECT_THROW(generate_world(spec, 1, counts), InputError);
  spec.placement = Placement::ChargerBank;
  EXPECT_NO_THROW(generate_world(spec, 1, counts));
}

}  // namespace
}  // namespace fleetproof::demand_test
