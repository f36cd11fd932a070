#include "generators/map/plant_size.hpp"

#include <gmock/gmock.h>

#include "generators/formats/csv_layout.hpp"
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

TEST(PlantSize, ReadersShiftIt) {
  std::vector<std::string> warnings;
  const auto layout = parse_csv_layout("id,x,y\na,500000,5400000\nb,500004,5400000\nfrom,to\na,b\n", "u.csv", warnings);
  EXPECT_EQ(layout.stations[1].position_m, Vec2(4.0, 0.0));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("u.csv: coordinates reach (500004, 5400000) m")));
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
}

}  // namespace
}  // namespace fleetproof::plant_size_test
