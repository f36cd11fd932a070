// Nothing in an Open-RMF file is dropped silently: each part, and each attribute of vertices and lanes that the traffic
// editor and the makers of nav graphs write, changes the import or yields a sentence.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/rmf.hpp"

namespace fleetproof::rmf_left_out_test {
namespace {

const std::string kBuilding = R"(ROOT
name: depot
levels:
  L1:
    LEVEL
    measurements: [[0, 1, {distance: [3, 4]}]]
    lanes:
      - [0, 1, {LANE bidirectional: [4, true], graph_idx: [2, 0]}]
    vertices:
      - [0, 0, 0, dock, {VERTEX is_charger: [4, false]}]
      - [40, 0, ZED, gate]
)";

const std::string kNavGraph = R"(ROOT
building_name: depot
levels:
  L1:
    LEVEL
    lanes:
      - [0, 1, {LANE speed_limit: 0}]
      - [1, 0, {speed_limit: 0}]
    vertices:
      - [0.0, 0.0, {VERTEX name: dock}]
      - [4.0, ZED, {name: gate}]
)";

struct Thing {
  const char* place;
  const char* added;
  const char* names;  // what the sentence has to name; "": the import changes

  friend void PrintTo(const Thing& t, std::ostream* out) { *out << t.place << " " << t.added; }
};

const Thing kThings[] = {
    {"ROOT", "crowd_sim: {enable: 0}", "\"crowd_sim\""},
    {"ROOT", "graphs: {0: {name: g}}", "\"graphs\""},
    {"ROOT", "parameters: {p: 1}", "\"parameters\""},
    {"ROOT", "lifts: {north: {depth: 2}, south: {depth: 2}}", "2 lifts are left out (\"north\", \"south\")"},
    {"ROOT", "coordinate_system: cartesian_meters", ""},
    {"ROOT", "reference_level_name: L1", "\"reference_level_name\""},
    {"LEVEL", "doors: [[0, 1, {name: [1, main]}], [0, 1, {}]]", "2 doors are left out (\"main\", \"door 1\")"},
    {"LEVEL", "doors: {main: {type: hinged}}", "1 doors are left out (\"main\")"},
    {"LEVEL", "walls: [[0, 1, {}]]", "\"walls\""},
    {"LEVEL", "floors: [{vertices: [0, 1]}]", "\"floors\""},
    {"LEVEL", "drawing: {filename: a.png}", "\"drawing\""},
    {"LEVEL", "elevation: 3", "\"elevation\""},
    {"LEVEL", "models: [{name: a}]", "\"models\""},
    {"LEVEL", "layers: {a: {}}", "\"layers\""},
    {"LEVEL", "fiducials: [[0, 1, a]]", "\"fiducials\""},
    {"LEVEL", "features: [{x: 1}]", "\"features\""},
    {"LEVEL", "constraints: [{x: 1}]", "\"constraints\""},
    {"LEVEL", "human_lanes: [[0, 1, {}]]", "\"human_lanes\""},
    {"LEVEL", "whatever: [1]", "\"whatever\""},
    {"VERTEX", "is_parking_spot: [4, true], ", ""},
    {"VERTEX", "pickup_dispenser: [1, rack], ", ""},
    {"VERTEX", "dropoff_ingestor: [1, rack], ", ""},
    {"VERTEX", "lift_cabin: [1, north], ", "1 vertices lie in lifts (\"dock\")"},
    {"VERTEX", "is_holding_point: [4, true], ", "is_holding_point of 1 vertices"},
    {"VERTEX", "is_passthrough_point: [4, true], ", "is_passthrough_point of 1 vertices"},
    {"VERTEX", "is_cleaning_zone: [4, true], ", "\"is_cleaning_zone\""},
    {"VERTEX", "human_goal_set_name: [1, a], ", "\"human_goal_set_name\""},
    {"VERTEX", "merge_radius: [3, 0.5], ", "\"merge_radius\""},
    {"VERTEX", "mutex: [1, narrow], ", "\"narrow\""},
    {"VERTEX", "dock_name: [1, pier], ", "\"pier\""},
    {"VERTEX", "spawn_robot_name: [1, tim], ", "\"tim\""},
    {"VERTEX", "spawn_robot_type: [1, mule], ", "1 types of robots are left out (\"mule\")"},
    {"VERTEX", "whatever: [1, x], ", "\"whatever\""},
    {"LANE", "orientation: [1, backward], ", ""},
    {"LANE", "orientation_constraint: backward, ", ""},
    {"LANE", "mutex: [1, narrow], ", ""},
    {"LANE", "dock_name: [1, pier], ", "\"pier\""},
    {"LANE", "undock_name: [1, pier], ", "\"pier\""},
    {"LANE", "door_name: main, ", "1 doors are left out (\"main\")"},
    {"LANE", "lift: north, ", "1 lifts are left out (\"north\")"},
    {"LANE", "demo_mock_lift_name: [1, x], ", "\"demo_mock_lift_name\""},
    {"LANE", "demo_mock_floor_name: [1, x], ", "\"demo_mock_floor_name\""},
    {"LANE", "whatever: [1, x], ", "\"whatever\""},
};

std::string filled(std::string text, const Thing* thing) {
  for (const char* place : {"ROOT", "LEVEL", "VERTEX", "LANE", "ZED"}) {
    const std::string added = thing != nullptr && std::string(thing->place) == place ? thing->added
                              : std::string(place) == "ZED"                          ? "0"
                                                                                     : "";
    text.replace(text.find(place), std::string(place).size(), added);
  }
  return text;
}

struct Import {
  std::string layout;
  std::string sentences;
};

Import import(const std::string& text) {
  Import result;
  std::vector<std::string> warnings;
  result.layout = to_text(parse_rmf(text, "b.yaml", warnings));
  for (const auto& warning : warnings) result.sentences += warning + "\n";
  return result;
}

class RmfThing : public testing::TestWithParam<Thing> {};

TEST_P(RmfThing, ChangesTheImportOrYieldsASentence) {
  for (const auto& file : {kBuilding, kNavGraph}) {
    // Nav graphs have their coordinates in metres whatever they say.
    if (file == kNavGraph && std::string(GetParam().added).starts_with("coordinate_system")) continue;
    const Import without = import(filled(file, nullptr)), with = import(filled(file, &GetParam()));
    const std::string names = GetParam().names;
    if (names.empty()) {
      EXPECT_NE(with.layout, without.layout) << "dropped silently";
    } else {
      EXPECT_NE(with.sentences.find(names), std::string::npos) << with.sentences;
      EXPECT_EQ(without.sentences.find(names), std::string::npos) << without.sentences;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RmfThing, testing::ValuesIn(kThings));

TEST(RmfThings, WhatIsFalseIsNotNamed) {
  for (const char* word : {"false", "False", "NO", "off", "0"}) {
    const auto added = "is_holding_point: [4, " + std::string(word) + "], pickup_dispenser: " + word + ", ";
    const Thing thing{"VERTEX", added.c_str(), ""};
    const Import with = import(filled(kBuilding, &thing)), without = import(filled(kBuilding, nullptr));
    EXPECT_EQ(with.sentences, without.sentences) << word;
    EXPECT_EQ(with.layout, without.layout) << word;
  }
}

TEST(RmfThings, AVertexAboveTheFloorIsNamed) {
  const Thing high{"ZED", "1.5", ""};
  EXPECT_NE(import(filled(kBuilding, &high)).sentences.find("1 vertices lie above or below the floor (\"gate\")"),
            std::string::npos);
}

}  // namespace
}  // namespace fleetproof::rmf_left_out_test
