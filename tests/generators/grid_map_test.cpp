#include "generators/formats/grid_map.hpp"

#include <gtest/gtest.h>

#include "damage.hpp"
#include "real_layout.hpp"

namespace fleetproof::grid_map_test {
namespace {

const std::string kMap = "type octile\nheight 3\nwidth 4\nmap\n..@.\n.TS.\n@...\n";

Layout import(const std::string& text) {
  std::vector<std::string> warnings;
  return parse_grid_map(text, "m.map", warnings);
}

std::string refusal(const std::string& text) { return independent::refusal(import, text); }

TEST(GridMap, FreeCellsBecomeStationsJoinedToFourSides) {
  std::vector<std::string> warnings;
  const auto layout = parse_grid_map(kMap, "m.map", warnings, 1.5);
  ASSERT_EQ(layout.stations.size(), 9U);
  EXPECT_EQ(layout.segments.size(), 8U);
  EXPECT_EQ(layout.name, "m");
  EXPECT_EQ(layout.stations[0].name, "r0c0");
  EXPECT_EQ(layout.stations[0].position_m, Vec2(0.0, 3.0));
  EXPECT_EQ(layout.stations[4].name, "r1c2");
  EXPECT_EQ(layout.stations[4].position_m, Vec2(3.0, 1.5));
  EXPECT_EQ(layout.stations[4].purposes, Purposes(Purpose::Routing) | Purpose::Storage);
  EXPECT_EQ(layout.segments[0].name, "r0c0-r0c1");
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(warnings, (std::vector<std::string>{
                          "m.map:1: type \"octile\" is left out; here cells are joined on their four sides",
                          "m.map: cells are taken to be 1.5 m apart; the map names no charging and no parking",
                          "m.map: cells S and E are taken for storage, as in maps of the League of Robot Runners; in "
                          "maps of terrain, S is swamp"}));
}

TEST(GridMap, BearsLineEndsOfOtherSystems) {
  std::string text = kMap;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  EXPECT_EQ(import(text).stations.size(), 9U);
}

TEST(GridMapErrors, NamePlaceValueAndRemedy) {
  EXPECT_EQ(refusal("type octile\nheight x\n"), "m.map:2: height is \"x\"; expected a whole number from 1 to 10000");
  EXPECT_EQ(refusal("type octile\nhight 3\n"),
            "m.map:2: \"hight 3\" is not a line of a map's header; expected type, height, width or map");
  EXPECT_EQ(refusal("type octile\nheight 3\nmap\n"),
            "m.map:3: the header lacks height or width; add both before \"map\"");
  EXPECT_EQ(refusal("height 1\nwidth 3\nmap\n.x.\n"),
            "m.map:4:2: cell \"x\" is unknown; free cells are . G S E, blocked ones @ O T W");
  EXPECT_EQ(refusal("height 1\nwidth 3\nmap\n..\n"), "m.map:4: row 1 has 2 cells; the header says width 3");
  EXPECT_EQ(refusal("height 2\nwidth 3\nmap\n...\n"), "m.map:5: the file ends before row 2 of 2; is it complete?");
  EXPECT_EQ(refusal("height 1\nwidth 3\nmap\n...\n...\n"),
            "m.map:5: the map has more than the 1 rows that its header says");
  EXPECT_EQ(refusal("height 1\nwidth 3\nmap\n.@.\n"),
            "m.map: no two free cells of the map are neighbours; expected cells with . between @");
  EXPECT_EQ(refusal(""), "m.map:1: the file ends before the line \"map\" of the header; is it complete?");
  std::string vast = "height 1025\nwidth 1024\nmap\n";
  for (int row = 0; row < 1025; ++row) vast += std::string(1024, '.') + "\n";
  EXPECT_EQ(refusal(vast), "m.map: the map has more than 1048576 free cells; cut out a part");
  std::vector<std::string> warnings;
  EXPECT_THROW(parse_grid_map(kMap, "m.map", warnings, 0.0), InputError);
}

TEST(GridMapErrors, CutAndDamagedFilesAreReadOrRefused) {
  independent::bear_cuts(import, kMap, 100);
  independent::bear_damage(import, kMap, 3000, "0123456789-.@TSE \n\r\x80\xff");
}

TEST(RealLayouts, GridMaps) {
  struct Expected {
    const char* name;
    std::size_t stations, directed;
  };
  for (const auto& [name, stations, lanes] :
       {Expected{"warehouse-10-20-10-2-1", 5699, 17556}, {"lorr_warehouse_small", 1277, 4208}}) {
    const auto path = independent::real_layout(std::string("mapf/") + name + ".map");
    FLEETPROOF_SKIP_IF_ABSENT(path);
    std::vector<std::string> warnings;
    const auto layout = read_grid_map(path, warnings);
    EXPECT_EQ(layout.stations.size(), stations) << name;
    EXPECT_EQ(independent::directed(layout), lanes) << name;
  }
}

}  // namespace
}  // namespace fleetproof::grid_map_test
