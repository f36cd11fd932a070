#include "generators/formats/rmf.hpp"

#include <gtest/gtest.h>

#include "damage.hpp"
#include "real_layout.hpp"

namespace fleetproof::rmf_test {
namespace {

using independent::replaced;

const std::string kBuilding = R"(name: depot
coordinate_system: reference_image
levels:
  L1:
    lanes:
      - [0, 1, {bidirectional: [4, true], graph_idx: [2, 0], speed_limit: [3, 0]}]
      - [1, 2, {bidirectional: [4, false], graph_idx: [2, 0], speed_limit: [3, 0.5]}]
      - [2, 0, {graph_idx: [2, 1]}]
    measurements:
      - [3, 4, {distance: [3, 5]}]
      - [3, 4, {distance: [3, 15]}]
    vertices:
      - [0, 0, 0, dock, {is_charger: [4, true], is_parking_spot: [4, true]}]
      - [40, 10, 0, ""]
      - [40, 60, 0, dock, {pickup_dispenser: [1, rack]}]
      - [0, 0, 0, ""]
      - [100, 0, 0, ""]
)";

const std::string kNavGraph = R"(building_name: depot
levels:
  L1:
    lanes:
      - [0, 1, {speed_limit: 0}]
      - [1, 0, {speed_limit: 0}]
      - [1, 2, {}]
    vertices:
      - [0.0, 0.0, {name: dock, is_charger: true}]
      - [4.0, -1.0, {name: ""}]
      - [4.0, -6.0, {name: end, is_parking_spot: false}]
)";

struct Import {
  Layout layout;
  std::vector<std::string> warnings;  // without the one on twins
};

void drop_twins(std::vector<std::string>& warnings) {
  std::erase_if(warnings, [](const std::string& w) { return w.find("there and back") != std::string::npos; });
}

Import import_graph(const std::string& text, const RmfChoice& choice) {
  Import result;
  result.layout = parse_rmf(text, "b.yaml", result.warnings, choice);
  drop_twins(result.warnings);
  return result;
}

Import import(const std::string& text) { return import_graph(text, {}); }

TEST(Rmf, ABuildingIsScaledAndTurnedUp) {
  const auto [layout, warnings] = import(kBuilding);
  EXPECT_EQ(layout.name, "depot L1");
  ASSERT_EQ(layout.stations.size(), 3U) << "vertices without a lane are walls";
  EXPECT_EQ(layout.stations[1].position_m, Vec2(4.0, -1.0)) << "0.1 m per pixel, the mean of both measurements";
  EXPECT_EQ(layout.stations[1].name, "v1");
  EXPECT_EQ(layout.stations[0].purposes, Purposes(Purpose::Routing) | Purpose::Charging | Purpose::Parking);
  EXPECT_EQ(layout.stations[2].purposes, Purposes(Purpose::Routing) | Purpose::Storage);
  ASSERT_EQ(layout.segments.size(), 2U);
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_FALSE(layout.segments[1].bidirectional);
  EXPECT_EQ(layout.segments[0].speed_limit_mps, 0.0) << "0 means none";
  EXPECT_EQ(layout.segments[1].speed_limit_mps, 0.5);
  EXPECT_EQ(layout.segments[1].back_speed_limit_mps, 0.0);
  EXPECT_EQ(warnings, (std::vector<std::string>{"b.yaml:5: 2 measurements disagree by 100.0 %: a pixel has 0.05 m "
                                                "(b.yaml:10) to 0.15 m (b.yaml:11); their mean counts, 0.1 m",
                                                "b.yaml:15: a second vertex is named \"dock\"; it becomes \"v2\"",
                                                "b.yaml:6: 1 lanes of other graphs are left out",
                                                "b.yaml:16: 2 vertices lie on no lane that is read and are left out "
                                                "(\"v3\", \"v4\")"}));
}

// Names of the file come before those that are made up.
TEST(Rmf, AVertexWithoutANameTakesNoneOfTheFile) {
  const auto [layout, warnings] = import(replaced(kNavGraph, "name: end", "name: v1"));
  EXPECT_EQ(layout.stations[1].name, "v1_");
  EXPECT_EQ(layout.stations[2].name, "v1");
  EXPECT_TRUE(warnings.empty()) << warnings[0];
}

