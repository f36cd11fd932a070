// What LIF says for each type of vehicle, about turns and headings, and which of several layouts is read.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "damage.hpp"
#include "generators/formats/heading.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/lif_text.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/permitted_types.hpp"

namespace fleetproof::lif_rules_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Plant {
  Layout layout;
  std::string sentences;
};

// Nodes a, b and c in a row, 5 m apart; edges ab, bc and cb. Each text is the list of rules of one element.
struct Rules {
  std::string a{}, b{}, c{}, ab{}, bc{}, cb{};
};

std::string file_of(const Rules& rules) {
  const auto node = [](const char* name, int x, const std::string& list) {
    return fmt::format(R"({{"nodeId": "{}", "nodePosition": {{"x": {}, "y": 0}}, "vehicleTypeNodeProperties": [{}]}})",
                       name, x, list);
  };
  const auto edge = [](const char* from, const char* to, const std::string& list) {
    return fmt::format(R"({{"edgeId": "{0}{1}", "startNodeId": "{0}", "endNodeId": "{1}",
                           "vehicleTypeEdgeProperties": [{2}]}})",
                       from, to, list);
  };
  return fmt::format(R"({{"layouts": [{{"layoutId": "L", "nodes": [{},
{},
{}], "edges": [{},
{},
{}]}}]}})",
                     node("a", 0, rules.a), node("b", 5, rules.b), node("c", 10, rules.c), edge("a", "b", rules.ab),
                     edge("b", "c", rules.bc), edge("c", "b", rules.cb));
}

Plant import(const Rules& rules) {
  Plant plant;
  std::vector<std::string> warnings;
  plant.layout = parse_lif(file_of(rules), "l.json", warnings, {TwinPaths::Keep, {}, ""});
  plant.sentences = fmt::format("{}", fmt::join(warnings, "\n"));
  return plant;
}

const std::string kFork = R"({"vehicleTypeId": "fork"})", kTug = R"({"vehicleTypeId": "tug"})",
                  kBoth = kFork + ", " + kTug;

std::vector<std::string> permissions(const Plant& plant, std::size_t segment) {
  std::vector<std::string> words;
  for (const auto& [type, load] : plant.layout.segments.at(segment).permissions)
    words.push_back(type + ":" + name_of(load));
  return words;
}

TEST(LifRules, OneTypeOfVehicleIsEveryAgv) {
  const auto plant = import({kFork, kFork, kFork, kFork, kFork, kFork});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_THAT(permissions(plant, i), IsEmpty());
  EXPECT_THAT(plant.sentences, HasSubstr("rules for 1 types of vehicles (\"fork\"); here they hold for every AGV"));
}

TEST(LifRules, RulesThatLifForbidsAreTold) {
  const std::string tug_forward = R"({"vehicleTypeId": "tug", "loadRestriction": {"unloaded": false}})";
  const auto twice = import({kBoth, kBoth, kBoth, tug_forward + ", " + kTug + ", " + kFork, kBoth, kBoth});
  EXPECT_THAT(permissions(twice, 0), IsEmpty());
  EXPECT_THAT(twice.sentences, HasSubstr("1 nodes and edges have two rules for one type of vehicle (\"ab\")"));
  const auto nameless = import({kBoth, "{}", kBoth, kBoth, kBoth, kBoth});
  EXPECT_THAT(permissions(nameless, 0), IsEmpty());
  EXPECT_THAT(nameless.sentences, HasSubstr("1 nodes and edges have a rule that names no type of vehicle (\"b\")"));
  EXPECT_THAT(import({kBoth, kBoth, kBoth, kBoth, kBoth, kBoth}).sentences,
              testing::AllOf(testing::Not(HasSubstr("two rules")), testing::Not(HasSubstr("no type"))));
}

TEST(LifRules, ATypeWithABadNameIsRefusedByName) {
  const std::string rule = fmt::format(R"({{"vehicleTypeId": "{}"}})", std::string(201, 'x'));
  const auto refused = independent::refusal([&](const std::string& text) { return import({.ab = text}); }, rule);
  EXPECT_THAT(refused, HasSubstr("the type of vehicle \"xxx"));
  EXPECT_THAT(refused, HasSubstr("the name is longer than 200 bytes"));
}

