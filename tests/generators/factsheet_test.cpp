// What the load sets of a factsheet say of the vehicle with a load. Expected numbers are computed by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "damage.hpp"
#include "generators/formats/factsheet.hpp"

namespace fleetproof::factsheet_test {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Imported {
  VehicleType type;
  std::string text, sentences;
};

// A body from -0.5 m to 1.5 m and 0.8 m wide, 2 m/s, 0.5 and 1 m/s2, with these load sets.
Imported with_loads(const std::string& sets) {
  std::vector<std::string> warnings;
  const auto vehicle = parse_factsheet(
      R"({"typeSpecification": {"seriesName": "H"}, "physicalParameters": {"speedMax": 2, "accelerationMax": 0.5,
      "decelerationMax": 1, "angularSpeedMax": 1, "length": 2, "width": 0.8}, "agvGeometry": {"envelopes2d": [
      {"polygonPoints": [{"x": -0.5, "y": -0.4}, {"x": 1.5, "y": -0.4}, {"x": 1.5, "y": 0.4}, {"x": -0.5, "y": 0.4}]}]},
      "loadSpecification": {"loadSets": )" +
          sets + "}}",
      "f.json", warnings);
  return {vehicle.type, fleet_text({vehicle}, "f.json"), fmt::format("{}", fmt::join(warnings, "\n"))};
}

TEST(FactsheetLoads, HeightsAreToldAsLeftOut) {
  EXPECT_THAT(with_loads(R"([{"boundingBoxReference": {"x": 0.5, "y": 0, "z": 1},
    "loadDimensions": {"length": 2, "width": 0.5, "height": 1}}])")
                  .sentences,
              HasSubstr("2 kinds of details of load sets are left out (\"loadDimensions.height\", "
                        "\"boundingBoxReference.z\")"));
}

TEST(FactsheetLoads, ALoadMakesTheBodyLargerAndTheDriveSlower) {
  const auto loaded = with_loads(R"([{"setName": "pallet", "boundingBoxReference": {"x": 0.5, "y": 0},
    "loadDimensions": {"length": 2.4, "width": 1.0}, "agvSpeedLimit": 1.5, "agvAccelerationLimit": 0.4,
    "agvDecelerationLimit": 0.8, "pickTime": 7, "dropTime": 6.5}])");
  EXPECT_NEAR(loaded.type.loaded.extra_length_m, 0.4, 1e-9);
  EXPECT_NEAR(loaded.type.loaded.extra_width_m, 0.2, 1e-9);
  EXPECT_DOUBLE_EQ(loaded.type.loaded.speed_share, 0.75);
  EXPECT_DOUBLE_EQ(loaded.type.loaded.acceleration_share, 0.8);
  EXPECT_EQ(loaded.type.pick_s, 7.0);
  EXPECT_EQ(loaded.type.drop_s, 6.5);
  for (const char* field : {"loaded_speed_share = 0.75\n", "loaded_extra_width_m = 0.", "pick_s = 7\n"})
    EXPECT_THAT(loaded.text, HasSubstr(field));
  EXPECT_EQ(loaded.sentences, "") << "all of it is modelled";
}

TEST(FactsheetLoads, ALoadWithinTheBodyChangesNothing) {
  const auto loaded = with_loads(R"([{"boundingBoxReference": {"x": 0.6, "y": 0.1}, "loadDimensions": {"length": 1,
    "width": 0.6}, "agvSpeedLimit": 3}])");
  EXPECT_EQ(loaded.type.loaded, LoadEffect{});
  EXPECT_THAT(loaded.text, Not(HasSubstr("loaded_")));
}

// From -0.9 m to 1.1 m: 1.4 m behind the middle of the body at 0.5 m, so that 2.8 m cover both sides.
TEST(FactsheetLoads, ALoadThatReachesOutOnOneSideMakesTheBodyLongerOnBoth) {
  const auto loaded = with_loads(R"([{"setName": "long", "boundingBoxReference": {"x": 0.1, "y": 0.2},
    "loadDimensions": {"length": 2, "width": 0.8}}])");
  EXPECT_NEAR(loaded.type.loaded.extra_length_m, 0.8, 1e-9);
  EXPECT_NEAR(loaded.type.loaded.extra_width_m, 0.4, 1e-9);
  EXPECT_THAT(loaded.sentences, HasSubstr("1 load sets have a load that reaches farther out on one side (\"long\")"));
}

