// What the stations of a LIF layout say, and edges that are lines on the floor.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "generators/formats/lif.hpp"

namespace fleetproof::lif_stations_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Plant {
  Layout layout;
  std::string sentences;
};

// Two nodes, 5 m apart, a station at node b, and what else the station, the node and the edge say.
Plant plant(const std::string& station, const std::string& node = "", const std::string& rule = "",
            const std::string& words = "") {
  const auto text = fmt::format(R"({{"layouts": [{{"layoutId": "L", "nodes": [
{{"nodeId": "a", "mapId": "floor", "nodePosition": {{"x": 0, "y": 0}}}},
{{"nodeId": "b", {}"nodePosition": {{"x": 5, "y": 0}}}}],
"edges": [{{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b", "vehicleTypeEdgeProperties": [{{{}}}]}}],
"stations": [{{{}"stationId": "S", "interactionNodeIds": ["b"]}}]}}]}})",
                                node, rule, station);
  ReadChoice choice;
  choice.purposes = purpose_words_of(words, "--purposes");
  Plant read;
  std::vector<std::string> warnings;
  read.layout = parse_lif(text, "p.json", warnings, choice);
  for (const auto& warning : warnings) read.sentences += warning + "\n";
  return read;
}

Purposes purposes_of(const std::string& type, const std::string& words = "") {
  return plant(fmt::format("\"stationType\": \"{}\", ", type), "", "", words).layout.stations[1].purposes;
}

TEST(LifStations, TheTypeSaysWhatTheNodesAreFor) {
  const auto routing = Purposes(Purpose::Routing);
  EXPECT_EQ(purposes_of("CHARGING"), routing | Purpose::Charging);
  EXPECT_EQ(purposes_of("PARKING"), routing | Purpose::Parking);
  EXPECT_EQ(purposes_of("PICK"), routing | Purpose::Storage);
  EXPECT_EQ(purposes_of("pickAndDrop"), routing | Purpose::Storage);
  EXPECT_EQ(purposes_of("battery charger"), routing | Purpose::Charging);
  EXPECT_THAT(plant("\"stationType\": \"CHARGING\", ").sentences, Not(HasSubstr("storage")));
}

TEST(LifStations, WordsOfTheUserComeFirst) {
  EXPECT_EQ(purposes_of("CHARGING", "CHARGING=parking"), Purposes(Purpose::Routing) | Purpose::Parking);
  EXPECT_EQ(purposes_of("washing", "washing=storage"), Purposes(Purpose::Routing) | Purpose::Storage);
}

TEST(LifStations, ATypeThatSaysNothingIsTold) {
  EXPECT_THAT(plant("\"stationType\": \"washing\", ").sentences,
              AllOf(HasSubstr("1 types of stations say nothing that is known here (\"washing\")"),
                    HasSubstr("they are taken to be for storage")));
}

TEST(LifStations, ANodeThatForbidsTransfersGetsNone) {
  const auto read =
      plant("\"stationType\": \"PICK\", ", R"("vehicleTypeNodeProperties": [{"forbiddenActionTypes": ["pick"]}], )");
  EXPECT_EQ(read.layout.stations[1].purposes, Purposes(Purpose::Routing));
  EXPECT_THAT(read.sentences, HasSubstr("they forbid to pick or drop"));
}

TEST(LifStations, ALineOfAnotherLengthThanDrawnIsAsked) {
  const auto with = [](double length_m) {
    return plant("", "",
                 fmt::format(R"("physicalLineGuidedProperty": {{"direction": "left", "length": {}}})", length_m))
        .sentences;
  };
  EXPECT_THAT(with(7.5),
              HasSubstr("1 lines that guide AGVs have another length than is drawn, which counts (\"ab\"; the "
                        "first with 7.500 m instead of 5.000 m); does the line bend?"));
  EXPECT_THAT(with(5.2), HasSubstr("5.200 m instead of 5.000 m"));
  EXPECT_THAT(with(5.05), Not(HasSubstr("another length")));
  EXPECT_THAT(with(5.05), HasSubstr("1 edges are lines on the floor that guide AGVs (\"ab\")"));
}

TEST(LifStations, SeveralMapsAreTold) {
  EXPECT_THAT(plant("", "\"mapId\": \"roof\", ").sentences, HasSubstr("nodes lie on 2 maps (\"floor\", \"roof\")"));
  EXPECT_THAT(plant("", "\"mapId\": \"floor\", ").sentences, Not(HasSubstr("maps")));
}

}  // namespace
}  // namespace fleetproof::lif_stations_test