TEST(LifRules, ATypeNeedsARuleAtTheEdgeAndAtBothNodes) {
  const auto plant = import({kBoth, kBoth, kFork, kTug, kBoth, ""});
  EXPECT_THAT(permissions(plant, 0), ElementsAre("tug:any"));
  EXPECT_THAT(permissions(plant, 1), ElementsAre("fork:any")) << "tug may not be at c";
  EXPECT_THAT(permissions(plant, 2), ElementsAre("fork:any")) << "an edge without rules is for all that may be there";
  EXPECT_THAT(plant.sentences, HasSubstr("3 of 3 edges are for some types of vehicles only"));
  EXPECT_THAT(plant.sentences, HasSubstr("(\"fork\", \"tug\")"));
  EXPECT_THAT(plant.sentences, HasSubstr("1 nodes and edges have no rule for any type of vehicle; here all types may"));
  EXPECT_THAT(import({kBoth, kBoth, kFork, kTug, kBoth, kFork}).sentences, Not(HasSubstr("have no rule")));
  EXPECT_THAT(import({"", "", "", "", "", ""}).sentences, HasSubstr("6 nodes and edges have no rule for any type"));
}

// LIF 2.0 lists types: by identifiers, or by manufacturer and series.
TEST(LifRules, OneRuleCanBeForSeveralTypes) {
  const std::string both = R"({"vehicleTypeIds": ["fork", "tug"]})", tug = R"({"vehicleTypeIds": ["tug"]})";
  const auto plant = import({both, both, both, tug, both, R"({"vehicleTypeIds": []})"});
  ASSERT_EQ(plant.layout.segments.size(), 2U);
  EXPECT_THAT(permissions(plant, 0), ElementsAre("tug:any"));
  EXPECT_THAT(permissions(plant, 1), IsEmpty());
  EXPECT_THAT(plant.sentences, HasSubstr("no AGV may drive 1 edges (\"cb\")")) << "a rule for no type is for nobody";

  const auto robot = [](const std::string& manufacturer) {
    return R"({"mobileRobotTypes": [{"manufacturer": ")" + manufacturer + R"(", "seriesName": "A"}]})";
  };
  const auto two = robot("m") + ", " + robot("k");
  EXPECT_THAT(permissions(import({two, two, two, robot("k"), two, two}), 0), ElementsAre("k.A:any"))
      << "a series is unique in what its manufacturer makes";
}

// All types follow one curve here.
TEST(LifRules, ATrajectoryForSomeTypesIsTold) {
  const auto curved = [](const char* type, const char* y) {
    return fmt::format(R"({{"vehicleTypeId": "{}", "trajectory": {{"degree": 2, "knotVector": [0, 0, 0, 1, 1, 1],
"controlPoints": [{{"x": 0, "y": 0}}, {{"x": 2, "y": {}}}, {{"x": 5, "y": 0}}]}}}})",
                       type, y);
  };
  const auto sentences = [&](const std::string& rules) {
    return import({kBoth, kBoth, kBoth, rules, kBoth, kBoth}).sentences;
  };
  const std::string told = "1 edges have another trajectory for some types of vehicles, or none (\"ab\")";
  EXPECT_THAT(sentences(curved("fork", "1") + ", " + kTug), HasSubstr(told));
  EXPECT_THAT(sentences(curved("fork", "1") + ", " + curved("tug", "2")), HasSubstr(told));
  EXPECT_THAT(sentences(curved("fork", "1") + ", " + curved("tug", "1")), Not(HasSubstr("trajectory")));
}

