#include "generators/formats/smap.hpp"

#include <gmock/gmock.h>

#include "damage.hpp"
#include "real_layout.hpp"

namespace fleetproof::smap_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// Zeros are left out, as in every file of this kind.
const std::string kMap = R"({"header": {"mapName": "hall", "resolution": 0.02},
"normalPosList": [{"x": 1.0}, {}],
"advancedPointList": [
{"className": "LocationMark", "instanceName": "LM1", "pos": {}, "ignoreDir": true},
{"className": "LocationMark", "instanceName": "LM2", "pos": {"x": 4.0},
 "property": [{"key": "spin", "boolValue": false}, {"key": "allowrotate", "type": "bool", "value": "ZmFsc2U="}]},
{"className": "ActionPoint", "instanceName": "AP3", "pos": {"x": 8.0}},
{"className": "ChargePoint", "instanceName": "CP4", "pos": {"x": 8.0, "y": 3.0}, "dir": 1.5708, "ignoreDir": true},
{"className": "ParkPoint", "instanceName": "PP5", "pos": {"x": 4.0, "y": 6.0}, "dir": 2.0}],
"advancedCurveList": [
{"className": "StraightPath", "instanceName": "LM1-LM2", "startPos": {"instanceName": "LM1", "pos": {}},
 "endPos": {"instanceName": "LM2", "pos": {"x": 4.0}}, "property": [{"key": "direction", "int32Value": 0}]},
{"className": "StraightPath", "instanceName": "LM1-LM2", "startPos": {"instanceName": "LM2"},
 "endPos": {"instanceName": "LM1"}, "property": [{"key": "direction", "type": "int", "value": "MQ=="}]},
{"className": "DegenerateBezier", "instanceName": "LM2-AP3", "startPos": {"instanceName": "LM2"},
 "endPos": {"instanceName": "AP3"}, "controlPos1": {"x": 5.0, "y": 1.0}, "controlPos2": {"x": 7.0},
 "property": [{"key": "maxspeed", "doubleValue": 0.3}, {"key": "obsStopDist", "doubleValue": 0.2}]},
{"className": "StraightPath", "instanceName": "AP3-CP4", "startPos": {"instanceName": "AP3"},
 "endPos": {"instanceName": "CP4"}},
{"className": "BezierPath", "instanceName": "CP4-PP5", "startPos": {"instanceName": "CP4"},
 "endPos": {"instanceName": "PP5"}, "controlPos1": {"x": 8.0, "y": 5.0}, "controlPos2": {"x": 6.0, "y": 6.0}}]})";

struct Import {
  Layout layout;
  std::vector<std::string> warnings;
};

Import import(const std::string& text, const ReadChoice& choice = {}) {
  Import result;
  result.layout = parse_smap(text, "m.smap", result.warnings, choice);
  return result;
}

std::string refusal(const std::string& text) {
  return independent::refusal([](const std::string& t) { import(t); }, text);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(Smap, PointsAndCurvesAreRead) {
  const auto [layout, warnings] = import(kMap);
  EXPECT_EQ(layout.name, "hall");
  ASSERT_EQ(layout.stations.size(), 5U);
  EXPECT_EQ(layout.stations[0].position_m, Vec2(0.0, 0.0)) << "zeros are left out";
  EXPECT_EQ(layout.stations[3].position_m, Vec2(8.0, 3.0));
  EXPECT_EQ(layout.stations[0].purposes, Purposes(Purpose::Routing));
  EXPECT_TRUE(layout.stations[2].purposes.has(Purpose::Storage));
  EXPECT_TRUE(layout.stations[3].purposes.has(Purpose::Charging));
  EXPECT_TRUE(layout.stations[4].purposes.has(Purpose::Parking));
  ASSERT_EQ(layout.segments.size(), 4U) << "there and back on one track are one";
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(layout.segments[0].back_travel, Travel::Backward);
  EXPECT_EQ(layout.segments[1].control_points_m, (std::vector<Vec2>{{5.0, 1.0}, {7.0, 0.0}}));
  EXPECT_EQ(layout.segments[1].speed_limit_mps, 0.3);
  EXPECT_TRUE(layout.segments[2].control_points_m.empty());
  EXPECT_EQ(layout.segments[3].control_points_m.size(), 2U);
  EXPECT_THAT(warnings, Contains(HasSubstr("1 parts of the map are left out (\"normalPosList\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("details of curves are left out (\"obsStopDist\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("details of points are left out (\"spin\")")));
  EXPECT_THAT(warnings, Contains(AllOf(HasSubstr("1 curves of the class DegenerateBezier"), HasSubstr("0.125 m"))));
  EXPECT_THAT(warnings, Contains(HasSubstr("1 curves have the name of another curve; they are called \"LM2-LM1\"")));
}

TEST(Smap, HeadingsHoldWhereSomethingIsDone) {
  const auto [layout, warnings] = import(kMap);
  EXPECT_FALSE(layout.stations[1].heading) << "AGVs only pass";
  EXPECT_FALSE(layout.stations[3].heading) << "ignored";
  EXPECT_FALSE(layout.stations[4].heading) << "no curve arrives so";
  EXPECT_THAT(warnings, Contains(HasSubstr("heading with which no curve arrives (\"PP5\")")));
  EXPECT_EQ(layout.stations[2].heading, Vec2(1.0, 0.0)) << "an angle that is left out is 0";
  const auto askew =
      import(replaced(kMap, "\"controlPos2\": {\"x\": 7.0}", "\"controlPos2\": {\"x\": 7.0, \"y\": 0.5}"));
  EXPECT_FALSE(askew.layout.stations[2].heading) << "the curve arrives with another one";
}

TEST(Smap, AGVsDoNotTurnWhereTheyMayNot) {
  const auto layout = import(kMap).layout;
  EXPECT_TRUE(layout.stations[0].turning);
  EXPECT_FALSE(layout.stations[1].turning) << "the value is encoded";
}

TEST(Smap, ClassesAreTakenByTheWordsOfTheUser) {
  const auto unknown = replaced(kMap, "\"ActionPoint\"", "\"WorkCell\"");
  EXPECT_THAT(import(unknown).warnings, Contains(HasSubstr("1 classes of points say nothing that is known here "
                                                           "(\"WorkCell\")")));
  ReadChoice choice;
  choice.purposes = purpose_words_of("WorkCell=storage,LM1=parking", "--purposes");
  const auto layout = import(unknown, choice).layout;
  EXPECT_TRUE(layout.stations[2].purposes.has(Purpose::Storage));
  EXPECT_TRUE(layout.stations[0].purposes.has(Purpose::Parking));
}

TEST(Smap, PointsOfBinsAreForStorage) {
  const auto text = replaced(kMap, "\"advancedCurveList\"",
                             R"("binLocationsList": [{"binLocationList": [{"instanceName": "b1", "pointName": "LM2"},
                                {"instanceName": "b2", "pointName": "LM9"}]}], "advancedCurveList")");
  const auto [layout, warnings] = import(text);
  EXPECT_TRUE(layout.stations[1].purposes.has(Purpose::Storage));
  EXPECT_THAT(warnings, Contains(HasSubstr("1 bins stand at no point of the map (\"b2\")")));
}