// Such as a place to stand and the charger in it.
TEST(Rmf, VerticesThatALaneWithoutALengthJoinsAreOneStation) {
  const auto [layout, warnings] = import(R"(building_name: depot
levels:
  L1:
    lanes:
      - [0, 1, {}]
      - [1, 0, {}]
      - [1, 3, {bidirectional: true, speed_limit: 0.3}]
      - [3, 4, {bidirectional: true}]
      - [4, 2, {}]
    vertices:
      - [0.0, 0.0, {name: "", is_parking_spot: true}]
      - [4.0, -1.0, {}]
      - [4.0, -6.0, {name: end}]
      - [4.0, -1.0, {name: CH_01, is_charger: true}]
      - [4.0, -1.0005, {name: CH_02, pickup_dispenser: rack}]
      - [9.0, 9.0, {name: CH_03, is_charger: true}]
)");
  ASSERT_EQ(layout.stations.size(), 3U);
  EXPECT_EQ(layout.stations[1].name, "CH_01") << "the first that has one";
  EXPECT_EQ(layout.stations[1].position_m, Vec2(4.0, -1.0));
  EXPECT_EQ(layout.stations[1].purposes, Purposes(Purpose::Routing) | Purpose::Charging | Purpose::Storage);
  ASSERT_EQ(layout.segments.size(), 2U);
  EXPECT_EQ(layout.segments[1].from, StationId{1U});
  EXPECT_EQ(layout.segments[1].to, StationId{2U});
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_EQ(
      warnings[0],
      "b.yaml:4: 2 lanes have no length; the vertices that they join are one station each (\"CH_01\"); 1 more names "
      "of theirs are left out (\"CH_02\")");
  EXPECT_EQ(warnings[2], "b.yaml:7: 1 kinds of attributes of lanes without a length are left out (\"speed_limit\")");
  EXPECT_EQ(warnings[1],
            "b.yaml:16: 1 chargers, parking spots, dispensers and ingestors lie on no lane that is read and are left "
            "out (\"CH_03\")");
}

TEST(Rmf, DoorsAndLiftsOfLanesWithoutALengthAreTold) {
  auto text =
      replaced(kNavGraph, "[1, 2, {}]\n", "[1, 2, {}]\n      - [2, 3, {door_name: gate, lift: up, mutex: m}]\n");
  text += "      - [4.0, -6.0, {name: lost}]\n";
  const auto sentences = fmt::format("{}", fmt::join(import(text).warnings, "\n"));
  for (const char* told : {"doors are left out (\"gate\")", "lifts are left out (\"up\")", "(\"mutex\")", "(\"lost\")"})
    EXPECT_NE(sentences.find(told), std::string::npos) << told << " in " << sentences;
}