TEST(LifRules, AnActionOnAnEdgeIsForItsEnd) {
  const auto plant = import({.ab = R"({"actions": [{"actionType": "pick"}]})"});
  EXPECT_EQ(plant.layout.stations[1].purposes, Purposes(Purpose::Routing) | Purpose::Storage);
  EXPECT_THAT(plant.sentences, HasSubstr("1 edges have actions to pick, drop or charge (\"ab\"); here their end"));
  std::vector<std::string> told;
  ReadChoice choice;
  choice.purposes = purpose_words_of("beep=parking", "--purposes");
  parse_lif(file_of({.ab = R"({"actions": [{"actionType": "beep"}]})"}), "l.json", told, choice);
  EXPECT_THAT(fmt::format("{}", fmt::join(told, "\n")), Not(HasSubstr("actions to pick")));
}

TEST(LifRules, ANodeMayRestrictLoads) {
  const std::string empty = R"({"vehicleTypeId": "fork", "loadRestriction": {"unloaded": true, "loaded": false}})";
  const auto plant = import({.a = kFork, .b = kFork, .c = empty, .ab = kFork, .bc = kFork, .cb = kFork});
  EXPECT_THAT(permissions(plant, 0), IsEmpty());
  EXPECT_THAT(permissions(plant, 1), ElementsAre(":empty"));
  EXPECT_THAT(permissions(plant, 2), ElementsAre(":empty"));
  const std::string loaded = R"({"vehicleTypeId": "fork", "loadRestriction": {"unloaded": false, "loaded": true}})";
  EXPECT_THAT(import({.a = kFork, .b = kFork, .c = empty, .ab = kFork, .bc = loaded, .cb = kFork}).sentences,
              HasSubstr("no AGV may drive 1 edges (\"bc\")"));
}

// As in LIF 2.0: what must be done, what can be done, and what must not be done.
TEST(LifRules, ThreeListsOfActionsSayWhatANodeIsFor) {
  const auto rule = [](const std::string& lists) { return "{\"vehicleTypeId\": \"fork\", " + lists + "}"; };
  const auto plant = import({.a = rule(R"("requiredActions": [{"actionType": "startCharging"}])"),
                             .b = rule(R"("feasibleActions": [{"actionType": "pick"}])"),
                             .c = rule(R"("forbiddenActionTypes": ["pick", "drop"])"),
                             .ab = kFork,
                             .bc = kFork,
                             .cb = kFork});
  EXPECT_EQ(plant.layout.stations[0].purposes, Purposes(Purpose::Routing) | Purpose::Charging);
  EXPECT_EQ(plant.layout.stations[1].purposes, Purposes(Purpose::Routing) | Purpose::Storage);
  EXPECT_EQ(plant.layout.stations[2].purposes, Purposes(Purpose::Routing));
  EXPECT_THAT(plant.sentences, HasSubstr("1 nodes and edges forbid types of actions (\"c\")"));
}

TEST(LifRules, AnEdgeForNobodyIsLeftOut) {
  const auto plant = import({kBoth, kBoth, kFork, kBoth, kTug, kFork});
  EXPECT_EQ(plant.layout.segments.size(), 2U);
  EXPECT_THAT(plant.sentences, HasSubstr("l.json:5: no AGV may drive 1 edges (\"bc\")"));
}

TEST(LifRules, LoadsAreByType) {
  const std::string loaded = R"({"vehicleTypeId": "fork", "loadRestriction": {"unloaded": false, "loaded": true}})",
                    empty = R"({"vehicleTypeId": "fork", "loadRestriction": {"unloaded": true, "loaded": false}})";
  const auto plant = import({kBoth, kBoth, kBoth, loaded + ", " + kTug, loaded + ", " + empty + ", " + kTug, loaded});
  EXPECT_THAT(permissions(plant, 0), ElementsAre("fork:loaded", "tug:any"));
  EXPECT_THAT(permissions(plant, 1), IsEmpty()) << "a type that is listed twice may do both";
  EXPECT_THAT(permissions(plant, 2), ElementsAre("fork:loaded"));
  EXPECT_THAT(permissions(import({kFork, kFork, kFork, loaded, kFork, kFork}), 0), ElementsAre(":loaded"));
}

