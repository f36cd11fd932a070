#include "core/bridges/vda5050/vehicle_profile.hpp"

#include <gmock/gmock.h>

#include "tests/bridges/vda5050_bench.hpp"

namespace fleetproof::vda5050_profile_test {
namespace {

using namespace bridges::vda5050;
using testing::ElementsAre;

constexpr fp_agv kFork{2.4, 1.0, 2.0, 0.5, 1.0, 1.0, 1.0, 1.0, 3.0, 1.2, 0.0, 0.8, 0.0, 0};

TEST(Vda5050Profile, TheFactsheetKeepsTheRulesAndSaysWhatTheVehicleTypeIs) {
  Factsheet sheet = factsheet_of(kFork, "fork");
  for (const Version& version : versions()) {
    sheet.header = {1, "2026-01-01T00:00:00.00Z", std::string(version.number), "fleetproof", "agv0"};
    EXPECT_THAT(test::broken_rules(write_document(sheet, version), "factsheet", version.number), ElementsAre())
        << version.number;
  }
  EXPECT_EQ(sheet.type_specification.series_name, "fork");
  EXPECT_EQ(sheet.physical_parameters.speed_max, 2.0);
  EXPECT_EQ(sheet.physical_parameters.length, 2.4);
}

TEST(Vda5050Profile, EnvelopesAreClosedAndSurroundTheBody) {
  const auto envelopes = factsheet_of(kFork, "fork").agv_geometry.envelopes2d.value();
  ASSERT_EQ(envelopes.size(), 2U);
  for (const Envelope& envelope : envelopes) {
    const auto& points = envelope.polygon_points;
    ASSERT_EQ(points.size(), 5U);
    EXPECT_EQ(std::pair(points.front().x, points.front().y), std::pair(points.back().x, points.back().y));
    EXPECT_NEAR(points[0].x + points[1].x, 2.0 * kFork.centre_ahead_m, 1e-12) << "around its reference point";
  }
  EXPECT_NEAR(envelopes[1].polygon_points[0].x - envelopes[1].polygon_points[1].x, 3.0, 1e-12) << "loaded";
}

// pick, drop and startCharging are the words of the standard, with its parameter loadId.
TEST(Vda5050Profile, PredefinedActionsAreUsedWithTheirParameters) {
  const Abilities abilities = vehicle_abilities();
  for (const char* word : {"pick", "drop"}) {
    ASSERT_NE(abilities.find(word), nullptr) << word;
    EXPECT_THAT(abilities.find(word)->needed_parameters, ElementsAre("loadId"));
    EXPECT_TRUE(refuse_unable(test::vda5050::action(word, "a", BlockingType::Hard), ActionScope::Node, abilities));
    EXPECT_FALSE(refuse_unable(test::vda5050::action(word, "a", BlockingType::Hard, {{{"loadId", "7", true}}}),
                               ActionScope::Node, abilities));
  }
  EXPECT_FALSE(
      refuse_unable(test::vda5050::action("startCharging", "a", BlockingType::Hard), ActionScope::Node, abilities));
}

// An edge that its map lacks would never be driven: the order is refused.
TEST(Vda5050Profile, AnOrderOverAnUnknownEdgeIsRefused) {
  VehicleSettings settings;
  settings.identity = {&versions().back(), "fp", "agv1", 0};
  settings.knows_edge = [](const Edge& edge) { return edge.edge_id == "ab"; };
  VehicleProtocol vehicle(settings, {});
  vehicle.hear(ConnectionOpened{});
  vehicle.hear(StandsAt{"a"});
  const auto send = [&](const std::string& way) {
    vehicle.order_received(
        write_document(test::vda5050::order("o", 0, test::vda5050::way(way), way.size()), versions().back()));
    return vehicle.state();
  };
  const State refused = send("abc");
  ASSERT_EQ(refused.errors.size(), 1U);
  EXPECT_EQ(refused.errors.front().error_type, "orderError");
  EXPECT_THAT(refused.errors.front().error_references, testing::Contains(Reference{"edgeId", "bc"}));
  EXPECT_TRUE(refused.node_states.empty());
  EXPECT_EQ(send("ab").node_states.size(), 1U);
}

}  // namespace
}  // namespace fleetproof::vda5050_profile_test
