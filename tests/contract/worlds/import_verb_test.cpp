// What `import` and campaigns say of layouts of other programs: sizes, units, vehicles, and files that are no layouts.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::import_verb_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ImportVerb : public test::ProgramTest {
 protected:
  // Two stations, 4 m apart, as tables with another extension.
  static constexpr const char* kTables = "id,x,y\na,0,0\nb,4,0\nfrom,to,bidirectional\na,b,true\n";
  static constexpr const char* kSheet = R"({"typeSpecification": {"seriesName": "fork"}, "physicalParameters":
    {"speedMax": 1.5, "accelerationMax": 0.5, "decelerationMax": 0.9, "length": 1.3, "width": 0.8}})";
  static constexpr const char* kNavGraph =
      "levels: {L1: {vertices: [[0, 0, {}], [4, 0, {}]], lanes: [[0, 1, {}], [1, 0, {}]]}}\n";

  std::string campaign(const std::string& layout, const std::string& rest = "") const {
    return "kind = \"search\"\nhorizon_s = 1\n[factors]\nagents = [\"hull-lock\"]\nfleet_sizes = [1]\nlayouts = [" +
           layout + "]\n" + rest;
  }
  void expect_named(const std::string& words, const std::string& what) const {
    const auto finished = run("import " + words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    EXPECT_THAT(finished.err, AllOf(StartsWith("error: "), HasSubstr(what))) << words;
    EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
  }
};

TEST_F(ImportVerb, SizesArePrinted) {
  write("a.csv", kTables);
  const auto finished = run("import a.csv -o l.json");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("size: 4 m x 0 m; segments of 4 m to 4 m, half of them up to 4 m, 4 m in all\n"));
}

TEST_F(ImportVerb, PlantsOfAnotherUnitAreQuestioned) {
  write("large.csv", "id,x,y\na,0,0\nb,4000,0\nfrom,to,bidirectional\na,b,true\n");
  EXPECT_THAT(run("import large.csv -o l.json").err, HasSubstr("centimetres or millimetres?"));
  write("small.csv", "id,x,y\na,0,0\nb,0.04,0\nfrom,to,bidirectional\na,b,true\n");
  EXPECT_THAT(run("import small.csv -o l.json").err, HasSubstr("metres where millimetres"));
  write("c.toml", campaign("\"large.csv\""));
  EXPECT_THAT(run("check c.toml").err, HasSubstr("centimetres or millimetres?"));
}

TEST_F(ImportVerb, VehiclesOfAnotherUnitAreQuestioned) {
  write("c.toml", campaign("\"aisle-grid\"", "[[vehicle]]\nname = \"v\"\nspeed_mps = 72\nlength_m = 1.8\n"));
  EXPECT_THAT(run("check c.toml").err, HasSubstr("vehicle \"v\": speed_mps is 72: is that in km/h"));
  write("d.toml", campaign("\"aisle-grid\"", "[[vehicle]]\nname = \"v\"\nspeed_mps = 1.5\n"));
  EXPECT_THAT(run("check d.toml").err, Not(HasSubstr("is that in")));
  write("tables.csv", kTables);
  std::string sheet = kSheet;
  sheet.replace(sheet.find("\"length\": 1.3"), 13, "\"length\": 18");
  write("sheet.json", sheet);
  EXPECT_THAT(run("import tables.csv --factsheet sheet.json --vehicles v.toml -o l.json").err,
              HasSubstr("vehicle \"fork\": length_m is 18: is that in millimetres"));
  run("run d.toml --db d.db");
  ASSERT_EQ(run("replay d.db 0 --scenario s.json").exit_code, 0);
  std::string scenario = read(path("s.json"));
  const auto at = scenario.find("\"speed_mps\": 1.5");
  ASSERT_NE(at, std::string::npos) << scenario;
  write("s.json", scenario.replace(at, 16, "\"speed_mps\": 72"));
  EXPECT_THAT(run("check s.json").err, HasSubstr("speed_mps is 72: is that in km/h"));
}

TEST_F(ImportVerb, WhatIsNoLayoutIsNamed) {
  write("order.json", R"({"headerId": 1, "orderId": "o", "nodes": [], "edges": []})");
  write("state.json", R"({"headerId": 1, "nodeStates": [], "edgeStates": []})");
  write("web.json", R"({"name": "p", "points": [], "paths": []})");
  write("map.yaml", "image: m.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  write("world.xml", "<sdf version=\"1.6\"/>");
  write("map.pgm", "P5\n1 1\n255\n0");
  expect_named("order.json", "order.json: is a VDA 5050 order");
  expect_named("lif order.json", "order.json: is a VDA 5050 order");
  expect_named("layout order.json", "order.json: is a VDA 5050 order");
  expect_named("state.json", "a VDA 5050 state");
  expect_named("web.json", "the web interface of openTCS");
  expect_named("map.yaml", "an occupancy map of ROS");
  expect_named("world.xml", "a world of Gazebo");
  expect_named("map.pgm", "an image (PGM)");
  write("c.toml", campaign("\"order.json\""));
  EXPECT_THAT(run("check c.toml").err, HasSubstr("is a VDA 5050 order"));
}

