#include "generators/formats/geojson.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "damage.hpp"
#include "real_layout.hpp"

namespace fleetproof::geojson_test {
namespace {

using independent::replaced;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

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

independent::Import import(const std::string& text, const GeojsonChoice& choice = {}) {
  return independent::import_by(parse_geojson, text, "g.geojson", choice);
}

std::string refusal(const std::string& text) {
  return independent::refusal([](const std::string& t) { import(t); }, text);
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

TEST(Geojson, LinesWithCornersFarBesideTheirPointsAreStraight) {
  const auto [layout, warnings] = import(replaced(kGraph, "[[4, 6], [0, 6], [0, 0]]", "[[44, 6], [40, 6], [40, 0]]"));
  EXPECT_TRUE(layout.segments[2].control_points_m.empty());
  EXPECT_THAT(warnings, Contains(HasSubstr("1 lines with corners are drawn elsewhere than their points (\"13\")")));
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

TEST(Geojson, ALevelOfASiteIsReadAlone) {
  auto text = replaced(kSite, "\"name\": \"a\"", "\"level_idx\": 0, \"name\": \"a\"");
  text = replaced(text, "\"name\": \"b\"", "\"level_idx\": 0, \"name\": \"b\"");
  text = replaced(text, "\"bidirectional\": true", "\"level_idx\": 0, \"bidirectional\": true");
  text = replaced(text, "\"name\": \"corner\"", "\"level_idx\": 1, \"name\": \"corner\"");
  text = replaced(text, "\"graph_idx\": 1", "\"level_idx\": 1");
  const auto [layout, warnings] = import(text);
  EXPECT_EQ(layout.segments.size(), 1U);
  EXPECT_THAT(warnings, Contains(HasSubstr("features of 1 other levels are left out (\"1\")")));
  GeojsonChoice other;
  other.level = "2";
  EXPECT_THAT(independent::refusal([&](const std::string& t) { import(t, other); }, text),
              HasSubstr("no line lies on level \"2\""));
}

TEST(Geojson, ALineFromAPointToItselfIsLeftOut) {
  const auto [layout, warnings] =
      import(replaced(kGraph, "\"startid\": 1, \"endid\": 2", "\"startid\": 2, \"endid\": 2"));
  EXPECT_EQ(layout.segments.size(), 2U);
  EXPECT_THAT(warnings, Contains(HasSubstr("1 lines lead from a point to itself and are left out (\"12\")")));
}

// A road of 12 m and one of 5 m, with coordinates scaled and moved.
std::string corner(double x, double y, double unit_x, double unit_y, const std::string& crs = "") {
  const auto point = [&](int id, double east, double north) {
    return fmt::format(
        R"({{"properties": {{"id": {}}}, "geometry": {{"type": "Point", "coordinates": [{:.9f}, {:.9f}]}}}},)", id,
        x + east * unit_x, y + north * unit_y);
  };
  const auto line = [](int from, int to) {
    return fmt::format(R"({{"properties": {{"startid": {}, "endid": {}}}, "geometry": {{"type": "LineString", )"
                       R"("coordinates": []}}}})",
                       from, to);
  };
  return R"({"type": "FeatureCollection", )" +
         (crs.empty() ? "" : R"("crs": {"type": "name", "properties": {"name": ")" + crs + R"("}}, )") +
         "\n\"features\": [" + point(1, 0, 0) + point(2, 12, 0) + point(3, 12, 5) + line(1, 2) + ", " + line(2, 3) +
         "]}";
}

double road_m(const Layout& layout, std::size_t i) { return segment_curve(layout, layout.segments[i]).length_m(); }

TEST(Geojson, WebMercatorFarFromItsOriginIsScaled) {
  // Metres of a degree at a latitude of the ellipsoid WGS 84, and places of Web Mercator, by libm.
  for (const double latitude : {48.1, -33.9, 1.3, 69.6}) {
    const double a = 6378137.0, e2 = 0.00669437999014, pi = std::numbers::pi, phi = latitude / 180.0 * pi;
    const double w = std::sqrt(1.0 - e2 * std::sin(phi) * std::sin(phi));
    const double unit_x = w / std::cos(phi), unit_y = w * w * w / (1.0 - e2) / std::cos(phi);  // of a metre there
    const double y = a * std::log(std::tan(pi / 4.0 + phi / 2.0));
    for (const char* crs : {"urn:ogc:def:crs:EPSG::3857", "EPSG:3857", "EPSG:900913"}) {
      const auto [layout, warnings] = import(corner(1'280'000.0, y, unit_x, unit_y, crs));
      EXPECT_NEAR(road_m(layout, 0), 12.0, 1e-4) << latitude;
      EXPECT_NEAR(road_m(layout, 1), 5.0, 1e-4) << latitude;
      EXPECT_THAT(warnings, Contains(HasSubstr(fmt::format("which draws everything {:.3f} times too large", unit_x))));
    }
  }
  const auto [layout, warnings] = import(corner(-20.0, 30.0, 1.0, 1.0, "urn:ogc:def:crs:EPSG::3857"));
  EXPECT_EQ(road_m(layout, 0), 12.0) << "a plant of its own near the origin";
  EXPECT_THAT(warnings, Not(Contains(HasSubstr("Mercator"))));
  EXPECT_NEAR(road_m(import(corner(1'280'000.0, 6'120'000.0, 1.0, 1.0, "EPSG:25832")).layout, 0), 12.0, 1e-6) << "UTM";
}

TEST(Geojson, DegreesThatNobodyNamesAreAskedFor) {
  const double degree = 1e-5;
  EXPECT_NEAR(road_m(import(corner(11.5, 0.0, degree, degree)).layout, 0), 13.358, 1e-3) << "they look so";
  for (const auto& text : {corner(11.5, 48.1, 5e-3, 5e-3), corner(0.0, 0.0, degree, degree),
                           corner(11.5, 48.1, degree, degree, "EPSG:3857"), corner(0.2, 0.3, 0.02, 0.02)})
    EXPECT_THAT(refusal(text), AllOf(HasSubstr("g.geojson:2: /features: "),
                                     HasSubstr("are these degrees of longitude and latitude? Then say so (\"crs\": ")));
  EXPECT_EQ(refusal(corner(2.0, 3.0, 0.1, 0.1)), "accepted") << "a toy of 1.2 m";
}

TEST(Geojson, ACrsOfDegreesBesideMetresIsTold) {
  for (const char* crs : {"urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326"}) {
    for (const auto& text : {corner(2.0, 3.0, 1.0, 1.0, crs), corner(500.0, 100.0, 1.0, 1.0, crs)}) {
      const auto [layout, warnings] = import(text);
      EXPECT_NEAR(road_m(layout, 0), 12.0, 1e-9);
      EXPECT_THAT(warnings, Contains(AllOf(HasSubstr("the coordinates are no degrees of a plant"), HasSubstr(crs),
                                           HasSubstr("they are taken for metres"))));
    }
    EXPECT_THAT(import(corner(11.5, 48.1, 1e-5, 1e-5, crs)).warnings, Contains(HasSubstr("taken for degrees")));
  }
}

TEST(Geojson, FeaturesWithoutGeometryAreNamed) {
  const auto [layout, warnings] = import(replaced(kGraph, R"({"type": "MultiLineString", "coordinates": []})", "null"));
  EXPECT_EQ(layout.segments.size(), 2U);
  EXPECT_THAT(warnings, Contains(HasSubstr("1 features have no geometry (null) and are left out (\"12\")")));
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
              AllOf(HasSubstr("g.geojson:8"), HasSubstr("there is no point with this id; add it, or correct the id")));
  EXPECT_THAT(refusal(replaced(kGraph, "\"id\": 2}", "\"id\": 0}")),
              AllOf(HasSubstr("g.geojson:7"), HasSubstr("the id \"0\" is taken already")));
  EXPECT_THAT(refusal(replaced(kGraph, "\"id\": 2}", "\"other\": 2}")), HasSubstr("the point has no id"));
  EXPECT_THAT(refusal(replaced(kGraph, "[4, 6, 0]", "[4, 0]")),
              AllOf(HasSubstr("/properties/id: 12 is refused"), HasSubstr("it has no length")));
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