TEST(FactsheetLoads, ATurnedLoadLiesAcross) {
  const auto across = with_loads(R"([{"boundingBoxReference": {"x": 0.5, "y": 0, "theta": -1.5708},
    "loadDimensions": {"length": 1.2, "width": 0.8}}])");
  EXPECT_EQ(across.type.loaded.extra_length_m, 0.0);
  EXPECT_NEAR(across.type.loaded.extra_width_m, 0.4, 1e-9);
  EXPECT_EQ(across.sentences, "");
  const auto askew = with_loads(R"([{"setName": "a", "boundingBoxReference": {"x": 0.5, "y": 0, "theta": 0.5},
    "loadDimensions": {"length": 1.2, "width": 0.9}}])");
  EXPECT_NEAR(askew.type.loaded.extra_width_m, 1.5 - 0.8, 1e-9) << "a diagonal of 1.5 m";
  EXPECT_THAT(askew.sentences, HasSubstr("1 load sets have a load that lies askew (\"a\")"));
}

TEST(FactsheetLoads, OfSeveralTheLargestAndTheSlowestCount) {
  const auto loaded = with_loads(R"([{"setName": "a", "loadDimensions": {"length": 2.2, "width": 0.5},
    "maximumSpeed": 1.2, "maximumDeceleration": 0.5, "pickTime": 9}, {"setName": "b", "loadDimensions": {"length": 1,
    "width": 1.1}, "maximumSpeed": 1.6, "pickTime": 8}])");
  EXPECT_NEAR(loaded.type.loaded.extra_length_m, 0.2, 1e-9);
  EXPECT_NEAR(loaded.type.loaded.extra_width_m, 0.3, 1e-9);
  EXPECT_DOUBLE_EQ(loaded.type.loaded.speed_share, 0.6);
  EXPECT_DOUBLE_EQ(loaded.type.loaded.acceleration_share, 0.5);
  EXPECT_EQ(loaded.type.pick_s, 8.0);
  for (const char* sentence :
       {"the 2 load sets become one", "2 load sets do not say where the load lies (\"a\", \"b\")",
        "acceleration and braking with a load differ in their shares; the lower share counts for both"})
    EXPECT_THAT(loaded.sentences, HasSubstr(sentence));
}

TEST(FactsheetLoads, WhatIsNotModelledIsNamed) {
  const auto loaded = with_loads(R"([{"setName": "a", "loadType": "EPAL", "maxWeight": 900, "minLoadhandlingTilt": 0,
    "agvSpeedLimit": 0.02}], "loadPositions": ["fork"])");
  EXPECT_EQ(loaded.type.loaded.speed_share, 0.1);
  for (const char* sentence : {"1 load sets have no dimensions (\"a\")", "1 load sets have a largest weight (\"a\")",
                               "2 kinds of details of load sets are left out (\"loadType\", \"minLoadhandlingTilt\")",
                               "loaded_speed_share would be 0.01; it is 0.1, the least that is modelled",
                               "1 parts of the factsheet are left out (\"loadSpecification.loadPositions\")"})
    EXPECT_THAT(loaded.sentences, HasSubstr(sentence));
}

TEST(FactsheetLoads, AreRefusedWithPlaceValueAndRemedy) {
  const auto refused = [](const std::string& sets) { return independent::refusal(with_loads, sets); };
  const auto at = [](const std::string& where) { return "/loadSpecification/loadSets" + where; };
  EXPECT_THAT(refused("3"), HasSubstr(at("")));
  EXPECT_THAT(refused("[3]"), HasSubstr("f.json:4: " + at("/0: 3 is refused: expected an object {...}")));
  EXPECT_THAT(refused(R"([{"setName": 7}])"), HasSubstr(at("/0/setName")));
  EXPECT_THAT(refused(R"([{"maxWeight": -1}])"), HasSubstr("-1 is refused: expected 0 to 1e+09"));
  EXPECT_THAT(refused(R"([{"agvSpeedLimit": 0}])"), HasSubstr("0 is refused: expected 0.001 to 100"));
  EXPECT_THAT(refused(R"([{"agvSpeedLimit": "fast"}])"), HasSubstr(at("/0/agvSpeedLimit")));
  EXPECT_THAT(refused(R"([{"agvSpeedLimit": 1, "maximumSpeed": 1}])"),
              HasSubstr("agvSpeedLimit is there, too; remove one of them"));
  EXPECT_THAT(refused(R"([{"pickTime": 1e9}])"), HasSubstr("expected 0 to 3600"));
  EXPECT_THAT(refused(R"([{"loadDimensions": {"length": 1}}])"), HasSubstr("width"));
  EXPECT_THAT(refused(R"([{"loadDimensions": {"length": 1e308, "width": 1}}])"), HasSubstr("expected 0.001 to 100"));
  EXPECT_THAT(refused(R"([{"loadDimensions": {"length": 1, "width": 1}, "boundingBoxReference": {"x": 101, "y": 0}}])"),
              HasSubstr("101 is refused: expected -100 to 100"));
  EXPECT_THAT(refused(R"([{"loadDimensions": {"length": 99, "width": 1}, "boundingBoxReference": {"x": 9, "y": 0}}])"),
              HasSubstr("the body with its load is 116 m; expected at most 100 m"));
}

}  // namespace
}  // namespace fleetproof::factsheet_test
