#include "generators/formats/smap.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "damage.hpp"
#include "real_layout.hpp"

namespace fleetproof::smap_test {
namespace {

using independent::replaced;
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

independent::Import import(const std::string& text, const ReadChoice& choice = {}) {
  return independent::import_by(parse_smap, text, "m.smap", choice);
}

std::string refusal(const std::string& text) {
  return independent::refusal([](const std::string& t) { import(t); }, text);
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
  EXPECT_EQ(layout.segments[1].speed_limit_mps, 0.3);
  EXPECT_TRUE(layout.segments[2].control_points_m.empty());
  EXPECT_EQ(layout.segments[3].control_points_m.size(), 2U);
  EXPECT_THAT(warnings, Contains(HasSubstr("1 parts of the map are left out (\"normalPosList\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("details of curves are left out (\"obsStopDist\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("details of points are left out (\"spin\")")));
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

TEST(Smap, EachKnownClassHasItsPurpose) {
  const auto purposes = [](const std::string& kind) {
    return import(replaced(kMap, "\"ActionPoint\"", "\"" + kind + "\"")).layout.stations[2].purposes;
  };
  const Purposes routing(Purpose::Routing);
  for (const char* passed : {"LocationMark", "LandMark", "SwitchMap"}) EXPECT_EQ(purposes(passed), routing) << passed;
  for (const char* served : {"ActionPoint", "TransferLocation"})
    EXPECT_EQ(purposes(served), routing | Purpose::Storage) << served;
  EXPECT_EQ(purposes("ChargePoint"), routing | Purpose::Charging);
  EXPECT_EQ(purposes("ParkPoint"), routing | Purpose::Parking);
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
  EXPECT_THAT(import(replaced(kMap, "\"direction\", \"int32Value\": 0", "\"direction\", \"int32Value\": 2")).warnings,
              Contains(HasSubstr("direction other than 0 or 1 (\"LM1-LM2\")")));
  EXPECT_THAT(
      import(replaced(kMap, "\"obsStopDist\", \"doubleValue\": 0.2", "\"movestyle\", \"int32Value\": 1")).warnings,
      Contains(HasSubstr("1 curves have a movestyle other than 0 (\"LM2-AP3\"); it is left out")));
}

// Two points, and a curve from one to the other.
std::string with_curve(const std::string& kind, const std::string& controls, const std::string& z = "") {
  return R"({"advancedPointList": [{"className": "LocationMark", "instanceName": "A", "pos": {}},
{"className": "LocationMark", "instanceName": "B", "pos": {"x": 4.0, "y": 4.0}}],
"advancedCurveList": [{"className": ")" +
         kind + R"(", "instanceName": "A-B", "startPos": {"instanceName": "A", "pos": {)" + z +
         R"(}}, "endPos": {"instanceName": "B", "pos": {"x": 4.0, "y": 4.0)" + (z.empty() ? "" : ", ") + z + "}}, " +
         controls + "}]}";
}

Curve drawn(const std::string& kind, const std::string& controls, const std::string& z = "") {
  const auto layout = import(with_curve(kind, controls, z)).layout;
  return segment_curve(layout, layout.segments[0]);
}

// The length of a curve, by 10 000 chords.
template <class At>
double length_m(At at) {
  double length = 0.0;
  for (int i = 0; i < 10'000; ++i) length += (at((i + 1) / 1e4) - at(i / 1e4)).norm();
  return length;
}

TEST(Smap, ABezierCurveHasTwoControlPoints) {
  const auto layout =
      import(with_curve("BezierPath", R"("controlPos1": {"x": 3.0}, "controlPos2": {"x": 4.0, "y": 1.0})")).layout;
  EXPECT_EQ(layout.segments[0].control_points_m, (std::vector<Vec2>{{3.0, 0.0}, {4.0, 1.0}}));
}

TEST(Smap, ADegenerateBezierCurveCountsItsControlPointsTwice) {
  const Vec2 a(0.0, 0.0), c1(3.0, 0.0), c2(4.0, 1.0), b(4.0, 4.0);
  const auto at = [&](double t) -> Vec2 {
    const double u = 1.0 - t;
    return std::pow(u, 5) * a + (5.0 * std::pow(u, 4) * t + 10.0 * std::pow(u, 3) * t * t) * c1 +
           (10.0 * u * u * std::pow(t, 3) + 5.0 * u * std::pow(t, 4)) * c2 + std::pow(t, 5) * b;
  };
  const auto curve = drawn("DegenerateBezier", R"("controlPos1": {"x": 3.0}, "controlPos2": {"x": 4.0, "y": 1.0})");
  EXPECT_NEAR(curve.length_m(), length_m(at), 1e-4);
  EXPECT_NEAR((curve.pose_at(curve.length_m() / 2.0).position_m - at(0.5)).norm(), 0.0, 1e-3) << "symmetrical";
  const auto straight = import(
      with_curve("DegenerateBezier", R"("controlPos1": {"x": 1.0, "y": 1.0}, "controlPos2": {"x": 3.0, "y": 3.0})"));
  EXPECT_TRUE(straight.layout.segments[0].control_points_m.empty());
  EXPECT_THAT(straight.warnings, Not(Contains(HasSubstr("DegenerateBezier"))));
}

TEST(Smap, AnArcIsTheCircleThroughItsControlPoint) {
  const double root = std::sqrt(2.0), pi = std::numbers::pi;
  // About (0, 4) and (4, 0), and the long ways round.
  for (const auto& [x, y, quarters] : {std::tuple{2.0 * root, 4.0 - 2.0 * root, 1},
                                       {4.0 - 2.0 * root, 2.0 * root, 1},
                                       {-2.0 * root, 4.0 + 2.0 * root, 3},
                                       {4.0 + 2.0 * root, -2.0 * root, 3}}) {
    const auto curve =
        drawn("ArcPath", fmt::format(R"("controlPos1": {{"x": {}, "y": {}}}, "controlPos2": {{}})", x, y));
    EXPECT_NEAR(curve.length_m(), quarters * 4.0 * pi / 2.0, 1e-4) << x;
    const Vec2 centre = (x > 0.0 && x < 3.0 && y < 2.0) || x < 0.0 ? Vec2(0.0, 4.0) : Vec2(4.0, 0.0);
    for (double at_m = 0.0; at_m < curve.length_m(); at_m += 0.1)
      EXPECT_NEAR((curve.pose_at(at_m).position_m - centre).norm(), 4.0, 3e-5);
  }
  EXPECT_NEAR(drawn("ArcPath", R"("controlPos1": {"x": 1.0, "y": 1.0})").length_m(), 4.0 * root, 1e-9) << "on one line";
  EXPECT_THAT(refusal(with_curve("ArcPath", R"("property": [])")),
              HasSubstr("a curve of the class ArcPath needs 1 control points; add controlPos1"));
}

// By the basis functions of Cox and de Boor, recursively.
double basis(const std::vector<double>& knots, std::size_t i, int order, double u) {
  if (order == 1) return knots[i] < u && u <= knots[i + 1] ? 1.0 : 0.0;
  const auto k = static_cast<std::size_t>(order);
  const auto share = [](double a, double b) { return b == 0.0 ? 0.0 : a / b; };
  return share(u - knots[i], knots[i + k - 1] - knots[i]) * basis(knots, i, order - 1, u) +
         share(knots[i + k] - u, knots[i + k] - knots[i + 1]) * basis(knots, i + 1, order - 1, u);
}

TEST(Smap, ARationalCurveHasItsWeightsInZ) {
  const std::vector<Vec2> p = {{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {4.0, 1.0}, {4.0, 2.0}, {4.0, 4.0}};
  const std::vector<double> spans = {2.0 + std::sqrt(5.0), 2.0 + std::sqrt(5.0), 3.0 + std::sqrt(5.0)};
  const double all = spans[0] + spans[1] + spans[2];
  const std::vector<double> knots = {0, 0, 0, 0, spans[0] / all, (spans[0] + spans[1]) / all, 1, 1, 1, 1};
  std::vector<double> lengths;
  for (const double heavy : {10.0, 30.0, 2.0}) {
    const std::vector<double> weights = {10.0, 10.0, heavy, heavy, 10.0, 10.0};
    const auto at = [&](double u) -> Vec2 {
      if (u == 0.0) return p[0];
      Vec2 sum = Vec2::Zero();
      double weight = 0.0;
      for (std::size_t i = 0; i < 6; ++i) {
        const double w = weights[i] * basis(knots, i, 4, u);
        sum += w * p[i];
        weight += w;
      }
      return sum / weight;
    };
    const auto curve = drawn("NURBS6",
                             fmt::format(R"("controlPos1": {{"x": 1.0, "z": 10}}, "controlPos2": {{"x": 2.0, "z": {0}}},
 "controlPos3": {{"x": 4.0, "y": 1.0, "z": {0}}}, "controlPos4": {{"x": 4.0, "y": 2.0, "z": 10}})",
                                         heavy),
                             "\"z\": 10");
    EXPECT_NEAR(curve.length_m(), length_m(at), 1e-4) << heavy;
    lengths.push_back(curve.length_m());
  }
  EXPECT_GT(std::abs(lengths[0] - lengths[1]), 0.01);
  const auto without = import(with_curve("NURBS6", R"("controlPos1": {"x": 1.0}, "controlPos2": {"x": 2.0, "z": 1.0},
 "controlPos3": {"x": 4.0, "y": 1.0}, "controlPos4": {"x": 4.0, "y": 2.0})"));
  EXPECT_THAT(without.warnings,
              Contains(HasSubstr("1 curves of the class NURBS6 have weights (z) that are not all positive (\"A-B\")")));
  EXPECT_NEAR(segment_curve(without.layout, without.layout.segments[0]).length_m(), lengths[0], 1e-9);
}

TEST(Smap, CurvesThatEndBesideTheirPointsAreTold) {
  EXPECT_THAT(import(kMap).warnings, Not(Contains(HasSubstr("beside their points"))));
  const auto moved = [](const std::string& name, const std::string& pos, const std::string& to) {
    return replaced(kMap, "{\"instanceName\": \"" + name + "\", \"pos\": " + pos,
                    "{\"instanceName\": \"" + name + "\", \"pos\": " + to);
  };
  for (const auto& text : {moved("LM1", "{}", "{\"x\": 0.5}"), moved("LM2", "{\"x\": 4.0}", "{\"x\": 3.5}")})
    EXPECT_THAT(import(text).warnings,
                Contains(HasSubstr("1 curves begin or end beside their points (\"LM1-LM2\"), by up to 0.500 m")));
  EXPECT_THAT(refusal(moved("LM1", "{}", "{\"y\": 40.0}")),
              AllOf(HasSubstr("m.smap:11: /advancedCurveList/0/instanceName: \"LM1-LM2\" is refused"),
                    HasSubstr("the curve begins at (0, 40) m, 40.000 m beside its point at (0, 0) m")));
  EXPECT_THAT(refusal(moved("LM2", "{\"x\": 4.0}", "{\"x\": 2.5}")),
              HasSubstr("the curve ends at (2.5, 0) m, 1.500 m beside its point at (4, 0) m"));
}

TEST(Smap, FaultsAreRefusedAtTheirLine) {
  EXPECT_THAT(refusal("{}"), HasSubstr("has no \"advancedPointList\""));
  EXPECT_THAT(
      refusal(replaced(kMap, "\"endPos\": {\"instanceName\": \"PP5\"}", "\"endPos\": {\"instanceName\": \"PP6\"}")),
      AllOf(HasSubstr("m.smap:21"), HasSubstr("there is no such point; did you mean \"PP5\"?")));
  EXPECT_THAT(refusal(replaced(kMap, "\"LM2\", \"pos\"", "\"LM1\", \"pos\"")), HasSubstr("this name is taken already"));
  EXPECT_THAT(refusal(replaced(kMap, "\"controlPos1\": {\"x\": 8.0, \"y\": 5.0}, ", "")),
              HasSubstr("a curve of the class BezierPath needs 2 control points"));
  EXPECT_THAT(refusal(replaced(kMap, "{\"x\": 8.0, \"y\": 3.0}", "{\"x\": 8.0}")),
              AllOf(HasSubstr("/instanceName: \"AP3-CP4\" is refused"), HasSubstr("it has no length")));
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
