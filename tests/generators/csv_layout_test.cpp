#include "generators/formats/csv_layout.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "damage.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/opentcs.hpp"
#include "real_layout.hpp"

namespace fleetproof::csv_layout_test {
namespace {

using independent::replaced;

const std::string kTables = R"(# a fork of three nodes
id,x,y,purposes
dock,0,0,storage parking
fork,4.5,0,
"end, of it",9,3

from,to,bidirectional,control_points
dock,fork,true
fork,"end, of it",0,6.5 0 7 3
)";

Layout import(const std::string& text) {
  std::vector<std::string> warnings;
  return parse_csv_layout(text, "l.csv", warnings);
}

TEST(CsvLayout, ReadsBothTables) {
  const auto layout = import(kTables);
  EXPECT_EQ(layout.name, "l");
  ASSERT_EQ(layout.stations.size(), 3U);
  EXPECT_EQ(layout.stations[0].purposes, Purposes(Purpose::Storage) | Purpose::Parking);
  EXPECT_EQ(layout.stations[1].purposes, Purposes(Purpose::Routing));
  EXPECT_EQ(layout.stations[2].name, "end, of it");
  ASSERT_EQ(layout.segments.size(), 2U);
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(layout.segments[0].name, "dock-fork");
  EXPECT_EQ(layout.segments[1].control_points_m, (std::vector<Vec2>{{6.5, 0}, {7, 3}}));
}

TEST(CsvLayout, BearsWhatSpreadsheetsWrite) {
  std::string text = "\xef\xbb\xbf" + kTables.substr(kTables.find("id,"));
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  EXPECT_EQ(import(text).segments.size(), 2U);
}

void expect_round_trip(Layout layout) {
  EXPECT_EQ(to_text(import(to_csv(layout))), to_text(layout));
  layout.name = "a, \"b\"";
  layout.floor_low_m.x() -= 0.1;
  layout.floor_high_m = Vec2(1234.5, 1e4);
  EXPECT_EQ(to_text(import(to_csv(layout))), to_text(layout));
}

TEST(CsvLayout, WhatIsWrittenComesBack) {
  for (const auto& family : layout_families()) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Draws draws(seed);
      expect_round_trip(family.make(draws, Range::Normal));
    }
  }
  std::vector<std::string> warnings;
  expect_round_trip(read_opentcs(independent::source_file("tests/layouts/crossdock.xml"), warnings));
  auto layout = import(kTables);
  layout.stations[0].name = "#1 \"best\"";
  layout.stations[1].name = "from";
  layout.stations[2].name = "to";
  expect_round_trip(layout);
}

TEST(CsvLayout, ATableOfTheLayoutNamesItAndItsFloor) {
  const auto named = import("layout\nmill\n" + kTables);
  EXPECT_EQ(named.name, "mill");
  EXPECT_EQ(named.floor_low_m, Vec2(-3.0, -3.0)) << "around everything";
  const auto with_floor = import("layout,low_x,low_y,high_x,high_y\n,-9,-8,20,10.5\n" + kTables);
  EXPECT_EQ(with_floor.name, "l") << "no name: that of the file";
  EXPECT_EQ(with_floor.floor_low_m, Vec2(-9.0, -8.0));
  EXPECT_EQ(with_floor.floor_high_m, Vec2(20.0, 10.5));
  const auto refused = [](const std::string& table) { return independent::refusal(import, table + kTables); };
  EXPECT_EQ(refused("layout,low_x\nmill,1\n"), "l.csv:2: low_y is \"\"; expected a finite number");
  EXPECT_EQ(refused("layout,low_x\nmill,\"10,5\"\n"),
            "l.csv:2: low_x is \"10,5\"; expected a finite number, with a point before its decimals");
  EXPECT_EQ(refused("layout\nmill\nmall\n"),
            "l.csv:3: the table of the layout has a second line; one file holds one layout");
  EXPECT_EQ(refused("layout,floor\nmill,1\n").find("l.csv:1: \"floor\" is not a column of layouts"), 0U);
  EXPECT_NE(refused("layout,low_x,low_y,high_x,high_y\nmill,1,1,0,0\n").find("high corner must not be below its low"),
            std::string::npos);
}

