#include "generators/formats/lif.hpp"
#include "generators/formats/lif_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "damage.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/opentcs.hpp"
#include "generators/map/antiparallel.hpp"
#include "real_layout.hpp"

namespace fleetproof::lif_test {
namespace {

using independent::replaced;

struct Import {
  Layout layout;
  std::vector<std::string> warnings;  // without those on twins and on what every file has and the import leaves out
};

bool is_usual(const std::string& warning) {
  for (const char* words : {"there and back", "notes for people", "rules for 1 types of vehicles", "details of actions",
                            "stand beside the nodes", "(\"stopCharging\")"}) {
    if (warning.find(words) != std::string::npos) return true;
  }
  return false;
}

Import import(const std::string& text) {
  Import result;
  result.layout = parse_lif(text, "l.json", result.warnings);
  std::erase_if(result.warnings, is_usual);
  return result;
}

std::string refusal(const std::string& text) { return independent::refusal(import, text); }

// Two nodes, edges there and back, and a charger; `trajectory` goes into both edges.
std::string sample(const std::string& there = "", const std::string& back = "") {
  return R"({"metaInformation": {"projectIdentification": "p", "creator": "c", "exportTimestamp": "t", "lifVersion": "1.0.0"},
"layouts": [{"layoutId": "L", "layoutVersion": "1",
"nodes": [
{"nodeId": "a", "nodePosition": {"x": 0, "y": 0}, "vehicleTypeNodeProperties": [{"vehicleTypeId": "v"}]},
{"nodeId": "b", "nodePosition": {"x": 6, "y": 0}, "vehicleTypeNodeProperties": [{"vehicleTypeId": "v", "actions": [{"actionType": "startCharging"}]}]}],
"edges": [
{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b", "vehicleTypeEdgeProperties": [{"vehicleTypeId": "v")" +
         there + R"(}]},
{"edgeId": "ba", "startNodeId": "b", "endNodeId": "a", "vehicleTypeEdgeProperties": [{"vehicleTypeId": "v")" +
         back + R"(}]}]}]})";
}

std::string trajectory(int degree, const std::string& knots, const std::string& points) {
  return ", \"trajectory\": {\"degree\": " + std::to_string(degree) + ", \"knotVector\": [" + knots +
         "], \"controlPoints\": [" + points + "]}";
}

const std::string kThere =
    trajectory(3, "0,0,0,0,1,1,1,1", R"({"x":0,"y":0},{"x":2,"y":1},{"x":4,"y":1},{"x":6,"y":0})");
const std::string kBack =
    trajectory(3, "0,0,0,0,1,1,1,1", R"({"x":6,"y":0},{"x":4,"y":1},{"x":2,"y":1},{"x":0,"y":0})");

TEST(Lif, EdgesThereAndBackBecomeOneSegment) {
  const auto [layout, warnings] = import(sample());
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(layout.segments.size(), 1U);
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(layout.segments[0].name, "ab");
  std::vector<std::string> sentences;
  parse_lif(sample(), "l.json", sentences);
  EXPECT_EQ(sentences.back(),
            "l.json: 1 pairs of one-way segments there and back on one track became two-way segments (\"ab\")");
  EXPECT_EQ(parse_lif(sample(), "l.json", sentences, {TwinPaths::Keep, {}}).segments.size(), 2U);
  EXPECT_EQ(layout.stations[1].purposes, Purposes(Purpose::Routing) | Purpose::Charging);
  EXPECT_EQ(import(sample(kThere, kBack)).layout.segments.size(), 1U);
  EXPECT_EQ(import(sample(kThere)).layout.segments.size(), 2U) << "a curve and a straight line are two tracks";
}

TEST(Lif, ReadsTheSpellingsOfTheSecondVersion) {
  auto text = replaced(sample(), "vehicleTypeNodeProperties", "mobileRobotTypeNodeProperties");
  text = replaced(text, "vehicleTypeNodeProperties", "mobileRobotTypeNodeProperties");
  text = replaced(text, "\"layouts\": [", "\"origins\": [{\"originId\": \"o\", \"layouts\": [");
  const auto [layout, warnings] = import(text.insert(text.size() - 1, "}]"));
  EXPECT_TRUE(warnings.empty());
  EXPECT_TRUE(layout.stations[1].purposes.has(Purpose::Charging));
}

TEST(Lif, CubicAndQuadraticBezierCurvesAreExact) {
  EXPECT_EQ(import(sample(kThere)).layout.segments[0].control_points_m, (std::vector<Vec2>{{2, 1}, {4, 1}}));
  const auto quadratic = import(sample(trajectory(2, "0,0,0,1,1,1", R"({"x":0,"y":0},{"x":3,"y":3},{"x":6,"y":0})")));
  EXPECT_TRUE(quadratic.warnings.empty());
  EXPECT_EQ(quadratic.layout.segments[0].control_points_m, (std::vector<Vec2>{{2, 2}, {4, 2}}));
  const auto line = import(sample(trajectory(1, "0,0,0.5,1,1", R"({"x":0,"y":0},{"x":3,"y":0},{"x":6,"y":0})")));
  EXPECT_TRUE(line.warnings.empty());
  EXPECT_TRUE(line.layout.segments[0].bidirectional);
}

TEST(Lif, RationalCurvesAreFollowedClosely) {
  // A half circle from a to b with its middle in (3, 0), as two rational quadratic arcs.
  const std::string w = "\"weight\": 0.7071067811865476";
  const auto [layout, warnings] = import(sample(trajectory(
      2, "0,0,0,0.5,0.5,1,1,1",
      R"({"x":0,"y":0},{"x":0,"y":3,)" + w + R"(},{"x":3,"y":3},{"x":6,"y":3,)" + w + R"(},{"x":6,"y":0})")));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "l.json:7: the trajectories of 1 edges are no cubic Bezier curves (\"ab\"); here they are such curves, "
            "which are less than 1e-06 m off");
  for (const auto& point : independent::samples(layout, layout.segments[0]))
    EXPECT_NEAR((point - Vec2(3, 0)).norm(), 3.0, 0.001);
}

// From a to b past (3, 3): the corner is rounded, and an AGV arrives along the last leg.
TEST(Lif, PolylinesKeepTheirLegs) {
  const auto bent = trajectory(1, "0,0,0.5,1,1", R"({"x":0,"y":0},{"x":3,"y":3},{"x":6,"y":0})");
  const auto [layout, warnings] = import(sample(bent));
  EXPECT_EQ(warnings,
            std::vector<std::string>{
                "l.json:7: the trajectories of 1 edges are polylines with corners (\"ab\"); here an arc leads "
                "round each corner, and passes by it at 0.207 m at most"});
  for (const Vec2& p : independent::samples(layout, layout.segments[0])) {
    const double off_m = std::abs(p.y() - (3.0 - std::abs(p.x() - 3.0))) / std::numbers::sqrt2;
    EXPECT_LT(off_m, 0.15) << p.transpose();
    if (std::abs(p.x() - 3.0) > 0.36) {
      EXPECT_LT(off_m, 1e-9) << p.transpose();
    }
  }
  const auto headed = replaced(sample(bent), R"("vehicleTypeId": "v", "actions")",
                               R"("vehicleTypeId": "v", "theta": -0.785398, "actions")");
  EXPECT_TRUE(import(headed).layout.stations[1].heading.has_value()) << "the heading with which the edge arrives";
}

TEST(Lif, OneSentenceTellsOfAllTrajectories) {
  const auto bent = trajectory(1, "0,0,0.5,1,1", R"({"x":0,"y":0},{"x":3,"y":3},{"x":6,"y":0})"),
             bent_back = trajectory(1, "0,0,0.5,1,1", R"({"x":6,"y":0},{"x":3,"y":1},{"x":0,"y":0})");
  const auto [layout, warnings] = import(sample(bent, bent_back));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("of 2 edges are polylines with corners (\"ab\", \"ba\")"), std::string::npos);
}

TEST(Lif, WarnsOfTrajectoriesThatMissTheirNodesOrRunBackwards) {
  EXPECT_EQ(import(sample(kBack)).warnings,
            std::vector<std::string>{
                "l.json:7: the trajectories of 1 edges run from the end to the start (\"ab\"); they are turned round"});
  EXPECT_EQ(import(sample(kBack)).layout.segments[0].control_points_m, (std::vector<Vec2>{{2, 1}, {4, 1}}));
  EXPECT_EQ(
      import(sample(replaced(kThere, "{\"x\":0,\"y\":0}", "{\"x\":0.25,\"y\":0}"))).warnings,
      std::vector<std::string>{
          "l.json:7: the trajectories of 1 edges end beside their nodes (\"ab\"), by up to 0.250 m; they are drawn "
          "to the nodes"});
}

TEST(Lif, TrajectoriesFarBesideTheirNodesAreRefused) {
  const auto why = [](const std::string& from, const std::string& to) {
    return refusal(sample(replaced(kThere, from, to)));
  };
  EXPECT_EQ(why("{\"x\":6,\"y\":0}", "{\"x\":5.1,\"y\":0}"), "accepted") << "0.9 m";
  EXPECT_NE(
      why("{\"x\":6,\"y\":0}", "{\"x\":3.6,\"y\":0.5}")
          .find("the curve ends at (3.6, 0.5) m, 2.452 m beside its node at (6, 0) m, and no AGV can drive from one "
                "to the other; give the curve in the coordinates of the nodes, or correct the node"),
      std::string::npos);
  EXPECT_NE(
      why("{\"x\":0,\"y\":0}", "{\"x\":-2,\"y\":0}").find("the curve begins at (-2, 0) m, 2.000 m beside its node"),
      std::string::npos);
  EXPECT_NE(refusal(sample(trajectory(1, "0,0,1,1", R"({"x":100,"y":0},{"x":106,"y":0})")))
                .find("l.json:7: /layouts/0/edges/0/vehicleTypeEdgeProperties/0/trajectory"),
            std::string::npos)
      << "a curve in other coordinates";
}

void expect_round_trip(const Layout& layout) {
  const auto again = import(to_lif(layout));
  EXPECT_TRUE(again.warnings.empty()) << again.warnings[0];
  EXPECT_EQ(to_text(again.layout), to_text(layout));
}

TEST(Lif, TheFamiliesComeBackAsTheyWere) {
  for (const auto& family : layout_families()) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Draws draws(seed);
      expect_round_trip(family.make(draws, Range::Normal));
    }
  }
}

// Also beside a lane on the same track, and if twins are to stay two.
TEST(Lif, ATwoWaySegmentComesBackWithItsOwnWayBack) {
  Layout layout = import(sample()).layout;
  ASSERT_TRUE(layout.segments[0].bidirectional);
  Segment lane = layout.segments[0];
  lane.bidirectional = false;
  lane.name = "lane";
  std::swap(lane.from, lane.to);
  std::ranges::reverse(lane.control_points_m);
  lane.speed_limit_mps = 1.5;
  lane.back_speed_limit_mps = 0.0;
  lane.back_travel = Travel::Forward;
  layout.segments.insert(layout.segments.begin(), lane);
  for (const TwinPaths twins : {TwinPaths::Merge, TwinPaths::Keep}) {
    std::vector<std::string> told;
    EXPECT_EQ(to_text(parse_lif(to_lif(layout), "l.json", told, {twins, {}, ""})), to_text(layout));
  }
}

TEST(Lif, OrientationsAndLoadsComeBack) {
  Layout layout = import(sample()).layout;
  for (const Travel there : kValuesOf<Travel>) {
    for (const Travel back : kValuesOf<Travel>) {
      for (const LoadState load : kValuesOf<LoadState>) {
        layout.segments[0].travel = there;
        layout.segments[0].back_travel = back;
        layout.segments[0].permissions.clear();
        if (load != LoadState::Any) layout.segments[0].permissions = {{"", load}};
        expect_round_trip(layout);
      }
    }
  }
}

TEST(Lif, OneTypeBackwardAndOneForwardIsEitherWay) {
  const auto read = import(
      sample(", \"vehicleOrientation\": 3.14159}, {\"vehicleTypeId\": \"w\"", ", \"vehicleOrientation\": -3.1416"));
  EXPECT_EQ(read.layout.segments[0].travel, Travel::Either);
  EXPECT_EQ(read.layout.segments[0].back_travel, Travel::Backward);
}

TEST(Lif, EachDirectionHasItsSpeedLimitInEitherSpelling) {
  const auto read = import(sample(", \"maxSpeed\": 1.2", ", \"maximumSpeed\": 0.4"));
  ASSERT_EQ(read.layout.segments.size(), 1U);
  EXPECT_EQ(read.layout.segments[0].speed_limit_mps, 1.2);
  EXPECT_EQ(read.layout.segments[0].back_speed_limit_mps, 0.4);
  for (const std::string& warning : read.warnings) EXPECT_EQ(warning.find("speed"), std::string::npos) << warning;
  expect_round_trip(read.layout);
  for (const char* speed : {"0", "-1", "0.0009", "100.1", "1e300"}) {
    const std::string said = refusal(sample(std::string(", \"maxSpeed\": ") + speed));
    EXPECT_EQ(said.find("l.json:7: /layouts/0/edges/0/vehicleTypeEdgeProperties/0/maxSpeed: "), 0U) << said;
    EXPECT_NE(said.find("is refused: expected a speed of 0.001 to 100 m/s"), std::string::npos) << said;
  }
}

TEST(Lif, OfTwoSpeedLimitsTheLowerCountsAndIsTold) {
  for (const char* both : {R"(, "maxSpeed": 1.2, "maximumSpeed": 0.8)", R"(, "maximumSpeed": 1.2, "maxSpeed": 0.8)"}) {
    const auto read = import(sample(both));
    EXPECT_EQ(read.layout.segments[0].speed_limit_mps, 0.8);
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_NE(read.warnings[0].find("1 edges have two speed limits, \"maxSpeed\" and \"maximumSpeed\" (\"ab\")"),
              std::string::npos);
  }
  EXPECT_TRUE(import(sample(R"(, "maxSpeed": 1.2, "maximumSpeed": 1.2)")).warnings.empty());
}

TEST(Lif, ACorridorIsWideFloor) {
  const auto width_m = [](const std::string& there, const std::string& back = "") {
    return import(sample(there, back)).layout.segments[0].width_m;
  };
  EXPECT_EQ(width_m(R"(, "corridor": {"maximumLeftWidth": 0.5, "maximumRightWidth": 0.75})"), 1.25);
  EXPECT_EQ(width_m(R"(, "corridor": {"leftWidth": 1, "rightWidth": 1, "corridorRefPoint": "CONTOUR"})"), 2.0);
  EXPECT_EQ(width_m(R"(, "corridor": {"maxLeft": 1})", R"(, "corridor": {"maxLeft": 2})"), 2.0) << "of twins the wider";
  EXPECT_EQ(width_m(R"(, "corridor": {}}, {"vehicleTypeId": "w", "corridor": {"maxRight": 3})"), 3.0);
  EXPECT_EQ(width_m(R"(, "corridor": {"maxLeft": 1, "maxRight": 1, "leftWidth": 1, "rightWidth": 2})"), 3.0)
      << "two spellings of one corridor";
  EXPECT_EQ(width_m(R"(, "corridor": {"maxLeft": 80, "maxRight": 80})"), 100.0);
  EXPECT_EQ(width_m(""), 0.0);
  EXPECT_NE(refusal(sample(R"(, "corridor": {"leftWidth": -1})"))
                .find("corridor/leftWidth: -1 is refused: expected a width of 0 m or more"),
            std::string::npos);
}

TEST(Lif, TwoStationsWithOneIdAreRefused) {
  const auto with = [](const std::string& id) {
    std::string text = sample();
    text.insert(text.rfind("}]}"), R"(, "stations": [{"stationId": "s", "interactionNodeIds": ["a"]},
{"stationId": ")" + id + R"(", "interactionNodeIds": ["b"]}])");
    return text;
  };
  EXPECT_EQ(refusal(with("t")), "accepted");
  EXPECT_EQ(refusal(with("")), "accepted") << "an id that says nothing is not read";
  EXPECT_NE(refusal(with("s")).find("stations/1/stationId: \"s\" is refused: this id is taken already"),
            std::string::npos)
      << refusal(with("s"));
}

TEST(Lif, TheCrossdockComesBackWithItsTwinsAsOne) {
  std::vector<std::string> warnings;
  auto layout = read_opentcs(independent::source_file("tests/layouts/crossdock.xml"), warnings, {TwinPaths::Keep, {}});
  layout.blocks.clear();  // for which LIF has no place
  for (Segment& segment : layout.segments) segment.blocks.clear();
  const auto text = to_lif(layout);
  EXPECT_EQ(merge_antiparallel(layout).names.size(), 12U);
  EXPECT_EQ(to_text(import(text).layout), to_text(layout));
  expect_round_trip(layout);
}

TEST(Lif, JoinedCurvesAndHardNamesComeBack) {
  Layout layout = import(sample()).layout;
  layout.name = "quote \" and back\\slash";
  layout.segments[0].control_points_m = {{1, 1}, {2, 1}, {3, 1}, {4, 1}, {5, 1}};
  layout.segments.push_back(layout.segments[0]);
  layout.segments[1].name = "ab~";
  layout.segments[1].bidirectional = false;
  layout.segments[1].control_points_m.clear();
  layout.floor_high_m.y() = 4.0;
  expect_round_trip(layout);
}

TEST(LifErrors, NamePlaceValueAndRemedy) {
  const auto break_at = [](const std::string& from, const std::string& to) {
    return refusal(replaced(sample(kThere), from, to));
  };
  EXPECT_EQ(break_at("\"endNodeId\": \"b\"", "\"endNodeId\": \"bb\""),
            "l.json:7: /layouts/0/edges/0/endNodeId: \"bb\" is refused: there is no such node; did you mean \"b\"?");
  EXPECT_EQ(break_at("\"nodeId\": \"b\"", "\"nodeId\": \"a\""),
            "l.json:5: /layouts/0/nodes/1/nodeId: \"a\" is refused: this id is taken already; rename one");
  EXPECT_EQ(break_at("\"x\": 6", "\"x\": \"6\""),
            "l.json:5: /layouts/0/nodes/1/nodePosition/x: \"6\" is refused: expected a number");
  EXPECT_EQ(break_at("\"edges\"", "\"edgs\""), "l.json:2: /layouts/0: \"edges\" is missing; add it");
  EXPECT_NE(break_at("0,0,0,0,1", "0,0,0,1").find("4 control points of degree 3 need 8 knots; here are 7"),
            std::string::npos);
  EXPECT_NE(break_at("0,0,0,0,1", "0,0,0,1,0").find("the knots do not ascend"), std::string::npos);
  EXPECT_NE(break_at("\"x\": 6", "\"x\": 6e9")
                .find("l.json:5: /layouts/0/nodes/1/nodeId: \"b\" is refused: coordinates lie within"),
            std::string::npos);
  EXPECT_NE(break_at("{\"x\":2,\"y\":1},{\"x\":4,\"y\":1}", "{\"x\":9,\"y\":0},{\"x\":-9,\"y\":0}")
                .find("l.json:7: /layouts/0/edges/0/edgeId"),
            std::string::npos);
  EXPECT_EQ(refusal(""), "l.json: is empty; expected a JSON object");
  EXPECT_EQ(
      refusal("[]"),
      "l.json:1: top level: [] is refused: has neither \"layouts\" nor \"origins\"; expected a file in the Layout "
      "Interchange Format (LIF)");
}

TEST(Lif, AKeyThatIsNullIsMissing) {
  auto text = sample(kThere,
                     ", \"maxSpeed\": null, \"trajectory\": null, \"rotationAtStartNodeAllowed\": null, "
                     "\"vehicleOrientation\": null, \"loadRestriction\": null, \"corridor\": null");
  text = replaced(text, "\"edges\": [", "\"stations\": null, \"layoutName\": null, \"edges\": [");
  text = replaced(text, "\"nodeId\": \"a\",", "\"nodeId\": \"a\", \"nodeDescription\": null, \"traffic\": null,");
  text = replaced(text, "{\"vehicleTypeId\": \"v\"}", "{\"vehicleTypeId\": \"v\", \"theta\": null, \"actions\": null}");
  const auto read = import(text);
  EXPECT_TRUE(read.warnings.empty()) << read.warnings[0];
  EXPECT_EQ(to_text(read.layout), to_text(import(sample(kThere)).layout));
}

TEST(LifErrors, AKeyThatIsNeededAndNullIsRefused) {
  const auto refused = [](const std::string& from, const std::string& to) {
    return refusal(replaced(sample(kThere), from, to));
  };
  EXPECT_EQ(refused("\"x\": 6", "\"x\": null"),
            "l.json:5: /layouts/0/nodes/1/nodePosition/x: null is refused: expected a number");
  for (const std::string key :
       {"nodeId", "edgeId", "startNodeId", "vehicleTypeId", "knotVector", "actionType", "nodes"}) {
    EXPECT_NE(refused("\"" + key + "\": ", "\"" + key + "\": null, \"given\": ").find(key + ": null is refused"),
              std::string::npos)
        << key;
  }
}

TEST(LifErrors, CutAndDamagedFilesAreReadOrRefused) {
  const auto text = sample(kThere, trajectory(2, "0,0,0,0.5,1,1,1",
                                              R"({"x":6,"y":0},{"x":4,"y":1,"weight":2},{"x":2,"y":1},{"x":0,"y":0})"));
  independent::bear_cuts(import, text, 100);
  independent::bear_damage(import, text, 2000, "0123456789-.eE\"{}[],: \n\x80\xff");
}

TEST(RealLayouts, Lif) {
  struct Expected {
    const char* name;
    std::size_t stations, segments, directed;
  };
  for (const auto& [name, stations, segments, lanes] :
       {Expected{"10_7", 5, 6, 6}, {"10_10", 6, 3, 6}, {"10_13", 2, 1, 2}}) {
    const auto path = independent::real_layout(std::string("lif/vdma_lif_v1_example_") + name + ".lif.json");
    FLEETPROOF_SKIP_IF_ABSENT(path);
    std::vector<std::string> warnings;
    const auto layout = read_lif(path, warnings);
    EXPECT_EQ(layout.stations.size(), stations) << name;
    EXPECT_EQ(layout.segments.size(), segments) << name;
    EXPECT_EQ(independent::directed(layout), lanes) << name;
  }
}

}  // namespace
}  // namespace fleetproof::lif_test
