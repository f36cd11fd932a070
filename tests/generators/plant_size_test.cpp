#include "generators/map/plant_size.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>

#include "generators/formats/csv_layout.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/opentcs.hpp"
#include "generators/formats/rmf.hpp"
#include "generators/formats/smap.hpp"
#include "generators/formats/vehicles.hpp"
#include "generators/map/layout_check.hpp"

namespace fleetproof::plant_size_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Three stations in a row, 4 m and 2 m apart, times a factor.
Layout row(double factor, const Vec2& at_m = Vec2::Zero()) {
  Layout layout;
  layout.name = "row";
  layout.stations = {{"a", at_m, Purpose::Routing},
                     {"b", at_m + Vec2(4.0, 0.0) * factor, Purpose::Routing},
                     {"c", at_m + Vec2(4.0, 2.0) * factor, Purpose::Routing}};
  layout.segments = {{"ab", StationId{0U}, StationId{1U}, true}, {"bc", StationId{1U}, StationId{2U}, true}};
  fit_floor(layout, kFloorMargin_m);
  return layout;
}

TEST(PlantSize, ExtentAndLengthsAreTold) {
  EXPECT_EQ(size_text(size_of(row(1.0))), "4 m x 2 m; segments of 2 m to 4 m, half of them up to 2 m, 6 m in all");
}

TEST(PlantSize, APlantInAnotherUnitIsQuestioned) {
  EXPECT_EQ(size_question(size_of(row(1.0))), "");
  EXPECT_THAT(size_question(size_of(row(100.0))), HasSubstr("centimetres or millimetres?"));
  EXPECT_THAT(size_question(size_of(row(1000.0))), HasSubstr("centimetres or millimetres?"));
  EXPECT_THAT(size_question(size_of(row(0.01))), HasSubstr("metres where millimetres"));
  EXPECT_THAT(size_question(size_of(row(0.2))), HasSubstr("0.8 m x 0.4 m"));
}

// A plant is too large or too small by its extent, or by its segments alone.
TEST(PlantSize, ExtentAndSegmentsAreEachQuestioned) {
  const auto question = [](double extent_m, double median_m) {
    PlantSize size;
    size.extent_m = {extent_m, 1.0};
    size.median_m = median_m;
    return size_question(size);
  };
  EXPECT_EQ(question(4000.0, 80.0), "");
  EXPECT_THAT(question(6000.0, 5.0), HasSubstr("the plant is 6000 m x 1 m"));
  EXPECT_THAT(question(200.0, 120.0), HasSubstr("longer than 120 m"));
  EXPECT_EQ(question(4.0, 0.2), "");
  EXPECT_THAT(question(20.0, 0.05), HasSubstr("shorter than 0.05 m"));
  EXPECT_THAT(question(1.2, 0.6), HasSubstr("metres where millimetres"));
}

TEST(PlantSize, TheSpeedLimitOfTheWayBackIsQuestioned) {
  auto layout = row(1.0);
  layout.segments[0].speed_limit_mps = layout.segments[0].back_speed_limit_mps = 2.0;
  EXPECT_EQ(speed_question(layout), "");
  layout.segments[0].back_speed_limit_mps = 72.0;
  EXPECT_THAT(speed_question(layout), HasSubstr("the highest of 72 m/s at \"ab\""));
}

TEST(PlantSize, AFarPlantIsShiftedByWholeHundredsOfMetres) {
  std::vector<std::string> warnings;
  auto near = row(1.0);
  shift_far_plant(near, "f", warnings);
  EXPECT_THAT(warnings, IsEmpty());
  auto far = row(1.0, Vec2(500123.25, 5400321.5));
  far.segments[0].control_points_m = {Vec2(500124.0, 5400322.0), Vec2(500126.0, 5400322.0)};
  shift_far_plant(far, "f", warnings);
  EXPECT_EQ(far.stations[0].position_m, Vec2(23.25, 21.5));
  EXPECT_EQ(far.segments[0].control_points_m[0], Vec2(24.0, 22.0));
  EXPECT_THAT(warnings, ElementsAre(AllOf(HasSubstr("UTM"), HasSubstr("(-500100, -5400300) m"))));
  auto negative = row(1.0, Vec2(-200050.0, 0.0));
  shift_far_plant(negative, "f", warnings);
  EXPECT_EQ(negative.stations[0].position_m, Vec2(50.0, 0.0));
}

