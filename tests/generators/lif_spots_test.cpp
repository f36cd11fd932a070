// Edges of no length in LIF: an AGV turns on the spot, and the nodes that they join are one station.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "damage.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/lif_text.hpp"

namespace fleetproof::lif_spots_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Plant {
  Layout layout;
  std::string sentences;
};

// Nodes a, b and c: b and c at one place, edges ab, turn (from b to c) and cd to a node d. Each text is the list of
// rules of one element, or what else is added.
struct Rules {
  std::string a{}, b{}, c{}, d{}, ab{}, turn{}, cd{}, more_edges{}, stations{};
  std::string c_place = R"("x": 5, "y": 0)";
};

std::string edge(const char* from, const char* to, const std::string& rules) {
  return fmt::format(R"({{"edgeId": "{0}{1}", "startNodeId": "{0}", "endNodeId": "{1}",
"vehicleTypeEdgeProperties": [{2}]}})",
                     from, to, rules);
}

std::string file_of(const Rules& rules) {
  const auto node = [](const char* name, const std::string& place, const std::string& list) {
    return fmt::format(R"({{"nodeId": "{}", "nodePosition": {{{}}}, "vehicleTypeNodeProperties": [{}]}})", name, place,
                       list);
  };
  return fmt::format(R"({{"layouts": [{{"layoutId": "L", "nodes": [{},
{},
{},
{}], "edges": [{},
{},
{}{}], "stations": [{}]}}]}})",
                     node("a", R"("x": 0, "y": 0)", rules.a), node("b", R"("x": 5, "y": 0)", rules.b),
                     node("c", rules.c_place, rules.c), node("d", R"("x": 5, "y": 5)", rules.d),
                     edge("a", "b", rules.ab), edge("b", "c", rules.turn), edge("c", "d", rules.cd), rules.more_edges,
                     rules.stations);
}

Plant import_with(const std::string& text, const PurposeWords& purposes) {
  Plant plant;
  std::vector<std::string> warnings;
  plant.layout = parse_lif(text, "l.json", warnings, {TwinPaths::Keep, purposes, ""});
  plant.sentences = fmt::format("{}", fmt::join(warnings, "\n"));
  return plant;
}

Plant import(const Rules& rules, const PurposeWords& purposes = {}) { return import_with(file_of(rules), purposes); }
Plant import_text(const std::string& text) { return import_with(text, {}); }

std::vector<std::string> stations(const Plant& plant) {
  std::vector<std::string> names;
  for (const Station& station : plant.layout.stations) names.push_back(station.name + (station.turning ? "" : "!"));
  return names;
}

std::vector<std::string> segments(const Plant& plant) {
  std::vector<std::string> words;
  for (const Segment& segment : plant.layout.segments) {
    words.push_back(segment.name + ": " + plant.layout.stations.at(segment.from.index()).name + " " +
                    plant.layout.stations.at(segment.to.index()).name);
  }
  return words;
}

const std::string kNoTurn =
    R"({"rotationAllowed": false, "rotationAtStartNodeAllowed": "NONE", "rotationAtEndNodeAllowed": "NONE"})";
const std::string kFork = R"({"vehicleTypeId": "fork"})", kBoth = kFork + R"(, {"vehicleTypeId": "tug"})";

TEST(LifSpots, NodesThatAnEdgeOfNoLengthJoinsAreOneStation) {
  const auto plant = import({.b = R"({"actions": [{"actionType": "drop"}]})",
                             .c = R"({"actions": [{"actionType": "startCharging"}]})",
                             .turn = R"({"rotationAllowed": false, "rotationAtStartNodeAllowed": "CW"})"});
  EXPECT_THAT(stations(plant), ElementsAre("a", "b", "d"));
  EXPECT_THAT(segments(plant), ElementsAre("ab: a b", "cd: b d"));
  EXPECT_EQ(plant.layout.stations[1].purposes,
            Purposes(Purpose::Routing) | Purposes(Purpose::Storage) | Purposes(Purpose::Charging));
  EXPECT_THAT(plant.sentences,
              HasSubstr("l.json:6: 1 stations have edges of no length, on which AGVs turn on the spot (\"b\" with "
                        "\"c\"); nodes that such an edge joins are one station here"));
  EXPECT_THAT(plant.sentences, HasSubstr("1 nodes let an AGV turn in one sense only (\"b\")"));
  std::vector<std::string> warnings;
  EXPECT_EQ(to_text(parse_lif(to_lif(plant.layout), "l.json", warnings)), to_text(plant.layout));
}

TEST(LifSpots, AnEdgeFromANodeToItselfIsATurn) {
  const auto plant = import({.turn = kNoTurn, .more_edges = ", " + edge("d", "d", R"({"rotationAllowed": true})")});
  EXPECT_THAT(segments(plant), ElementsAre("ab: a b", "cd: b d"));
  EXPECT_THAT(plant.sentences,
              HasSubstr("1 stations have edges of no length, on which AGVs turn on the spot (\"d\");"));
}