TEST(LifRules, TypesCanBeLifted) {
  const std::string loaded = R"({"vehicleTypeId": "fork", "loadRestriction": {"unloaded": false, "loaded": true}})";
  auto plant = import({kBoth, kBoth, kBoth, loaded, loaded + ", " + kTug, kBoth});
  EXPECT_THAT(lift_types(plant.layout), ElementsAre("ab", "bc"));
  EXPECT_THAT(permissions(plant, 0), ElementsAre(":loaded"));
  EXPECT_THAT(permissions(plant, 1), IsEmpty());
}

// Typed permissions, turns and headings come back; what does not is told.
TEST(LifRules, RulesAreWritten) {
  const std::string loaded = R"({"vehicleTypeId": "fork", "loadRestriction": {"unloaded": false, "loaded": true}})",
                    no_turn = R"({"rotationAtEndNodeAllowed": "NONE"})";
  for (const Rules& rules : {Rules{kBoth, kBoth, kFork, kTug, kBoth, loaded}, Rules{.ab = loaded, .bc = no_turn},
                             Rules{.b = R"({"theta": 0})", .c = R"({"theta": 0})"}}) {
    const auto layout = import(rules).layout;
    EXPECT_THAT(lost_in_lif(layout), IsEmpty());
    std::vector<std::string> warnings;
    EXPECT_EQ(to_text(parse_lif(to_lif(layout), "l.json", warnings, {TwinPaths::Keep, {}, ""})), to_text(layout));
  }
}

TEST(LifRules, WhatAnImportWouldChangeIsTold) {
  auto layout = import({}).layout;
  layout.segments[0].permissions = {{"tug", LoadState::Any}};
  layout.segments[1].permissions = {{"fork", LoadState::Any}, {"tug", LoadState::Any}};
  layout.segments[2].permissions = {{"", LoadState::Empty}, {"", LoadState::Loaded}};
  layout.stations[1].heading = Vec2(0.0, 1.0);
  layout.stations[2].heading = Vec2(1.0, 0.0);
  EXPECT_THAT(
      lost_in_lif(layout),
      ElementsAre("2 segments come back with their permissions in the order of types, or joined (\"bc\", \"cb\")",
                  "1 stations ask for a heading that no lane has which arrives (\"b\"); an import takes that of a "
                  "lane within 1 degree, or none"));
}

// LIF says at edges where an AGV may turn.
TEST(LifRules, ATurnAtAStationWithoutEdgesIsTold) {
  auto layout = import({}).layout;
  layout.stations.emplace_back().name = "alone";
  layout.stations.back().position_m = {0.0, 9.0};
  layout.stations.back().turning = false;
  fit_floor(layout, 3.0);
  EXPECT_THAT(lost_in_lif(layout), ElementsAre("1 stations come back with another rule for turns, which LIF has at "
                                               "edges only (\"alone\")"));
}

TEST(LifRules, WhatCannotBeWrittenIsTold) {
  auto layout = import({}).layout;
  layout.blocks = {{"dock", BlockKind::OneVehicle}};
  layout.segments[0].width_m = 2.0;
  layout.floor_low_m.x() -= 1.0;
  layout.segments[1].permissions = {{"", LoadState::Empty}, {"tug", LoadState::Any}};
  EXPECT_THAT(
      lost_in_lif(layout),
      ElementsAre(
          "LIF has no place for blocks: 1 are left out (\"dock\")",
          "LIF has no place for the floor: an import draws one around the nodes",
          "LIF has no place for the width of a lane: 1 segments lose it (\"ab\")",
          "LIF has no word for every type of vehicle: 1 segments permit something to every type and more to some "
          "(\"bc\"); in the file they are for \"tug\", \"agv\" alone, where \"agv\" stands for all others"));
  std::vector<std::string> warnings;
  EXPECT_EQ(parse_lif(to_lif(layout), "l.json", warnings, {TwinPaths::Keep, {}, ""}).segments[1].permissions,
            (std::vector<Permission>{{"tug", LoadState::Any}, {"agv", LoadState::Empty}}));
}