TEST(PlantSize, WhatIsTooLargeIsNotShifted) {
  std::vector<std::string> warnings;
  auto torn = row(1.0);
  torn.stations[2].position_m = Vec2(3e5, 0.0);
  shift_far_plant(torn, "f", warnings);
  EXPECT_EQ(torn.stations[2].position_m, Vec2(3e5, 0.0));
  EXPECT_THAT(warnings, IsEmpty());
}

// The stations themselves are near.
TEST(PlantSize, ACurveThatLeadsFarAwayShiftsThePlant) {
  std::vector<std::string> warnings;
  auto layout = row(1.0, Vec2(99'990.0, 0.0));
  shift_far_plant(layout, "f", warnings);
  EXPECT_EQ(layout.stations[0].position_m, Vec2(99'990.0, 0.0));
  layout.segments[0].control_points_m = {Vec2(99'992.0, 3.0), Vec2(100'030.0, 3.0)};
  shift_far_plant(layout, "f", warnings);
  EXPECT_EQ(layout.stations[0].position_m, Vec2(90.0, 0.0));
  EXPECT_EQ(layout.segments[0].control_points_m[1], Vec2(130.0, 3.0));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("UTM")));
}

// Two stations 4 m apart, in each format. Those of geojson: geojson_test.
TEST(PlantSize, ReadersShiftIt) {
  std::vector<std::string> warnings;
  const Layout layouts[] = {
      parse_csv_layout("id,x,y\na,500000,5400000\nb,500004,5400000\nfrom,to\na,b\n", "u", warnings),
      parse_lif(R"({"layouts": [{"layoutId": "l", "nodes": [
{"nodeId": "a", "nodePosition": {"x": 500000, "y": 5400000}, "vehicleTypeNodeProperties": []},
{"nodeId": "b", "nodePosition": {"x": 500004, "y": 5400000}, "vehicleTypeNodeProperties": []}],
"edges": [{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b", "vehicleTypeEdgeProperties": []}]}]})",
                "u", warnings),
      parse_opentcs(R"(<model version="6.0.0" name="m"><point name="a" positionX="500000000" positionY="5400000000"/>
<point name="b" positionX="500004000" positionY="5400000000"/>
<path name="ab" sourcePoint="a" destinationPoint="b" length="4000" maxVelocity="1000"/></model>)",
                    "u", warnings),
      parse_rmf("levels: {L1: {vertices: [[500000, 5400000, {}], [500004, 5400000, {}]], lanes: [[0, 1, {}]]}}\n", "u",
                warnings, {}),
      parse_smap(R"({"advancedPointList": [{"instanceName": "a", "pos": {"x": 500000, "y": 5400000}},
{"instanceName": "b", "pos": {"x": 500004, "y": 5400000}}], "advancedCurveList": [{"className": "StraightPath",
"startPos": {"instanceName": "a"}, "endPos": {"instanceName": "b"}}]})",
                 "u", warnings)};
  for (const Layout& layout : layouts) EXPECT_EQ(layout.stations[1].position_m, Vec2(4.0, 0.0)) << layout.name;
  EXPECT_EQ(std::ranges::count_if(
                warnings, [](const auto& w) { return w.starts_with("u: coordinates reach (500004, 5400000) m"); }),
            std::ssize(layouts));
}

TEST(VehicleQuestions, UnitsAreAskedFor) {
  EXPECT_THAT(vehicle_questions(VehicleType{}), IsEmpty());
  VehicleType type;
  type.drive.speed_mps = 72.0;
  type.footprint.length_m = 18.0;
  EXPECT_THAT(vehicle_questions(type), ElementsAre(HasSubstr("length_m is 18: is that in millimetres"),
                                                   HasSubstr("speed_mps is 72: is that in km/h")));
  VehicleType small;
  small.footprint.width_m = 0.008;
  small.turn.speed_radps = 45.0;
  EXPECT_THAT(vehicle_questions(small), ElementsAre(HasSubstr("width_m is 0.008"), HasSubstr("degrees/s")));
  VehicleType in_millimetres;
  in_millimetres.reverse_speed_mps = 300.0;
  in_millimetres.drive.acceleration_mps2 = 500.0;
  in_millimetres.drive.deceleration_mps2 = 800.0;
  EXPECT_THAT(vehicle_questions(in_millimetres),
              ElementsAre(HasSubstr("reverse_speed_mps is 300: "), HasSubstr("acceleration_mps2 is 500: "),
                          HasSubstr("deceleration_mps2 is 800: ")));
}

}  // namespace
}  // namespace fleetproof::plant_size_test
