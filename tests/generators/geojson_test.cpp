#include "generators/formats/geojson.hpp"

#include <gmock/gmock.h>

#include "damage.hpp"
#include "real_layout.hpp"

namespace fleetproof::geojson_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

// A graph as Nav2 has it: two ways on one track, a way that nobody drives back, a bend.
const std::string kGraph = R"({"type": "FeatureCollection", "name": "depot",
"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}},
"features": [
{"type": "Feature", "properties": {"id": 0, "frame": "map"}, "geometry": {"type": "Point", "coordinates": [0, 0]}},
{"type": "Feature", "properties": {"id": 1, "metadata": {"name": "dock", "type": "charging"}},
 "geometry": {"type": "Point", "coordinates": [4, 0]}},
{"type": "Feature", "properties": {"id": 2}, "geometry": {"type": "Point", "coordinates": [4, 6, 0]}},
{"type": "Feature", "properties": {"id": 10, "startid": 0, "endid": 1},
 "geometry": {"type": "LineString", "coordinates": [[0, 0], [4, 0]]}},
{"type": "Feature", "properties": {"id": 11, "startid": 1, "endid": 0},
 "geometry": {"type": "MultiLineString", "coordinates": [[[4, 0], [0, 0]]]}},
{"type": "Feature", "properties": {"id": 12, "startid": 1, "endid": 2, "cost": 10.0,
  "metadata": {"speed_limit": 0.85, "aisle": 14}, "operations": {"open_door": {"type": "open_door"}}},
 "geometry": {"type": "MultiLineString", "coordinates": []}},
{"type": "Feature", "properties": {"id": 13, "startid": 2, "endid": 0, "metadata": {"abs_speed_limit": 0.5}},
 "geometry": {"type": "LineString", "coordinates": [[4, 6], [0, 6], [0, 0]]}}]})";

struct Import {
  Layout layout;
  std::vector<std::string> warnings;
};

Import import(const std::string& text, const GeojsonChoice& choice = {}) {
  Import result;
  result.layout = parse_geojson(text, "g.geojson", result.warnings, choice);
  return result;
}