std::string turning(const Plant& plant) {
  std::string text;
  for (const auto& station : plant.layout.stations) text += station.turning ? '+' : '-';
  return text;
}

TEST(LifRules, NoAgvTurnsWhereNoEdgeLetsIt) {
  const std::string not_at_end = R"({"rotationAtEndNodeAllowed": "NONE"})",
                    not_at_start = R"({"rotationAtStartNodeAllowed": "NONE"})";
  EXPECT_EQ(turning(import({})), "+++");
  EXPECT_EQ(turning(import({.bc = not_at_end})), "++-") << "all edges that arrive at c";
  EXPECT_EQ(turning(import({.cb = not_at_start})), "++-") << "all edges that leave c";
  EXPECT_EQ(turning(import({.ab = not_at_end, .cb = not_at_end})), "+-+");
  const auto some = import({.ab = not_at_end});
  EXPECT_EQ(turning(some), "+++");
  EXPECT_THAT(some.sentences, HasSubstr("1 nodes let some AGVs turn, or between some edges only (\"b\")"));
}

TEST(LifRules, AnAgvThatTurnsOnAnEdgeTurnsAtItsEnds) {
  for (const char* more : {R"("rotationAllowed": true)", R"("vehicleOrientation": 1.5707963)"}) {
    const auto plant = import({.bc = fmt::format(R"({{"rotationAtEndNodeAllowed": "NONE", {}}})", more)});
    EXPECT_EQ(turning(plant), "+++") << more;
    EXPECT_THAT(plant.sentences, HasSubstr("1 nodes let some AGVs turn, or between some edges only (\"c\")"));
  }
}

TEST(LifRules, OneSenseOfTurnsIsTold) {
  const auto plant = import({.bc = R"({"rotationAtEndNodeAllowed": "CCW"})"});
  EXPECT_EQ(turning(plant), "+++");
  EXPECT_THAT(plant.sentences, HasSubstr("1 nodes let an AGV turn in one sense only (\"c\")"));
  EXPECT_THAT(
      independent::refusal([](const std::string& bc) { import({.bc = bc}); }, R"({"rotationAtEndNodeAllowed": "ccw"})"),
      HasSubstr("\"ccw\" is refused: there is no such word; "));
}

TEST(LifRules, AHeadingIsThatOfALaneThatArrives) {
  const auto plant = import({.b = R"({"theta": 3.14})", .c = R"({"theta": 0.01})"});
  EXPECT_EQ(plant.layout.stations[1].heading, std::optional(Vec2(-1.0, 0.0)));
  EXPECT_EQ(plant.layout.stations[2].heading, std::optional(Vec2(1.0, 0.0))) << "0.6 degrees beside edge bc";
  EXPECT_EQ(plant.layout.stations[0].heading, std::nullopt);
  const auto torn = import({.b = R"({"theta": 0}, {"theta": 3.14159})", .c = R"({"theta": 1.57})"});
  EXPECT_EQ(torn.layout.stations[1].heading, std::nullopt);
  EXPECT_THAT(torn.sentences, HasSubstr("1 nodes ask each type of vehicle for another heading (\"b\")"));
  EXPECT_EQ(torn.layout.stations[2].heading, std::nullopt);
  EXPECT_THAT(torn.sentences, HasSubstr("1 nodes ask for a heading with which no edge arrives (\"c\")"));
}

TEST(Heading, AQuarterTurnIsExact) {
  EXPECT_EQ(heading_at(1.57), Vec2(0.0, 1.0));
  EXPECT_EQ(heading_at(-1.5707963), Vec2(0.0, -1.0));
  EXPECT_EQ(heading_at(3.0 * 3.1415926), Vec2(-1.0, 0.0));
  EXPECT_NEAR(heading_at(0.5).x(), 0.877582561890373, 1e-15);
}