TEST(Smap, OtherShapesAreTold) {
  EXPECT_THAT(import(replaced(kMap, "\"BezierPath\"", "\"SpiralPath\"")).warnings,
              Contains(HasSubstr("1 classes of curves are unknown here (\"SpiralPath\")")));
  const auto nurbs = import(replaced(
      replaced(kMap, "\"BezierPath\"", "\"NURBS6\""), "\"controlPos2\": {\"x\": 6.0, \"y\": 6.0}",
      R"("controlPos2": {"x": 7.5, "y": 5.5}, "controlPos3": {"x": 6, "y": 6}, "controlPos4": {"x": 5, "y": 6})"));
  EXPECT_GT(nurbs.layout.segments[3].control_points_m.size(), 2U);
  EXPECT_THAT(nurbs.warnings, Contains(HasSubstr("1 curves of the class NURBS6 (\"CP4-PP5\")")));
  EXPECT_THAT(import(replaced(kMap, "\"direction\", \"int32Value\": 0", "\"direction\", \"int32Value\": 2")).warnings,
              Contains(HasSubstr("direction other than 0 or 1 (\"LM1-LM2\")")));
}

TEST(Smap, CurvesThatEndBesideTheirPointsAreTold) {
  EXPECT_THAT(import(kMap).warnings, Not(Contains(HasSubstr("beside their points"))));
  for (const std::string place : {"\"LM1\", \"pos\": {}}", "\"LM2\", \"pos\": {\"x\": 4.0}}"}) {
    const auto beside = place.substr(0, 5) + ", \"pos\": {\"x\": 2.0}}";
    EXPECT_THAT(import(replaced(kMap, "{\"instanceName\": " + place, "{\"instanceName\": " + beside)).warnings,
                Contains(HasSubstr("1 curves begin or end beside their points (\"LM1-LM2\"), by up to 2.000 m")));
  }
}

TEST(Smap, FaultsAreRefusedAtTheirLine) {
  EXPECT_THAT(refusal("{}"), HasSubstr("has no \"advancedPointList\""));
  EXPECT_THAT(
      refusal(replaced(kMap, "\"endPos\": {\"instanceName\": \"PP5\"}", "\"endPos\": {\"instanceName\": \"PP6\"}")),
      AllOf(HasSubstr("m.smap:21"), HasSubstr("there is no such point; did you mean \"PP5\"?")));
  EXPECT_THAT(refusal(replaced(kMap, "\"LM2\", \"pos\"", "\"LM1\", \"pos\"")), HasSubstr("this name is taken already"));
  EXPECT_THAT(refusal(replaced(kMap, "\"controlPos1\": {\"x\": 8.0, \"y\": 5.0}, ", "")),
              HasSubstr("has not two control points"));
  EXPECT_THAT(refusal(replaced(kMap, "{\"x\": 8.0, \"y\": 3.0}", "{\"x\": 8.0}")), HasSubstr("it has no length"));
  const auto without = kMap.substr(0, kMap.find("\"advancedCurveList\"")) + "\"advancedCurveList\": []}";
  EXPECT_THAT(refusal(without), HasSubstr("no curve that an AGV can drive"));
}

TEST(Smap, CutAndDamagedFilesAreRefusedOrRead) {
  const auto parse = [](const std::string& text) { import(text); };
  independent::bear_cuts(parse, kMap, 200);
  independent::bear_damage(parse, kMap, 2000, "0123456789-.eE\"[]{},:\\ \n\x80\xff");
}

}  // namespace
}  // namespace fleetproof::smap_test
