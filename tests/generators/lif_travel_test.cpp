// Which end of an AGV goes first on the edges of LIF: one orientation in version 1.0, a list in the drafts of 2.0.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "damage.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/lif_text.hpp"

namespace fleetproof::lif_travel_test {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Edge {
  Travel travel;
  std::string sentences;
};

// An edge with these rules.
Edge import(const std::string& rules) {
  const auto text = fmt::format(R"({{"layouts": [{{"layoutId": "L",
"nodes": [{{"nodeId": "a", "nodePosition": {{"x": 0, "y": 0}}}}, {{"nodeId": "b", "nodePosition": {{"x": 5, "y": 0}}}}],
"edges": [{{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b", "vehicleTypeEdgeProperties": [{}]}}]}}]}})",
                                rules);
  std::vector<std::string> warnings;
  const auto layout = parse_lif(text, "l.json", warnings);
  std::vector<std::string> none;
  EXPECT_EQ(to_text(parse_lif(to_lif(layout), "l.json", none)), to_text(layout));
  return {layout.segments.at(0).travel, fmt::format("{}", fmt::join(warnings, "\n"))};
}

// One rule with this list of orientations, in both spellings, with whatever else the rule says.
Edge listed(const std::string& list, const std::string& more = "") {
  const auto old = import(fmt::format(R"({{"vehicleOrientations": {}{}}})", list, more));
  const auto read = import(fmt::format(R"({{"mobileRobotOrientations": {}{}}})", list, more));
  EXPECT_EQ(old.travel, read.travel) << list;
  EXPECT_EQ(old.sentences, read.sentences) << list;
  return read;
}

TEST(LifTravel, AListSaysWhichEndGoesFirst) {
  struct Case {
    const char* list;
    Travel travel;
  };
  for (const auto& [list, travel] : {Case{"[0]", Travel::Forward},
                                     {"[3.1415926535897931]", Travel::Backward},
                                     {"[-3.1416]", Travel::Backward},
                                     {"[6.2832, 0.0]", Travel::Forward},
                                     {"[0.0, 3.14159]", Travel::Either},
                                     {"[3.14159, 0]", Travel::Either}}) {
    const auto edge = listed(list);
    EXPECT_EQ(edge.travel, travel) << list;
    EXPECT_EQ(edge.sentences, "") << list;
  }
}

TEST(LifTravel, WordsAndAnglesThatMayBeSlipsAreNotTakenForSidewaysTravel) {
  EXPECT_THAT(independent::refusal([](const std::string& rule) { import(rule); },
                                   R"({"orientationType": "TANGENT", "vehicleOrientation": 3.1416})"),
              HasSubstr("l.json:3: /layouts/0/edges/0/vehicleTypeEdgeProperties/0/orientationType: \"TANGENT\" is "
                        "refused: there is no such word; known: TANGENTIAL, GLOBAL"));
  EXPECT_THAT(import(R"({"vehicleOrientation": 180.0})").sentences,
              HasSubstr("1 edges have orientations of more than a full turn (\"ab\"); they count as radians"));
  EXPECT_THAT(import(R"({"vehicleOrientation": -6.2832})").sentences, Not(HasSubstr("full turn")));
}

// LIF 1.0: nose first. Its successor: as the AGV likes.
TEST(LifTravel, NoOrientationMeansNoseFirstHere) {
  EXPECT_EQ(import(R"({"vehicleTypeId": "fork"})").sentences.find("open"), std::string::npos);
  const auto robots = R"("mobileRobotTypes": [{"manufacturer": "m", "seriesName": "s"}])";
  const auto open = import(fmt::format("{{{}}}", robots));
  EXPECT_EQ(open.travel, Travel::Forward);
  EXPECT_THAT(open.sentences, HasSubstr("1 edges leave the orientation open (\"ab\")"));
  EXPECT_THAT(import(fmt::format(R"({{{}, "mobileRobotOrientations": [0]}})", robots)).sentences,
              Not(HasSubstr("orientation open")));
}

TEST(LifTravel, SidewaysTravelIsNamed) {
  const auto alone = listed("[1.5708, -1.5708]");
  EXPECT_EQ(alone.travel, Travel::Forward);
  EXPECT_THAT(alone.sentences,
              HasSubstr("l.json:1: 1 edges turn the AGV sideways, or by a heading on the map that is not along them "
                        "(\"ab\")"));
  const auto also = listed("[1.5708, 3.14159]");
  EXPECT_EQ(also.travel, Travel::Backward);
  EXPECT_THAT(also.sentences, HasSubstr("1 edges let AGVs drive sideways, too (\"ab\")"));
  EXPECT_THAT(also.sentences, Not(HasSubstr("nose first")));
}

// The edge leads along the x axis of the map.
TEST(LifTravel, AHeadingOnTheMapIsAWayOfTravelAlongAStraightEdge) {
  const std::string on_map = R"(, "orientationType": "GLOBAL")";
  const auto back = listed("[3.14159]", on_map);
  EXPECT_EQ(back.travel, Travel::Backward);
  EXPECT_EQ(back.sentences, "");
  EXPECT_EQ(listed("[0.0, -3.14159]", on_map).travel, Travel::Either);
  EXPECT_EQ(listed("[6.2832]", on_map).travel, Travel::Forward);
  const auto aside = listed("[1.5708]", on_map);
  EXPECT_EQ(aside.travel, Travel::Forward);
  EXPECT_THAT(aside.sentences, HasSubstr("nose first"));
  const auto bent = [&](const std::string& y) {
    return listed("[3.14159]", on_map + R"(, "trajectory": {"degree": 2, "knotVector": [0, 0, 0, 1, 1, 1],
"controlPoints": [{"x": 0, "y": 0}, {"x": 2, "y": )" +
                                   y + R"(}, {"x": 5, "y": 0}]})");
  };
  EXPECT_EQ(bent("1").travel, Travel::Forward);
  EXPECT_THAT(bent("1").sentences, HasSubstr("that is not along them (\"ab\")"));
  EXPECT_EQ(bent("0").travel, Travel::Backward);
}

// On the map or not: the draft of LIF 2.0, which lists types, leaves it open.
TEST(LifTravel, ARuleWithoutAnOrientationMeansNoseFirst) {
  for (const char* rule :
       {R"({"vehicleTypeIds": ["v"]})", R"({"mobileRobotTypeIds": ["v"]})", R"({"orientationType": "GLOBAL"})"}) {
    const auto open = import(rule);
    EXPECT_EQ(open.travel, Travel::Forward) << rule;
    EXPECT_THAT(open.sentences, HasSubstr("1 edges leave the orientation open (\"ab\")")) << rule;
  }
}

TEST(LifTravel, TypesThatDifferAreTold) {
  const auto rule = [](const char* type, const char* list) {
    return fmt::format(R"({{"vehicleTypeId": "{}", "mobileRobotOrientations": {}}})", type, list);
  };
  const auto unlike = import(rule("fork", "[0]") + ", " + rule("tug", "[3.14159]"));
  EXPECT_EQ(unlike.travel, Travel::Either);
  EXPECT_THAT(unlike.sentences,
              HasSubstr("1 edges are driven forward by some types of vehicles and backward by others"));
  const auto alike = import(rule("fork", "[0, 3.14159]") + ", " + rule("tug", "[3.14159, 0]"));
  EXPECT_EQ(alike.travel, Travel::Either);
  EXPECT_THAT(alike.sentences, Not(HasSubstr("by others")));
}

TEST(LifTravel, WhatIsNoListOfAnglesIsLeftOutAndTold) {
  for (const char* list : {R"("backward")", "3.14159", "[]", R"(["backward"])", "[3.14159, true]", "[[3.14159]]", "{}",
                           "[3.14159, null]", "[3e9]", "[3.14159, -1e5]"}) {
    const auto edge = listed(list);
    EXPECT_EQ(edge.travel, Travel::Forward) << list;
    EXPECT_EQ(edge.sentences,
              "l.json:1: 1 edges list orientations that are no angles in radians (\"ab\"); they are left out")
        << list;
  }
}

TEST(LifTravel, BothVersionsCountTogether) {
  EXPECT_EQ(listed("[0]", R"(, "vehicleOrientation": 3.14159)").travel, Travel::Either);
  EXPECT_EQ(import(R"({"vehicleOrientation": 3.14159})").travel, Travel::Backward);
  EXPECT_EQ(import("{}").travel, Travel::Forward);
}

TEST(LifTravel, AnOrientationOfTheFirstVersionIsAnAngle) {
  const auto refused = [](const std::string& rule) { import(rule); };
  EXPECT_THAT(independent::refusal(refused, R"({"vehicleOrientation": 1e5})"),
              HasSubstr("/vehicleOrientation: 100000 is refused: expected an angle in radians"));
}

}  // namespace
}  // namespace fleetproof::lif_travel_test