std::string refusal(const std::string& text) {
  return independent::refusal([](const std::string& t) { import(t); }, text);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(Geojson, AGraphOfNav2IsRead) {
  const auto [layout, warnings] = import(kGraph);
  EXPECT_EQ(layout.name, "depot");
  ASSERT_EQ(layout.stations.size(), 3U);
  EXPECT_EQ(layout.stations[0].name, "0");
  EXPECT_EQ(layout.stations[1].name, "dock");
  EXPECT_EQ(layout.stations[1].purposes, Purposes(Purpose::Routing) | Purpose::Charging);
  EXPECT_EQ(layout.stations[2].position_m, Vec2(4.0, 6.0));
  ASSERT_EQ(layout.segments.size(), 3U) << "there and back on one track are one";
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(independent::directed(layout), 4U);
  EXPECT_TRUE(layout.segments[1].control_points_m.empty()) << "without coordinates a line is straight";
  EXPECT_EQ(layout.segments[1].speed_limit_mps, 0.0);
  EXPECT_EQ(layout.segments[2].speed_limit_mps, 0.5);
  EXPECT_NEAR(segment_curve(layout, layout.segments[2]).length_m(), 10.0 - 2.0 * 0.5 + 0.5 * 3.14159 / 2.0, 1e-3);
  EXPECT_THAT(warnings, Contains(HasSubstr("1 kinds of costs of lines are left out (\"cost\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("1 lines have a speed_limit (\"12\"), which is a share")));
  EXPECT_THAT(warnings, Contains(HasSubstr("operations are left out (\"open_door\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("1 kinds of details are left out (\"aisle\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("1 lines are drawn with corners (\"13\")")));
}

TEST(Geojson, TwinsMayStay) {
  GeojsonChoice choice;
  choice.twins = TwinPaths::Keep;
  EXPECT_EQ(import(kGraph, choice).layout.segments.size(), 4U);
}

TEST(Geojson, LinesNameTheirPointsInOtherWords) {
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"start_node", "end_node"}, {"from", "to"}, {"source", "target"}}) {
    auto text = kGraph;
    for (std::size_t at = 0; (at = text.find("startid", at)) != std::string::npos;) text.replace(at, 7, from);
    for (std::size_t at = 0; (at = text.find("endid", at)) != std::string::npos;) text.replace(at, 5, to);
    EXPECT_EQ(independent::directed(import(text).layout), 4U) << from;
  }
}

TEST(Geojson, ALineWithoutNamesLeadsBetweenThePointsAtItsEnds) {
  const auto text = replaced(kGraph, R"("startid": 2, "endid": 0, )", "");
  EXPECT_EQ(independent::directed(import(text).layout), 4U);
  EXPECT_THAT(refusal(replaced(text, "[0, 6], [0, 0]]", "[0, 6], [0, 1]]")),
              HasSubstr("the line ends 1.00 m beside the nearest point, \"0\""));
}

TEST(Geojson, OneIdForTwoLinesIsTold) {
  const auto [layout, warnings] = import(replaced(kGraph, "\"id\": 13", "\"id\": 12"));
  EXPECT_EQ(layout.segments[2].name, "12_");
  EXPECT_THAT(warnings, Contains(HasSubstr("1 lines have an id that another line has (\"12_\")")));
}

TEST(Geojson, ALineDrawnFromItsEndIsTurnedRound) {
  const auto [layout, warnings] = import(replaced(kGraph, "[[4, 6], [0, 6], [0, 0]]", "[[0, 0], [0, 6], [4, 6]]"));
  EXPECT_EQ(layout.segments[2].from, StationId{2U});
  EXPECT_NEAR(segment_curve(layout, layout.segments[2]).length_m(), 9.785, 1e-2);
  EXPECT_THAT(warnings, Contains(HasSubstr("1 lines are drawn from their end to their start")));
}

TEST(Geojson, LinesBesideTheirPointsAreTold) {
  EXPECT_THAT(import(replaced(kGraph, "[[0, 0], [4, 0]]", "[[0.5, 0], [4, 0]]")).warnings,
              Contains(HasSubstr("begin or end beside their points (\"10\"), by up to 0.500 m")));
}

TEST(Geojson, WordsOfTheUserSayWhatPointsAreFor) {
  GeojsonChoice choice;
  choice.purposes = purpose_words_of("0=storage,dock=parking", "--purposes");
  const auto layout = import(kGraph, choice).layout;
  EXPECT_TRUE(layout.stations[0].purposes.has(Purpose::Storage));
  EXPECT_EQ(layout.stations[1].purposes, Purposes(Purpose::Routing) | Purpose::Parking);
  EXPECT_THAT(import(replaced(kGraph, "charging", "stop")).warnings,
              Contains(HasSubstr("1 types of points say nothing that is known here (\"stop\")")));
}

// A site of Open-RMF near Singapore: degrees, a corner of a wall, two graphs.
const std::string kSite = R"({"type": "FeatureCollection", "site_name": "campus", "preferred_crs": "EPSG:3414",
"features": [
{"type": "Feature", "feature_type": "rmf_vertex", "properties": {"name": "a", "is_charger": true},
 "geometry": {"type": "Point", "coordinates": [103.8000, 1.3000]}},
{"type": "Feature", "feature_type": "rmf_vertex", "properties": {"name": "b", "is_parking_spot": true},
 "geometry": {"type": "Point", "coordinates": [103.8001, 1.3000]}},
{"type": "Feature", "feature_type": "rmf_vertex", "properties": {"name": "corner"},
 "geometry": {"type": "Point", "coordinates": [103.8001, 1.3001]}},
{"type": "Feature", "feature_type": "rmf_lane", "properties": {"bidirectional": true, "speed_limit": 0.7},
 "geometry": {"type": "LineString", "coordinates": [[103.8000, 1.3000], [103.8001, 1.3000]]}},
{"type": "Feature", "feature_type": "rmf_lane", "properties": {"graph_idx": 1},
 "geometry": {"type": "LineString", "coordinates": [[103.8001, 1.3000], [103.8000, 1.3000]]}},
{"type": "Feature", "feature_type": "rmf_floor", "properties": {},
 "geometry": {"type": "Polygon", "coordinates": []}}]})";