TEST(CsvLayout, AStationMayHaveNoPurposeAtAll) {
  auto layout = import(kTables);
  layout.stations[1].purposes = Purposes::from_bits(0);
  const auto again = import(to_csv(layout));
  EXPECT_EQ(again.stations[1].purposes, Purposes::from_bits(0));
  EXPECT_EQ(again.stations[2].purposes, Purposes(Purpose::Routing));
}

TEST(CsvLayout, TakesTheTruthThatASpreadsheetWrites) {
  for (const char* word : {"true", "TRUE", "1"})
    EXPECT_TRUE(
        import(replaced(kTables, "dock,fork,true", fmt::format("dock,fork,{}", word))).segments[0].bidirectional)
        << word;
  for (const char* word : {"false", "FALSE", "0"})
    EXPECT_FALSE(
        import(replaced(kTables, "dock,fork,true", fmt::format("dock,fork,{}", word))).segments[0].bidirectional)
        << word;
}

TEST(CsvLayoutErrors, NamePlaceValueAndRemedy) {
  const auto break_at = [](const std::string& from, const std::string& to) {
    return independent::refusal(import, replaced(kTables, from, to));
  };
  EXPECT_EQ(break_at("dock,fork,true", "dok,fork,true"),
            "l.csv:8: from is \"dok\", but there is no such node above; did you mean \"dock\"?");
  EXPECT_EQ(break_at("dock,fork,true", "dock,fork,yes"), "l.csv:8: bidirectional is \"yes\"; expected true or false");
  EXPECT_EQ(break_at("dock,fork,true", "dock,dock,true"),
            "l.csv:8: edge \"dock-dock\": a segment leads from one station to another one");
  EXPECT_EQ(break_at("4.5", "4m"), "l.csv:4: x is \"4m\"; expected a finite number");
  EXPECT_EQ(break_at("fork,4.5", "dock,4.5"),
            "l.csv:8: to is \"fork\", but there is no such node above; did you mean \"dock\"?");
  EXPECT_EQ(
      break_at("storage parking", "storing"),
      "l.csv:3: purposes are \"storing\"; expected routing, storage, charging or parking, with blanks between them");
  EXPECT_EQ(break_at("id,x,y,purposes", "id,x,y,purpose"),
            "l.csv:2: \"purpose\" is not a column of nodes; did you mean \"purposes\"?");
  EXPECT_EQ(break_at("id,x,y,purposes", "x,y"),
            "l.csv:2: the first line is \"x,y\"; expected the names of the columns first, as in \"id,x,y,purposes\" "
            "(id, x and y are needed; missing here: \"id\")");
  EXPECT_EQ(
      break_at("id,x,y,purposes", "id;x;y;purposes"),
      "l.csv:2: the first line is \"id;x;y;purposes\"; expected the names of the columns first, as in "
      "\"id,x,y,purposes\" (id, x and y are needed; missing here: \"id\", \"x\", \"y\"); the separator is a comma, no "
      "semicolon and no tabulator");
  EXPECT_EQ(break_at("6.5 0 7 3", "6.5 0 7"), "l.csv:9: control_points are 3 numbers; expected x y x y ...");
  EXPECT_EQ(break_at("\"end, of it\",9,3", "\"end, of it,9,3"),
            "l.csv:5: a double quote is not closed; close it on the same line");
  EXPECT_EQ(break_at("storage parking", "a, b"),
            "l.csv:3: the line \"dock,0,0,a, b\" has 5 fields, its table 4 columns (id,x,y,purposes); a field with a "
            "comma stands in double quotes");
  EXPECT_NE(break_at("storage parking", std::string(96, ',')).find("has 100 fields, its table 4 columns"),
            std::string::npos);
  EXPECT_EQ(break_at("storage parking", std::string(97, ',') + "\""), "l.csv:3: the line has more than 100 fields");
  EXPECT_EQ(independent::refusal(import, ""),
            "l.csv: has no nodes; expected a line id,x,y,purposes and one line for each node");
}