// Of an edge that nobody may drive, the actions count as little as the edge.
TEST(LifRules, AnEdgeThatIsLeftOutSaysNothingOfItsEnd) {
  const std::string pick = R"({"vehicleTypeId": "tug", "actions": [{"actionType": "pick"}]})";
  EXPECT_EQ(import({kFork, kFork, kFork, kFork, pick, kFork}).layout.stations[2].purposes, Purpose::Routing);
  EXPECT_TRUE(import({kBoth, kBoth, kBoth, kBoth, pick, kBoth}).layout.stations[2].purposes.has(Purpose::Storage));
}

const std::string kFloors = R"({"layouts": [
{"layoutId": "hall", "layoutLevelId": "0", "nodes": [{"nodeId": "a", "nodePosition": {"x": 0, "y": 0}},
{"nodeId": "b", "nodePosition": {"x": 5, "y": 0}}], "edges": [{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b"}]},
{"layoutId": "attic", "layoutLevelId": "1", "nodes": [{"nodeId": "c", "nodePosition": {"x": 0, "y": 0}},
{"nodeId": "d", "nodePosition": {"x": 5, "y": 0}}], "edges": [{"edgeId": "cd", "startNodeId": "c", "endNodeId": "d"},
{"edgeId": "ca", "startNodeId": "c", "endNodeId": "a"}]}]})";

TEST(LifLevels, OneOfSeveralLayoutsIsChosen) {
  const auto name_of_first = [](const std::string& level) {
    std::vector<std::string> warnings;
    return parse_lif(kFloors, "l.json", warnings, {TwinPaths::Merge, {}, level}).stations[0].name;
  };
  EXPECT_EQ(name_of_first("hall"), "a");
  EXPECT_EQ(name_of_first("attic"), "c");
  EXPECT_EQ(name_of_first("1"), "c");
  const std::string known = R"("hall" (level "0"), "attic" (level "1"))";
  EXPECT_THAT(independent::refusal(name_of_first, ""),
              AllOf(HasSubstr("there are 2 layouts; choose one by its id or level (import --level"), HasSubstr(known)));
  EXPECT_THAT(independent::refusal(name_of_first, "cellar"),
              HasSubstr("no layouts have the id or level \"cellar\"; choose one of: " + known));
}

TEST(LifLevels, AnIdCountsBeforeALevel) {
  std::string text = kFloors;
  text.replace(text.find("\"hall\""), 6, "\"1\"");
  std::vector<std::string> warnings;
  EXPECT_EQ(parse_lif(text, "l.json", warnings, {TwinPaths::Merge, {}, "1"}).stations[0].name, "a");
}

TEST(LifLevels, AnIdOfTwoLayoutsIsRefused) {
  std::string text = kFloors;
  text.replace(text.find("\"attic\""), 7, "\"hall\"");
  const auto read = [&](const std::string& level) {
    std::vector<std::string> warnings;
    return parse_lif(text, "l.json", warnings, {TwinPaths::Merge, {}, level});
  };
  EXPECT_THAT(independent::refusal(read, "hall"), HasSubstr("2 layouts have the id \"hall\"; ids are unique: rename"));
}

TEST(LifLevels, NodesOfAnotherLayoutAreNamed) {
  std::string text = kFloors;
  const std::string edge = R"("edges": [{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b"}])";
  text.replace(text.find(edge), edge.size(),
               edge + R"(, "stations": [{"stationId": "S", "interactionNodeIds": ["c"]}])");
  std::vector<std::string> warnings;
  parse_lif(text, "l.json", warnings, {TwinPaths::Merge, {}, "hall"});
  EXPECT_THAT(fmt::format("{}", fmt::join(warnings, "\n")),
              HasSubstr("1 nodes of stations are in another layout and are left out (\"c\")"));
}

TEST(LifLevels, LayoutsBesideOriginsCountToo) {
  const std::string text = R"({"origins": [)" + kFloors + "], " + kFloors.substr(1);
  std::vector<std::string> warnings;
  EXPECT_THAT(independent::refusal(
                  [&](const std::string& level) {
                    return parse_lif(text, "l.json", warnings, {TwinPaths::Merge, {}, level});
                  },
                  ""),
              HasSubstr("there are 4 layouts"));
}

}  // namespace
}  // namespace fleetproof::lif_rules_test