TEST(Geojson, ASiteOfOpenRmfIsInMetres) {
  const auto [layout, warnings] = import(kSite);
  EXPECT_EQ(layout.name, "campus");
  ASSERT_EQ(layout.stations.size(), 2U) << "corners of walls lie on no lane";
  EXPECT_TRUE(layout.stations[0].purposes.has(Purpose::Charging));
  EXPECT_TRUE(layout.stations[1].purposes.has(Purpose::Parking));
  // 1e-4 degrees of longitude at 1.3 degrees north: 111.29 km per degree.
  EXPECT_NEAR((layout.stations[1].position_m - layout.stations[0].position_m).x(), 11.129, 2e-3);
  ASSERT_EQ(layout.segments.size(), 1U);
  EXPECT_TRUE(layout.segments[0].bidirectional);
  EXPECT_EQ(layout.segments[0].back_speed_limit_mps, 0.7);
  EXPECT_THAT(warnings, Contains(HasSubstr("degrees of longitude and latitude")));
  EXPECT_THAT(warnings, Contains(HasSubstr("lanes of 1 other graphs are left out (\"1\")")));
  EXPECT_THAT(warnings, Contains(HasSubstr("1 features are no points and no lines (\"rmf_floor\")")));
  GeojsonChoice other;
  other.graph_idx = 1;
  EXPECT_FALSE(
      import(replaced(kSite, "\"bidirectional\": true,", "\"graph_idx\": 0,"), other).layout.segments[0].bidirectional);
}

TEST(Geojson, UtmCoordinatesAreShifted) {
  const auto [layout, warnings] = import(R"({"type": "FeatureCollection", "features": [
{"properties": {"id": 1}, "geometry": {"type": "Point", "coordinates": [500120, 5400001]}},
{"properties": {"id": 2}, "geometry": {"type": "Point", "coordinates": [500124, 5400001]}},
{"properties": {"startid": 1, "endid": 2}, "geometry": {"type": "LineString", "coordinates": []}}]})");
  EXPECT_EQ(layout.stations[0].position_m, Vec2(20.0, 1.0));
  EXPECT_EQ(layout.stations[1].position_m, Vec2(24.0, 1.0));
  EXPECT_THAT(warnings, Contains(AllOf(HasSubstr("as UTM coordinates do"), HasSubstr("(-500100, -5400000) m"))));
}

TEST(Geojson, FaultsAreRefusedAtTheirLine) {
  EXPECT_THAT(refusal("{}"), HasSubstr("is no \"FeatureCollection\""));
  EXPECT_THAT(refusal(replaced(kGraph, "\"startid\": 0, \"endid\": 1", "\"startid\": 0, \"endid\": 7")),
              AllOf(HasSubstr("g.geojson:8"), HasSubstr("there is no point with this id")));
  EXPECT_THAT(refusal(replaced(kGraph, "\"id\": 2}", "\"id\": 0}")),
              AllOf(HasSubstr("g.geojson:7"), HasSubstr("the id \"0\" is taken already")));
  EXPECT_THAT(refusal(replaced(kGraph, "\"id\": 2}", "\"other\": 2}")), HasSubstr("the point has no id"));
  EXPECT_THAT(refusal(replaced(kGraph, "[4, 6, 0]", "[4, 0]")), HasSubstr("it has no length"));
  EXPECT_THAT(refusal(replaced(kGraph, "0.5}}", "500}}")), HasSubstr("expected 0 (none), or 0.001 to 100 m/s"));
}

TEST(Geojson, CutAndDamagedFilesAreRefusedOrRead) {
  const auto parse = [](const std::string& text) { import(text); };
  for (const auto& text : {kGraph, kSite}) {
    independent::bear_cuts(parse, text, 200);
    independent::bear_damage(parse, text, 1500, "0123456789-.eE\"[]{},:\\ \n\x80\xff");
  }
}

}  // namespace
}  // namespace fleetproof::geojson_test