TEST(CsvLayoutErrors, CutAndDamagedFilesAreReadOrRefused) {
  independent::bear_cuts(import, kTables, 100);
  independent::bear_damage(import, kTables, 3000, "0123456789-.,\"# \n\r\x80\xff");
}

TEST(CsvLayout, RulesComeBack) {
  auto layout = import(kTables);
  layout.stations[0].turning = false;
  layout.stations[1].heading = Vec2(0.6, -0.8);
  layout.segments[0].travel = Travel::Either;
  layout.segments[0].back_travel = Travel::Backward;
  layout.segments[1].permissions = {{"tug, long", LoadState::Any}, {"", LoadState::Empty}};
  layout.blocks = {{"dock", BlockKind::OneVehicle}, {"aisle: 3", BlockKind::SameDirection}};
  layout.segments[0].blocks = {0};
  layout.segments[1].blocks = {0, 1};
  expect_round_trip(layout);
}

TEST(CsvLayout, NamesMayHaveBarsAndBackslashes) {
  auto layout = import(kTables);
  layout.segments[0].permissions = {
      {"a|b", LoadState::Any}, {"c\\", LoadState::Empty}, {"\\|:x\\y", LoadState::Loaded}};
  layout.blocks = {
      {"|", BlockKind::OneVehicle}, {"aisle \\| 3", BlockKind::SameDirection}, {"\\", BlockKind::OneVehicle}};
  layout.segments[0].blocks = {0, 1};
  layout.segments[1].blocks = {1, 2};
  expect_round_trip(layout);
}

TEST(CsvLayout, BlocksComeBackInTheirOrderAndWithoutEdges) {
  auto layout = import(kTables);
  layout.blocks = {
      {"empty, yet", BlockKind::SameDirection}, {"b", BlockKind::OneVehicle}, {"c", BlockKind::OneVehicle}};
  layout.segments[0].blocks = {2};
  layout.segments[1].blocks = {1, 2};
  expect_round_trip(layout);
  EXPECT_EQ(import(to_csv(layout)).blocks[0].name, "empty, yet");
  const std::string table = "id,x,y\na,0,0\nb,4,0\nblock,kind\n";
  EXPECT_EQ(independent::refusal(import, table + "b,one\nfrom,to\na,b\n"),
            "l.csv:5: kind is \"one\"; known: one-vehicle, same-direction");
  EXPECT_EQ(independent::refusal(import, table + "b,one-vehicle\nb,one-vehicle\nfrom,to\na,b\n"),
            "l.csv:6: block \"b\" stands above; rename one");
}

TEST(CsvLayout, RefusedRulesNameTheirPlace) {
  const auto edge = [](const std::string& columns, const std::string& fields) {
    return "id,x,y\na,0,0\nb,4,0\nfrom,to," + columns + "\na,b," + fields + "\n";
  };
  const auto says = [&](const std::string& columns, const std::string& fields, const char* what) {
    EXPECT_NE(independent::refusal(import, edge(columns, fields)).find(what), std::string::npos) << what;
  };
  says("travel", "forwards", "travel is \"forwards\"; did you mean \"forward\"?");
  says("back_travel", "backward", "this segment is driven one way alone");
  says("permissions", "tugger", "permission \"tugger\"; expected TYPE:any");
  says("permissions", "tugger:full", "a load state is \"full\"");
  says("blocks", "dock", "block \"dock\"; expected NAME:one-vehicle");
}

}  // namespace
}  // namespace fleetproof::csv_layout_test