TEST(LifSpots, ManyNodesAreOneStationInWhateverOrder) {
  std::string more;
  for (const char* pair : {"fe", "ef", "ec", "gb"})
    more += ", " + edge(std::string(1, pair[0]).c_str(), std::string(1, pair[1]).c_str(), "");
  auto text = file_of({.more_edges = more});
  std::string nodes;
  for (const char* name : {"e", "f", "g"})
    nodes += fmt::format(R"({{"nodeId": "{}", "nodePosition": {{"x": 5, "y": 0}}}}, )", name);
  text.insert(text.find(R"({"nodeId": "b")"), nodes);
  const auto plant = import_text(text);
  EXPECT_THAT(stations(plant), ElementsAre("a", "e", "d"));
  EXPECT_THAT(segments(plant), ElementsAre("ab: a e", "cd: e d"));
  EXPECT_THAT(plant.sentences, HasSubstr("(\"e\" with \"f\", \"g\", \"b\", \"c\")"));
}

TEST(LifSpots, AnEdgeThatForbidsTurnsCounts) {
  const auto plant = import({.turn = kNoTurn});
  EXPECT_THAT(stations(plant), ElementsAre("a", "b!", "d"));
  EXPECT_THAT(plant.sentences,
              HasSubstr("1 stations have edges of no length, and no edge lets an AGV turn there (\"b\" with \"c\")"));
  EXPECT_THAT(plant.sentences, Not(HasSubstr("AGVs turn on the spot")));
  const auto elsewhere = import({.turn = kNoTurn, .more_edges = ", " + edge("b", "a", "")});
  EXPECT_THAT(stations(elsewhere), ElementsAre("a", "b", "d")) << "from ab to ba";
  EXPECT_THAT(elsewhere.sentences, HasSubstr("1 stations do not let an AGV turn at each of their nodes (\"b\" with"));
}

TEST(LifSpots, AnAgvThatTurnsOnTheEdgeTurnsAtTheStation) {
  for (const char* turns : {R"("rotationAllowed": true)", R"("reachOrientationBeforeEntering": false)"}) {
    auto rule = kNoTurn;
    rule.replace(1, std::string(R"("rotationAllowed": false)").size(), turns);
    const auto plant = import({.ab = kNoTurn, .turn = rule, .cd = kNoTurn});
    EXPECT_THAT(stations(plant), ElementsAre("a!", "b", "d!")) << turns;
    EXPECT_THAT(plant.sentences, HasSubstr("1 stations do not let an AGV turn at each of their nodes (\"b\" with"));
  }
  EXPECT_THAT(stations(import({.ab = kNoTurn, .turn = kNoTurn, .cd = kNoTurn})), ElementsAre("a!", "b!", "d!"));
}

TEST(LifSpots, ANodeWithoutTurnsIsNotSaidOfTheOthers) {
  EXPECT_THAT(import({}).sentences, Not(HasSubstr("do not let")));
}

TEST(LifSpots, HeadingsThatDifferAreTold) {
  const auto alike = import({.c = R"({"theta": 0})"});
  EXPECT_EQ(alike.layout.stations[1].heading, std::optional(Vec2(1.0, 0.0)));
  EXPECT_THAT(alike.sentences, Not(HasSubstr("one heading")));
  const auto unlike = import({.b = R"({"theta": 0})", .c = R"({"theta": 1.57})"});
  EXPECT_EQ(unlike.layout.stations[1].heading, std::nullopt);
  EXPECT_THAT(unlike.sentences,
              HasSubstr("the nodes of 1 stations do not ask for one heading (\"b\" with \"c\"); here the one for "
                        "which those with tasks ask holds for all tasks there; if they ask for several, an AGV stands "
                        "as it arrives"));
}

TEST(LifSpots, TheHeadingOfATaskIsThatOfItsNode) {
  const std::string pick = R"("actions": [{"actionType": "pick"}])";
  const auto elsewhere = import({.b = R"({"theta": 0})", .c = "{" + pick + "}"});
  EXPECT_EQ(elsewhere.layout.stations[1].heading, std::nullopt) << "the node with the task asks for none";
  EXPECT_THAT(elsewhere.sentences, HasSubstr("do not ask for one heading"));
  const auto here = import({.b = R"({"theta": 1.57})", .c = R"({"theta": 0, )" + pick + "}"});
  EXPECT_EQ(here.layout.stations[1].heading, std::optional(Vec2(1.0, 0.0)));
  EXPECT_THAT(here.sentences, HasSubstr("do not ask for one heading"));
  const auto by_edge = import({.b = R"({"theta": 0})", .c = R"({"theta": 1.57})", .ab = "{" + pick + "}"});
  EXPECT_EQ(by_edge.layout.stations[1].heading, std::optional(Vec2(1.0, 0.0)));
  const auto both = import({.b = R"({"theta": 0, )" + pick + "}", .c = "{" + pick + "}"});
  EXPECT_EQ(both.layout.stations[1].heading, std::optional(Vec2(1.0, 0.0)));
  EXPECT_THAT(both.sentences, HasSubstr("do not ask for one heading"));
}