// Twice as many pixels between the fiducials of L2 as between those of L1, where a pixel has 0.1 m.
TEST(Rmf, ALevelIsScaledByTheFiducialsThatItSharesWithTheReference) {
  const auto plant = [](const std::string& reference, const std::string& of_l2) {
    return "name: depot\n" + reference + R"(levels:
  L1:
    fiducials: [[0, 0, a], [30, 40, b], [0, 0, other]]
    measurements: [[0, 1, {distance: [3, 5]}]]
    lanes: [[0, 1, {}]]
    vertices: [[0, 0, 0, ""], [50, 0, 0, ""]]
  L2:
    fiducials: )" +
           of_l2 + R"(
    measurements: [[0, 1, {distance: [3, 100]}]]
    lanes: [[0, 1, {}]]
    vertices: [[0, 0, 0, ""], [100, 0, 0, ""]]
)";
  };
  const auto read = [](const std::string& text, const std::string& level) {
    return import_graph(text, {.level = level});
  };
  const std::string twice = "[[10, 10, b], [90, 70, a]]";
  const auto [layout, warnings] = read(plant("", twice), "L2");
  // Fiducial a is the origin of both, and b is turned by the angle whose cosine is -0.96.
  EXPECT_NEAR((layout.stations[0].position_m - Vec2(3.34, -4.62)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((layout.stations[1].position_m - Vec2(-1.46, -3.22)).norm(), 0.0, 1e-12);
  EXPECT_EQ(warnings[1],
            "b.yaml:9: by the fiducials that the level shares with reference level \"L1\", a pixel has 0.05 m; by its "
            "measurements, which do not count, 1 m; they shift the level by (3.340, -4.620) m, and turn it: its x axis "
            "then points to (-0.9600, 0.2800)");
  const auto moved = read(plant("", "[[100, 60, b], [40, -20, a]]"), "L2");
  EXPECT_NEAR((moved.layout.stations[0].position_m - Vec2(-2.0, -1.0)).norm(), 0.0, 1e-12) << "shifted alone";
  EXPECT_NEAR((moved.layout.stations[1].position_m - Vec2(3.0, -1.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(moved.warnings[1].find("turn it"), std::string::npos) << moved.warnings[1];
  EXPECT_EQ(warnings.size(), 2U) << "fiducials are not left out";
  EXPECT_NEAR(read(plant("reference_level_name: L2\n", twice), "L2").layout.stations[1].position_m.x(), 100.0, 1e-12);
  const auto alone = read(plant("", "[[10, 10, b]]"), "L2");
  EXPECT_NEAR(alone.layout.stations[1].position_m.x(), 100.0, 1e-12);
  EXPECT_NE(alone.warnings[1].find("shares no two fiducials with reference level \"L1\""), std::string::npos);
  const auto refused = [&](const std::string& text) {
    return independent::refusal([&](const std::string& t) { read(t, "L2"); }, text);
  };
  EXPECT_NE(refused(plant("reference_level_name: L3\n", twice)).find("b.yaml:2: reference_level_name is \"L3\", but"),
            std::string::npos);
  EXPECT_NE(refused(plant("", "[[10, 10, b], [10, 10, a]]")).find("two fiducials are on one spot"), std::string::npos);
  EXPECT_EQ(refused(plant("", "[[10, 10, \"\"], [10, 10, \"\"]]")), "accepted") << "fiducials without a name";
  const auto unmeasured = replaced(plant("", twice), "    measurements: [[0, 1, {distance: [3, 5]}]]\n", "");
  EXPECT_NE(read(unmeasured, "L2").warnings[1].find("a pixel has 0.5 m (there are no measurements on that level"),
            std::string::npos);
  EXPECT_NE(refused(plant("", "[[10, 10, b], [10]]")).find("b.yaml:9"), std::string::npos);
  const auto torn = read(replaced(plant("", twice), "[[0, 1, {distance: [3, 5]}]]",
                                  "[[0, 1, {distance: [3, 4]}], [0, 1, {distance: [3, 6]}]]"),
                         "L2");
  EXPECT_NE(torn.warnings[1].find("2 measurements disagree by 40.0 %"), std::string::npos) << "those of the reference";
}

TEST(Rmf, MeasurementsThatDisagreeAreToldWithTheirSpread) {
  EXPECT_EQ(import(kBuilding).warnings[0],
            "b.yaml:5: 2 measurements disagree by 100.0 %: a pixel has 0.05 m (b.yaml:10) to 0.15 m (b.yaml:11); their "
            "mean counts, 0.1 m");
  const auto told = [](const std::string& metres) {
    const auto warnings =
        import(replaced(replaced(kBuilding, "[3, 5]}", "[3, 10]}"), "[3, 15]", "[3, " + metres + "]")).warnings;
    return std::ranges::any_of(warnings, [](const auto& w) { return w.find("disagree") != std::string::npos; });
  };
  EXPECT_FALSE(told("10"));
  EXPECT_FALSE(told("10.1"));
  EXPECT_TRUE(told("10.3"));
}

TEST(Rmf, ASecondDocumentIsTold) {
  const auto [layout, warnings] = import("---\n" + kNavGraph + "---\nlevels: {}\n");
  EXPECT_EQ(layout.stations.size(), 3U);
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings[0].find("b.yaml:13: a second document of this file begins; the first alone is read"),
            std::string::npos);
  for (const char* nothing : {"...\n", "---\n", "---\n# nothing more\n...\n"})
    EXPECT_EQ(import("---\n" + kNavGraph + nothing).warnings, import(kNavGraph).warnings) << nothing;
}

TEST(Rmf, LanesMaySayIsBidirectional) {
  const auto text = replaced(kNavGraph, "      - [1, 2, {}]", "      - [1, 2, {is_bidirectional: true}]");
  EXPECT_TRUE(import(text).layout.segments.back().bidirectional);
  EXPECT_EQ(import(text).warnings, import(kNavGraph).warnings) << "it is known";
  const auto building = replaced(kBuilding, "{bidirectional: [4, false]", "{is_bidirectional: [4, true]");
  EXPECT_TRUE(import(building).layout.segments[1].bidirectional);
  EXPECT_FALSE(import(replaced(kNavGraph, "[1, 2, {}]", "[1, 2, {is_bidirectional: false}]"))
                   .layout.segments.back()
                   .bidirectional);
}

TEST(Rmf, BytesThatAreNoUtf8AreRefusedWithTheRemedy) {
  EXPECT_EQ(independent::refusal(import, replaced(kNavGraph, "name: end", "name: caf\xe9")),
            "b.yaml:11: the byte 0xe9 is none of UTF-8; if the file is in Latin-1 or Windows-1252, save it as UTF-8 "
            "(iconv -f WINDOWS-1252 -t UTF-8)");
}

TEST(Rmf, TheFirstLevelWithLanesIsRead) {
  const auto text = replaced(kBuilding, "levels:\n", "levels:\n  Basement:\n    vertices: []\n");
  const auto [layout, warnings] = import(text);
  EXPECT_EQ(layout.name, "depot L1");
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings[0], "b.yaml:4: of 2 levels, \"L1\" is read (levels: \"Basement\", \"L1\")");
  EXPECT_EQ(
      independent::refusal([](const std::string& t) { import_graph(t, {.level = "Basement"}); }, text),
      "b.yaml:5: level \"Basement\" has no lane; add some, or choose another level; levels of the file: \"Basement\", "
      "\"L1\"");
}

TEST(Rmf, AnotherGraphOrLevelCanBeChosen) {
  EXPECT_EQ(import_graph(kBuilding, {"", 1}).layout.segments.size(), 1U);
  EXPECT_EQ(import(replaced(kBuilding, "{graph_idx: [2, 1]}", "{}")).layout.segments.size(), 3U)
      << "a lane without graph_idx belongs to graph 0";
  const std::string unsaid = replaced(replaced(kBuilding, ", graph_idx: [2, 0]", ""), ", graph_idx: [2, 0]", "");
  for (const std::string& building : {kBuilding, unsaid}) {
    EXPECT_EQ(
        independent::refusal(
            [](const std::string& text) {
              import_graph(text, {"", 7});
            },
            building),
        "b.yaml:6: no lane of level \"L1\" belongs to graph 7; graphs of its lanes: 0, 1; levels of the file: \"L1\"");
  }
  EXPECT_EQ(independent::refusal(
                [](const std::string& text) {
                  import_graph(text, {"L2", 0});
                },
                kBuilding),
            "b.yaml:4: there is no level \"L2\"; levels of the file: \"L1\"");
}

TEST(Rmf, ANavGraphIsInMetresAndItsLanesArePaired) {
  const auto [layout, warnings] = import(kNavGraph);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  ASSERT_EQ(layout.stations.size(), 3U);
  EXPECT_EQ(layout.stations[1].position_m, Vec2(4.0, -1.0));
  EXPECT_EQ(layout.stations[0].name, "dock");
  EXPECT_EQ(layout.stations[2].purposes, Purposes(Purpose::Routing));
  ASSERT_EQ(layout.segments.size(), 2U);
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(independent::refusal(
                [](const std::string& text) {
                  import_graph(text, {"", 7});
                },
                kNavGraph),
            "b.yaml: is a nav graph, which is one graph alone; leave out graph 7");
}

TEST(Rmf, ScalesOfOtherKinds) {
  EXPECT_EQ(import(replaced(kBuilding, "reference_image", "cartesian_meters")).layout.stations[1].position_m,
            Vec2(40.0, 10.0));
  auto unmeasured =
      replaced(kBuilding, "      - [3, 4, {distance: [3, 5]}]\n      - [3, 4, {distance: [3, 15]}]\n", "      []\n");
  EXPECT_EQ(import(unmeasured).warnings[0], "b.yaml:5: there are no measurements; a pixel is taken as 1 m");
  EXPECT_EQ(independent::refusal(import, replaced(kBuilding, "reference_image", "wgs84")),
            "b.yaml:2: coordinate_system is \"wgs84\", which needs a map projection; generate nav graphs and import "
            "one of them");
}

TEST(Rmf, TrueAndFalseAreReadInEverySpellingOfYaml) {
  const auto with = [](const std::string& word) {
    const auto text = replaced(replaced(kBuilding, "{bidirectional: [4, true]", "{bidirectional: [4, " + word + "]"),
                               "{is_charger: [4, true]", "{is_charger: [4, " + word + "]");
    const auto layout = import(text).layout;
    EXPECT_EQ(layout.segments[0].bidirectional, layout.stations[0].purposes.has(Purpose::Charging)) << word;
    return layout.segments[0].bidirectional;
  };
  for (const char* word : {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON", "1"})
    EXPECT_TRUE(with(word)) << word;
  for (const char* word : {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF", "0", "~"})
    EXPECT_FALSE(with(word)) << word;
  const auto spots = [](const std::string& word) {
    const auto graph = replaced(kNavGraph, "is_parking_spot: false", "is_parking_spot: " + word);
    return import(graph).layout.stations[2].purposes.has(Purpose::Parking);
  };
  EXPECT_TRUE(spots("Yes")) << "without the number of a type";
  EXPECT_FALSE(spots("False"));
}

TEST(RmfErrors, WhatIsNeitherTrueNorFalseIsNamed) {
  const auto with = [](const std::string& value) {
    return independent::refusal(import, replaced(kBuilding, "bidirectional: [4, true]", "bidirectional: " + value));
  };
  EXPECT_EQ(with("[4, maybe]"), "b.yaml:6: bidirectional is \"maybe\"; expected true or false");
  EXPECT_EQ(with("tRUE"), "b.yaml:6: bidirectional is \"tRUE\"; expected true or false");
  EXPECT_EQ(with("[4, '']"), "b.yaml:6: bidirectional is \"\"; expected true or false");
  EXPECT_EQ(with("[4, 2]"), "b.yaml:6: bidirectional is \"2\"; expected true or false");
  EXPECT_EQ(with("[4, true, 7]"), "b.yaml:6: bidirectional is a list; expected true or false");
  EXPECT_EQ(with("{a: 1}"), "b.yaml:6: bidirectional is a map; expected true or false");
  EXPECT_EQ(independent::refusal(import, replaced(kBuilding, "is_charger: [4, true]", "is_charger: [4, n]")),
            "b.yaml:13: is_charger is \"n\"; expected true or false");
}

TEST(RmfErrors, NamePlaceValueAndRemedy) {
  const auto break_at = [](const std::string& from, const std::string& to) {
    return independent::refusal(import, replaced(kBuilding, from, to));
  };
  EXPECT_EQ(break_at("[0, 1, {bi", "[0, 9, {bi"), "b.yaml:6: a lane names vertex \"9\"; there are 0 to 4");
  EXPECT_EQ(break_at("[0, 1, {bi", "[0, -1, {bi"), "b.yaml:6: a lane names vertex \"-1\"; there are 0 to 4");
  EXPECT_EQ(break_at("[0, 1, {bi", "[1, 1, {bi"), "b.yaml:6: a lane leads from vertex 1 to itself; leave it out");
  EXPECT_EQ(break_at("[40, 10,", "[forty, 10,"), "b.yaml:14: x of a vertex is \"forty\"; expected a finite number");
  EXPECT_EQ(break_at("[40, 10,", "[.nan, 10,"), "b.yaml:14: x of a vertex is \".nan\"; expected a finite number");
  EXPECT_EQ(break_at("speed_limit: [3, 0.5]", "speed_limit: [3, -0.4]"),
            "b.yaml:7: speed_limit is -0.4; expected 0 (none), or 0.001 to 100 m/s");
  EXPECT_EQ(break_at("speed_limit: [3, 0.5]", "speed_limit: [3, 500]"),
            "b.yaml:7: speed_limit is 500; expected 0 (none), or 0.001 to 100 m/s");
  EXPECT_EQ(break_at("reference_image", "feet"),
            "b.yaml:2: coordinate_system is \"feet\"; here it is reference_image or cartesian_meters");
  EXPECT_EQ(break_at("[3, 5]", "[3, 0]"), "b.yaml:10: 0 m for 100 pixels give no scale; correct the measurement");
  EXPECT_EQ(break_at("vertices:", "vertixes:"), "b.yaml:5: the level has no \"vertices\"; add them");
  EXPECT_EQ(independent::refusal(import, "a: 1\n"),
            "b.yaml: has no \"levels\"; expected an Open-RMF building or nav graph");
  EXPECT_EQ(independent::refusal(import, ""), "b.yaml: has no \"levels\"; expected an Open-RMF building or nav graph");
  EXPECT_TRUE(independent::refusal(import, "a: [1, \n").starts_with("b.yaml:2:1: not YAML: "));
}

TEST(RmfErrors, AKeyThatIsThereTwiceIsNamed) {
  const auto twice = [](const std::string& text, const std::string& from, const std::string& to) {
    return independent::refusal(import, replaced(text, from, to));
  };
  const auto named = [](int line, const std::string& key) {
    return "b.yaml:" + std::to_string(line) + ": the key \"" + key + "\" is there twice; remove one of them";
  };
  EXPECT_EQ(twice(kBuilding, "{bidirectional: [4, true]", "{speed_limit: [3, 1], bidirectional: [4, true]"),
            named(6, "speed_limit"));
  EXPECT_EQ(twice(kBuilding, "{is_charger", "{is_charger: [4, false], is_charger"), named(13, "is_charger"));
  EXPECT_EQ(twice(kBuilding, "{distance", "{distance: [3, 1], distance"), named(10, "distance"));
  EXPECT_EQ(twice(kBuilding, "name: depot\n", "name: depot\nname: shed\n"), named(2, "name"));
  EXPECT_EQ(twice(kBuilding, "    measurements:", "    lanes: []\n    measurements:"), named(9, "lanes"));
  EXPECT_EQ(twice(kBuilding, "  L1:\n", "  L1: {}\n  L1:\n"), named(5, "L1"));
  EXPECT_EQ(twice(kNavGraph, "{name: dock", "{name: other, name: dock"), named(9, "name"));
}

TEST(RmfErrors, WhatHidesTheAttributesIsNamed) {
  const auto with = [](const std::string& text, const std::string& from, const std::string& to) {
    return independent::refusal(import, replaced(text, from, to));
  };
  const std::string lane = "; expected a lane [FROM, TO, {ATTRIBUTES}], and nothing else";
  EXPECT_EQ(with(kBuilding, "[1, 2, {bidirectional: [4, false], graph_idx: [2, 0], speed_limit: [3, 0.5]}]",
                 "[1, 2, {bidirectional: [4, false]}, 7]"),
            "b.yaml:7: item 4 is \"7\"" + lane);
  EXPECT_EQ(with(kBuilding, "[0, 1, {", "[0, 1, junk, {"), "b.yaml:6: item 3 is \"junk\"" + lane);
  EXPECT_EQ(with(kNavGraph, "[1, 2, {}]", "[1, 2, bidirectional]"), "b.yaml:7: item 3 is \"bidirectional\"" + lane);
  EXPECT_EQ(with(kNavGraph, "[1, 2, {}]", "[1, 2, {}, {}]"), "b.yaml:7: item 4 is a map" + lane);
  EXPECT_EQ(with(kNavGraph, "[1, 2, {}]", "[1, 2, ~]"), "accepted");
  const std::string vertex = "; expected a vertex [X, Y, Z, NAME, {ATTRIBUTES}], and nothing else";
  EXPECT_EQ(with(kBuilding, "{pickup_dispenser: [1, rack]}]", "{pickup_dispenser: [1, rack]}, 5]"),
            "b.yaml:15: item 6 is \"5\"" + vertex);
  EXPECT_EQ(with(kBuilding, "[40, 60, 0, dock,", "[40, 60, 0, dock, far,"), "b.yaml:15: item 5 is \"far\"" + vertex);
  EXPECT_EQ(with(kNavGraph, "{name: dock, is_charger: true}]", "{name: dock, is_charger: true}, 1]"),
            "b.yaml:9: item 4 is \"1\"; expected a vertex [X, Y, {ATTRIBUTES}], and nothing else");
  EXPECT_EQ(with(kBuilding, "{distance: [3, 5]}", "{distance: [3, 5]}, 9"),
            "b.yaml:10: item 4 is \"9\"; expected a measurement [FROM, TO, {ATTRIBUTES}], and nothing else");
}

TEST(RmfErrors, CanBePrintedWhateverTheFileHolds) {
  EXPECT_EQ(independent::refusal(import, "levels: \"\\\x80\"\n"),
            "b.yaml:1: the byte 0x80 is none of UTF-8; if the file is in Latin-1 or Windows-1252, save it as UTF-8 "
            "(iconv -f WINDOWS-1252 -t UTF-8)");
  EXPECT_EQ(independent::refusal(import, "levels: \"\\\x01\"\n"),
            "b.yaml:1:12: not YAML: unknown escape character: \\x01");
  EXPECT_LT(independent::refusal(import, "levels: *" + std::string(5000, 'x') + "\n").size(), 300U);
}

TEST(RmfErrors, AVertexThatIsNoListIsNamed) {
  EXPECT_EQ(independent::refusal(import, "levels: {L: {vertices: [{a: 1, b: 2, c: 3}, [1, 2]], lanes: [[0, 1]]}}\n"),
            "b.yaml:1: a vertex is a map of 3 items; expected more");
}

TEST(RmfErrors, CutAndDamagedFilesAreReadOrRefused) {
  for (const auto& text : {kBuilding, kNavGraph}) {
    independent::bear_cuts(import, text, 100);
    independent::bear_damage(import, text, 1500, "0123456789-.:[]{},&*!|>'\"%@`#? \n\t\x80\xff");
  }
  EXPECT_NO_THROW(independent::refusal(import, std::string(100'000, '[')));
  EXPECT_NO_THROW(independent::refusal(import, std::string(100'000, '{')));
}

TEST(RealLayouts, OpenRmf) {
  struct Expected {
    const char* name;
    std::size_t stations, directed;
  };
  for (const auto& [name, stations, lanes] : {Expected{"triple_H", 23, 44}, {"office", 29, 60}}) {
    const auto path = independent::real_layout(std::string("rmf/") + name + ".building.yaml");
    FLEETPROOF_SKIP_IF_ABSENT(path);
    std::vector<std::string> warnings;
    const auto layout = read_rmf(path, warnings);
    EXPECT_EQ(layout.stations.size(), stations) << name;
    EXPECT_EQ(independent::directed(layout), lanes) << name;
    EXPECT_TRUE(independent::all_reach_all(layout)) << name;
  }
}

TEST(RealLayouts, TripleHIsScaledByItsMeasurement) {
  const auto path = independent::real_layout("rmf/triple_H.building.yaml");
  FLEETPROOF_SKIP_IF_ABSENT(path);
  std::vector<std::string> warnings;
  const auto layout = read_rmf(path, warnings);
  EXPECT_EQ(layout.stations[0].name, "TopLeft");
  EXPECT_NEAR(layout.stations[0].position_m.x(), 46.368 * 0.04417, 0.001);
  EXPECT_NEAR(layout.stations[0].position_m.y(), -40.342 * 0.04417, 0.001);
}

}  // namespace
}  // namespace fleetproof::rmf_test