TEST_F(ImportVerb, PackedFilesAndOtherEncodingsAreNamedWithTheRemedy) {
  write("a.csv", "\x1f\x8b\x08");
  write("b.xml", "PK\x03\x04");
  write("c.csv", "id,x,y\ncaf\xe9,0,0\n");
  write("d.json", "{\"layout\": \"caf\xe9\"}");
  expect_named("a.csv", "is packed with gzip; unpack it with gunzip");
  expect_named("b.xml", "is a ZIP archive");
  expect_named("c.csv", "c.csv:2: the byte 0xe9 is none of UTF-8");
  expect_named("d.json", "d.json:1: the byte 0xe9 is none of UTF-8");
}

TEST_F(ImportVerb, AFormatMayBeNamedForAnyExtension) {
  write("plant.txt", kTables);
  expect_named("plant.txt", "has no extension of a layout file; known: .xml .json .yaml .yml .geojson .smap .map .csv");
  EXPECT_EQ(run("import csv plant.txt -o l.json").exit_code, 0);
  write("c.toml", campaign("{ file = \"plant.txt\", format = \"csv\" }"));
  const auto checked = run("check c.toml");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  write("d.toml", campaign("\"plant.txt\""));
  EXPECT_THAT(run("check d.toml").err, HasSubstr("or name its format: { file = \"plant.txt\", format = \"...\" }"));
  write("e.toml", campaign("{ file = \"plant.txt\", format = \"cvs\" }"));
  EXPECT_THAT(run("check e.toml").err, HasSubstr("there is no such format; did you mean \"csv\"?"));
  write("f.toml", campaign("{ mutate = \"plant.txt\", format = \"csv\", positions = \"plant\" }"));
  EXPECT_THAT(run("check f.toml").err, HasSubstr("positions has no meaning for format \"csv\"; it belongs to opentcs"));
}

TEST_F(ImportVerb, EveryFormatTakesAFactsheet) {
  write("sheet.json", kSheet);
  write("a.csv", kTables);
  write("g.yaml", kNavGraph);
  const auto model = test::source("tests/survey/files/today.xml");
  for (const std::string& words : {std::string("a.csv"), std::string("g.yaml"), "opentcs '" + model + "'"}) {
    const auto finished = run("import " + words + " --factsheet sheet.json --vehicles fork.toml -o l.json");
    EXPECT_EQ(finished.exit_code, 0) << words << finished.err;
    EXPECT_THAT(read(path("fork.toml")), HasSubstr("name = \"fork\"\nlength_m = 1.3\n")) << words;
  }
  expect_named("csv a.csv --factsheet sheet.json", "--factsheet: is given without --vehicles");
  EXPECT_THAT(run("import opentcs '" + model + "' --factsheet sheet.json --vehicles fork.toml -o l.json").err,
              HasSubstr("vehicles are left out"))
      << "those of the model";
  expect_named("csv a.csv --vehicles fork.toml", "the format \"csv\" has no vehicles; name their VDA 5050 factsheet");
  EXPECT_THAT(run("import opentcs '" + model + "' -o l.json").err, HasSubstr("vehicles are left out"));
  EXPECT_THAT(run("import opentcs '" + model + "' --vehicles v.toml -o l.json").err,
              Not(HasSubstr("vehicles are left out")));
}

TEST_F(ImportVerb, PositionsOfAModelAreChosen) {
  const auto model = test::source("tests/survey/files/today.xml");
  expect_named("opentcs '" + model + "' --positions plan", "did you mean \"plant\"?");
  EXPECT_EQ(run("import opentcs '" + model + "' --positions plant -o l.json").exit_code, 0);
  write("a.csv", kTables);
  expect_named("csv a.csv --positions plant", "has no meaning for format \"csv\"; it belongs to opentcs");
}

// A point that is drawn 1 m beside its place in the plant.
TEST_F(ImportVerb, PositionsAreChosenInACampaignToo) {
  write("m.xml",
        R"(<model version="6.0.0" name="m"><point name="a" positionX="0" positionY="0"><pointLayout positionX="0"
positionY="0"/></point><point name="b" positionX="9000" positionY="0"><pointLayout positionX="10000" positionY="0"/>
</point><path name="ab" sourcePoint="a" destinationPoint="b" length="9000" maxVelocity="1000"/><path name="ba"
sourcePoint="b" destinationPoint="a" length="9000" maxVelocity="1000"/><visualLayout name="v" scaleX="1" scaleY="1"/>
</model>)");
  const auto length_of = [&](const std::string& positions) {
    write("c.toml", campaign("{ file = \"m.xml\"" + positions + " }"));
    run("run c.toml --db c.db --overwrite");
    EXPECT_EQ(run("replay c.db 0 --scenario s.json").exit_code, 0);
    const auto sizes = run("import scenario s.json -o l.json").err;
    return sizes.substr(0, sizes.find(';')).substr(sizes.find("size: "));
  };
  EXPECT_EQ(length_of(""), "size: 9 m x 0 m");
  EXPECT_EQ(length_of(", positions = \"plant\""), "size: 9 m x 0 m");
  EXPECT_EQ(length_of(", positions = \"drawing\""), "size: 10 m x 0 m");
}

}  // namespace
}  // namespace fleetproof::import_verb_test