TEST(LifSpots, AnEdgeBetweenNodesThatAreOneStationIsRefused) {
  const auto loop = edge("b", "c",
                         "{\"trajectory\": {\"knotVector\": [0, 0, 0.5, 1, 1], \"controlPoints\": [{\"x\": 5, "
                         "\"y\": 0}, {\"x\": 7, \"y\": 2}, {\"x\": 5, \"y\": 0}]}}");
  std::string named = loop;
  named.replace(named.find("\"bc\""), 4, "\"loop\"");
  try {
    import({.more_edges = ", " + named});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("its two nodes are one station here, because edges of no length join them"));
  }
}

TEST(LifSpots, TypesAreAskedForAtTheNodesOfTheFile) {
  const auto plant = import({kBoth, kBoth, kFork, kBoth, kBoth, kBoth, kBoth});
  EXPECT_THAT(plant.layout.segments[0].permissions, IsEmpty());
  EXPECT_THAT(plant.layout.segments[1].permissions, ElementsAre(Permission{"fork", LoadState::Any}));
  EXPECT_THAT(plant.sentences, HasSubstr("edges of no length at 1 stations are for some AGVs or loads only"));
  EXPECT_THAT(plant.sentences, HasSubstr("1 of 2 edges are for some types of vehicles only"));
}

TEST(LifSpots, AnEdgeForNobodyJoinsNothing) {
  const auto plant = import({kFork, kFork, R"({"vehicleTypeId": "tug"})", kBoth, kFork, kFork, kBoth});
  EXPECT_THAT(stations(plant), ElementsAre("a", "b", "c", "d"));
  EXPECT_THAT(plant.sentences, HasSubstr("l.json:6: no AGV may drive 1 edges (\"bc\")"));
}

TEST(LifSpots, ATurnedNodeOfAStationNeedsNoPurposeOfItsOwn) {
  const auto plant = import({.b = R"({"actions": [{"actionType": "startCharging"}]})",
                             .stations = R"({"stationId": "S", "interactionNodeIds": ["b", "c"]})"});
  EXPECT_EQ(plant.layout.stations[1].purposes, Purposes(Purpose::Routing) | Purposes(Purpose::Charging));
  EXPECT_THAT(plant.sentences, Not(HasSubstr("taken to be for storage")));
}

// A purpose is guessed for a node of a station only if no action says one.
TEST(LifSpots, AWordOfTheUserIsNoGap) {
  const Rules plant{.a = R"({"actions": [{"actionType": "wait"}]})",
                    .stations = R"({"stationId": "S", "interactionNodeIds": ["a"]})"};
  const auto guessed = import(plant);
  EXPECT_TRUE(guessed.layout.stations[0].purposes.has(Purpose::Storage));
  EXPECT_THAT(
      guessed.sentences,
      HasSubstr(
          "no action says what 1 nodes are for, which belong to stations (\"a\"); they are taken to be for storage"));
  const auto told = import(plant, purpose_words_of("wait=routing", "--purposes"));
  EXPECT_EQ(told.layout.stations[0].purposes, Purpose::Routing);
  EXPECT_THAT(told.sentences, Not(HasSubstr("what node")));
}

TEST(LifSpots, ASpeedLimitOnTheSpotIsTold) {
  EXPECT_THAT(import({.turn = R"({"maxSpeed": 0.3})"}).sentences,
              HasSubstr("edges of no length have a speed limit at 1 stations (\"b\" with \"c\"); it is left out"));
}

TEST(LifSpots, AnEdgeWithALengthIsNone) {
  const auto refused = [](const Rules& rules) { return independent::refusal(import_text, file_of(rules)); };
  EXPECT_THAT(refused({.c_place = R"("x": 5.005, "y": 0)"}), HasSubstr("l.json:6: /layouts/0/edges/1/edgeId"));
  const std::string loop = R"({"trajectory": {"degree": 3, "knotVector": [0, 0, 0, 0, 1, 1, 1, 1], "controlPoints":
[{"x": 5, "y": 0}, {"x": 9, "y": 4}, {"x": 1, "y": 4}, {"x": 5, "y": 0}]}})";
  EXPECT_THAT(refused({.more_edges = ", " + edge("b", "b", loop)}), HasSubstr("leads from a node back to itself"));
  EXPECT_THAT(stations(import({.turn = loop})), ElementsAre("a", "b", "c", "d"));
}

TEST(LifSpots, AFaultIsNamedWhereItIsBehindAJoinedNode) {
  auto text = file_of({});
  text.replace(text.find(R"("x": 5, "y": 5)"), 14, R"("x": 5, "y": 5e9)");
  EXPECT_THAT(independent::refusal(import_text, text),
              HasSubstr("l.json:4: /layouts/0/nodes/3/nodeId: \"d\" is refused: coordinates lie within"));
}

}  // namespace
}  // namespace fleetproof::lif_spots_test
