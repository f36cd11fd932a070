// Points with a position in the plant and another one in the drawing, in all versions of plant models.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "damage.hpp"
#include "generators/formats/opentcs.hpp"
#include "independent_check.hpp"

namespace fleetproof::opentcs_positions_test {
namespace {

struct Spot {
  double x, y;
};

// A road of 10 m, and a bend that leaves it to the left. In the drawing: units of 50 mm, y down.
struct Model {
  std::array<Spot, 3> plant_mm = {{{0, 0}, {10'000, 0}, {14'000, 4'000}}}, drawn_mm = plant_mm;
  std::array<Spot, 2> control_points = {{{244, 0}, {280, -36}}};
  bool bends = true;
};

constexpr std::array<const char*, 3> kNames = {"a", "b", "c"};

// Versions 0.0.2 and 0.0.3.
std::string old_spelling(const Model& m, const char* version = "0.0.2", const char* bezier = "Bezier") {
  std::string points, drawing;
  for (std::size_t i = 0; i < 3; ++i) {
    points += fmt::format(R"(<point name="{}" xPosition="{}" yPosition="{}" type="HALT_POSITION"/>)", kNames[i],
                          m.plant_mm[i].x, m.plant_mm[i].y);
    drawing += fmt::format(R"(<modelLayoutElement visualizedObjectName="{}" layer="0"><property name="POSITION_X" )"
                           R"(value="{}"/><property name="POSITION_Y" value="{}"/></modelLayoutElement>)",
                           kNames[i], m.drawn_mm[i].x, m.drawn_mm[i].y);
  }
  if (m.bends) {
    drawing +=
        fmt::format(R"(<modelLayoutElement visualizedObjectName="bend" layer="0"><property name="CONN_TYPE" )"
                    R"(value="{}"/><property name="CONTROL_POINTS" value="{},{};{},{}"/></modelLayoutElement>)",
                    bezier, m.control_points[0].x, m.control_points[0].y, m.control_points[1].x, m.control_points[1].y);
  }
  return fmt::format(R"(<model version="{}" name="m">{}<path name="road" sourcePoint="a" destinationPoint="b"/>)"
                     R"(<path name="bend" sourcePoint="b" destinationPoint="c"/>)"
                     R"(<visualLayout name="v" scaleX="50.0" scaleY="50.0">{}</visualLayout></model>)",
                     version, points, drawing);
}

// Versions 0.0.4 and 0.0.5, and 6 with other words.
std::string newer_spelling(const Model& m, bool version_6) {
  const char *x = version_6 ? "positionX" : "xPosition", *y = version_6 ? "positionY" : "yPosition";
  std::string points;
  for (std::size_t i = 0; i < 3; ++i) {
    points += fmt::format(R"(<point name="{0}" {1}="{3}" {2}="{4}"><pointLayout {1}="{5}" {2}="{6}"/></point>)",
                          kNames[i], x, y, m.plant_mm[i].x, m.plant_mm[i].y, m.drawn_mm[i].x, m.drawn_mm[i].y);
  }
  std::string drawing = R"(<pathLayout connectionType="DIRECT"/>)";
  if (m.bends) {
    drawing = R"(<pathLayout connectionType="BEZIER">)";
    for (const auto& [px, py] : m.control_points) drawing += fmt::format(R"(<controlPoint x="{}" y="{}"/>)", px, py);
    drawing += "</pathLayout>";
  }
  return fmt::format(R"(<model version="{}" name="m">{}<path name="road" sourcePoint="a" destinationPoint="b"/>)"
                     R"(<path name="bend" sourcePoint="b" destinationPoint="c">{}</path>)"
                     R"(<visualLayout name="v" scaleX="50.0" scaleY="50.0"/></model>)",
                     version_6 ? "6.0.0" : "0.0.4", points, drawing);
}

std::vector<std::string> spellings(const Model& m) {
  return {old_spelling(m), old_spelling(m, "0.0.3", "BEZIER"), newer_spelling(m, false), newer_spelling(m, true)};
}

// By 10 000 chords, from the numbers of the model.
double bend_m(const Model& m, const std::array<Spot, 3>& ends_mm) {
  const Spot p[] = {ends_mm[1],
                    {m.control_points[0].x * 50, m.control_points[0].y * -50},
                    {m.control_points[1].x * 50, m.control_points[1].y * -50},
                    ends_mm[2]};
  const auto at = [&](double t, auto part) {
    const double u = 1 - t;
    return u * u * u * part(p[0]) + 3 * u * u * t * part(p[1]) + 3 * u * t * t * part(p[2]) + t * t * t * part(p[3]);
  };
  double length = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    const auto step = [&](auto part) { return at((i + 1) / 1e4, part) - at(i / 1e4, part); };
    length += std::hypot(step([](const Spot& s) { return s.x; }), step([](const Spot& s) { return s.y; }));
  }
  return length / 1000;
}

struct Import {
  Layout layout;
  std::string sentences;  // those on positions and detours

  explicit Import(const std::string& text, Positions wish = Positions::ByFile) {
    std::vector<std::string> warnings;
    ReadChoice choice;
    choice.positions = wish;
    layout = parse_opentcs(text, "m.xml", warnings, choice);
    for (const auto& warning : warnings) {
      if (warning.find("drawing") != std::string::npos) sentences += warning + "\n";
    }
  }
  double length_m(std::size_t segment) const { return segment_curve(layout, layout.segments[segment]).length_m(); }
};

Model shifted(double x_mm, double y_mm, double scale) {
  Model m;
  for (auto& [x, y] : m.plant_mm) x = scale * x + x_mm, y = scale * y + y_mm;
  return m;
}

TEST(OpenTcsPositions, AllVersionsGiveTheSameShapes) {
  const Model m;
  for (const auto& text : spellings(m)) {
    const Import import(text);
    EXPECT_EQ(import.sentences, "");
    EXPECT_NEAR(import.length_m(0), 10.0, 1e-9);
    EXPECT_NEAR(import.length_m(1), bend_m(m, m.drawn_mm), 1e-6);
    EXPECT_EQ(import.layout.segments[1].control_points_m[1], Vec2(14.0, 1.8));
  }
}

TEST(OpenTcsPositions, CurvesAreThoseOfTheDrawing) {
  const Model m = shifted(25'000, -15'000, 0.9);
  for (const auto& text : spellings(m)) {
    const Import import(text);
    EXPECT_NEAR(import.length_m(0), 10.0, 1e-9);
    EXPECT_NEAR(import.length_m(1), bend_m(m, m.drawn_mm), 1e-6);
    EXPECT_EQ(import.sentences, fmt::format("m.xml:1: 3 of 3 points stand elsewhere in the drawing than in the plant, "
                                            "by up to {:.2f} m; the curves have {:.1f} m with the positions of the "
                                            "drawing and {:.1f} m with those of the plant, so all have their positions "
                                            "of the drawing\n",
                                            29.15, bend_m(m, m.drawn_mm), bend_m(m, m.plant_mm)));
  }
}

TEST(OpenTcsPositions, ASmallDifferenceIsAnnouncedToo) {
  for (const double off_mm : {2.0, 300.0, -300.0}) {
    for (const auto& text : spellings(shifted(off_mm, off_mm, 1.0))) {
      const Import import(text);
      EXPECT_EQ(import.layout.stations[0].position_m, Vec2(0.0, 0.0)) << off_mm;
      EXPECT_NE(import.sentences.find("so all have their positions of the drawing"), std::string::npos);
    }
  }
  EXPECT_EQ(Import(newer_spelling(shifted(0.5, 0.0, 1.0), true)).sentences, "");
}

TEST(OpenTcsPositions, CurvesThatFitThePlantOnlyKeepIt) {
  Model m;
  for (auto& [x, y] : m.drawn_mm) x += 60'000, y -= 3'000;
  for (const auto& text : spellings(m)) {
    const Import import(text);
    EXPECT_NEAR(import.length_m(1), bend_m(m, m.plant_mm), 1e-6);
    EXPECT_NE(import.sentences.find("so all have their positions of the plant"), std::string::npos);
  }
}

TEST(OpenTcsPositions, StraightModelsKeepThePlant) {
  Model m = shifted(500, 700, 1.1);
  m.bends = false;
  for (const auto& text : spellings(m)) {
    const Import import(text);
    EXPECT_NEAR(import.length_m(0), 11.0, 1e-9);
    EXPECT_NE(import.sentences.find("no path is curved, so all have their positions of the plant"), std::string::npos);
  }
  m.plant_mm[1] = m.plant_mm[0];
  for (const auto& text : spellings(m)) {
    const Import import(text);
    EXPECT_NEAR(import.length_m(0), 10.0, 1e-9);
    EXPECT_NE(
        import.sentences.find("in the plant, the points \"a\" and \"b\" of path \"road\" are on one spot, and 0 of "
                              "2 stored lengths fit the plant and 0 the drawing, so all have their positions of "
                              "the drawing; correct these two, or ask for"),
        std::string::npos)
        << import.sentences;
  }
}

// Two points that an editor has put on one spot, with the length that it stores there, between roads of 10 m and 8 m.
struct SpotModel {
  int plant_mm = 0;  // of the path between the two points
  std::string stored_mm = "1", roads_mm = "10000 8000", more{}, angles[2] = {"NaN", "NaN"};

  std::string text() const {
    const auto space = roads_mm.find(' ');
    std::string points, drawing;
    const int x_mm[] = {0, 10'000, 10'000 + plant_mm, 18'000 + plant_mm};
    const int drawn_x_mm[] = {0, 5000, 7000, 9000};
    for (int i = 0; i < 4; ++i) {
      points += fmt::format(R"(<point name="{}" xPosition="{}" yPosition="0" type="{}" vehicleOrientationAngle="{}"/>)",
                            "abcd"[i], x_mm[i], i == 2 ? "PARK_POSITION" : "HALT_POSITION",
                            i == 1 || i == 2 ? angles[i - 1] : "NaN");
      drawing += fmt::format(R"(<modelLayoutElement visualizedObjectName="{}" layer="0"><property name="POSITION_X" )"
                             R"(value="{}"/><property name="POSITION_Y" value="3000"/></modelLayoutElement>)",
                             "abcd"[i], drawn_x_mm[i]);
    }
    const auto path = [](const char* from, const char* to, const std::string& length) {
      return fmt::format(
          "\n<path name=\"{0} {1}\" sourcePoint=\"{0}\" destinationPoint=\"{1}\" length=\"{2}\" "
          "maxVelocity=\"1000\" maxReverseVelocity=\"1000\"/>",
          from, to, length);
    };
    return "<model version=\"0.0.2\" name=\"m\">" + points + path("a", "b", roads_mm.substr(0, space)) +
           path("b", "c", stored_mm) + path("c", "d", roads_mm.substr(space + 1)) + more +
           "<visualLayout name=\"v\" scaleX=\"50.0\" scaleY=\"50.0\">" + drawing + "</visualLayout></model>";
  }
};

TEST(OpenTcsPositions, StoredLengthsKeepThePlantOfPointsOnOneSpot) {
  for (const int plant_mm : {0, 1, 9}) {
    const Import import(SpotModel{plant_mm, plant_mm == 9 ? "9" : "1"}.text());
    EXPECT_NE(
        import.sentences.find("are on one spot, but 3 of 3 stored lengths fit the plant and 0 the drawing, so all "
                              "have their positions of the plant"),
        std::string::npos)
        << import.sentences;
    ASSERT_EQ(import.layout.stations.size(), 3U) << plant_mm;
    EXPECT_EQ(import.layout.stations[1].name, "b");
    EXPECT_TRUE(import.layout.stations[1].purposes.has(Purpose::Parking)) << "those of both";
    ASSERT_EQ(import.layout.segments.size(), 2U);
    EXPECT_NEAR(import.length_m(0), 10.0, 1e-9);
    EXPECT_NEAR(import.length_m(1), 8.0, 0.01);
    EXPECT_EQ(import.layout.segments[1].from, StationId{1U});
  }
}

TEST(OpenTcsPositions, StoredLengthsThatFitTheDrawingMoveThePlant) {
  const Import import(SpotModel{0, "2000", "5000 2000"}.text());
  ASSERT_EQ(import.layout.segments.size(), 3U);
  EXPECT_NEAR(import.length_m(1), 2.0, 1e-9);
  EXPECT_NE(
      import.sentences.find("0 of 3 stored lengths fit the plant and 3 the drawing, so all have their positions of "
                            "the drawing"),
      std::string::npos)
      << import.sentences;
}

TEST(OpenTcsPositions, PointsOnOneSpotAreJoinedWithWhatIsLinkedToThem) {
  std::vector<std::string> warnings;
  const auto linked = R"(<path name="c b" sourcePoint="c" destinationPoint="b" length="1" maxVelocity="1000"/>
<locationType name="Load station"><allowedOperation name="Load cargo"/></locationType>
<location name="L" type="Load station"><link point="c"/></location>
<block name="B"><member name="c d"/><member name="b c"/></block>)";
  const auto layout = parse_opentcs(SpotModel{.more = linked}.text(), "m.xml", warnings);
  EXPECT_TRUE(layout.stations[1].purposes.has(Purpose::Storage)) << "the location is linked to the second point";
  ASSERT_EQ(layout.segments.size(), 2U) << "both paths of no length are left out";
  EXPECT_EQ(layout.segments[1].blocks.size(), 1U);
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& w) {
    return w.find(
               "1 pairs of points are on one spot and joined by a path without length (\"b and c\"); each pair is one "
               "station with the name of the first") != std::string::npos;
  }));
}

TEST(OpenTcsPositions, JoinedPointsKeepAHeadingThatTheyAgreeOn) {
  const auto heading = [](const std::string& b, const std::string& c) {
    SpotModel model;
    model.angles[0] = b;
    model.angles[1] = c;
    return Import(model.text()).layout.stations[1].heading;
  };
  EXPECT_EQ(heading("0", "NaN"), Vec2(1.0, 0.0));
  EXPECT_EQ(heading("NaN", "0"), Vec2(1.0, 0.0));
  EXPECT_EQ(heading("0", "0"), Vec2(1.0, 0.0));
  EXPECT_FALSE(heading("0", "180"));
}

TEST(OpenTcsPositions, TheUserChooses) {
  for (const auto& text : spellings(shifted(25'000, -15'000, 0.9))) {
    const Import plant(text, Positions::Plant), drawing(text, Positions::Drawing);
    EXPECT_EQ(plant.layout.stations[0].position_m, Vec2(25.0, -15.0));
    EXPECT_NE(plant.sentences.find("all have their positions of the plant, as was asked for"), std::string::npos);
    EXPECT_EQ(drawing.layout.stations[0].position_m, Vec2(0.0, 0.0));
    EXPECT_NE(drawing.sentences.find("their positions of the drawing, as was asked for"), std::string::npos);
  }
  auto straight = shifted(500, 700, 1.1);
  straight.bends = false;
  EXPECT_NEAR(Import(newer_spelling(straight, true), Positions::Drawing).length_m(0), 10.0, 1e-9);
  EXPECT_EQ(Import(newer_spelling(Model{}, true), Positions::Drawing).sentences, "") << "there is no choice";
}

TEST(OpenTcsPositions, APointThatIsNotDrawnKeepsAllInThePlant) {
  auto text = newer_spelling(shifted(300, 0, 1.0), false);
  const auto at = text.find("<pointLayout xPosition=\"14000\""), end = text.find("/>", at) + 2;
  const Import import(text.erase(at, end - at));
  EXPECT_EQ(import.layout.stations[0].position_m, Vec2(0.3, 0.0));
  EXPECT_NE(import.sentences.find("1 points are not drawn, so all have their positions of the plant"),
            std::string::npos);
  EXPECT_NE(
      import.sentences.find("curves keep the control points of the drawing, which may not fit: draw these points"),
      std::string::npos);
}

TEST(OpenTcsPositions, APointOnNoPathNeedsNoDrawing) {
  auto text = newer_spelling(shifted(300, 0, 1.0), false);
  text.insert(text.find("<path "), R"(<point name="far" xPosition="50000" yPosition="0"/>)");
  const Import import(text);
  EXPECT_EQ(import.layout.stations[0].position_m, Vec2(0.0, 0.0)) << "of the drawing";
  EXPECT_EQ(import.layout.stations[3].position_m, Vec2(50.0, 0.0)) << "of the plant";
}

TEST(OpenTcsPositions, CurvesThatLeadFarAwayAreNamed) {
  Model m;
  m.control_points = {{{800, 0}, {800, -600}}};
  EXPECT_NE(Import(newer_spelling(m, true))
                .sentences.find("1 curves are more than 4 times as long as the way between "
                                "their points (\"bend\")"),
            std::string::npos);
}

std::string refusal(const std::string& text) {
  return independent::refusal([](const std::string& t) { Import{t}; }, text);
}

TEST(OpenTcsPositions, APathWithALengthBetweenPointsOnOneSpotIsRefusedByName) {
  for (const char* stored_mm : {"2550", "100", ""}) {
    const auto why = refusal(SpotModel{0, stored_mm}.text());
    EXPECT_NE(why.find("m.xml:3: <path> \"b c\": it has no length, because its points \"b\" and \"c\" are on one spot"),
              std::string::npos)
        << why;
    EXPECT_EQ(why.find("stored: 2.550 m") != std::string::npos, std::string(stored_mm) == "2550") << why;
  }
}

// A drawing in which other points are on one spot is no way out.
TEST(OpenTcsPositions, ADrawingWithSpotsOfItsOwnMovesNothing) {
  Model m = shifted(500, 700, 1.1);
  m.bends = false;
  m.plant_mm[1] = m.plant_mm[0];
  m.drawn_mm[2] = m.drawn_mm[1];
  for (const auto& text : spellings(m)) EXPECT_NE(refusal(text).find("<path> \"road\""), std::string::npos);
}

TEST(OpenTcsPositions, BrokenDrawingsAreExplained) {
  const auto with = [](const std::string& from, const std::string& to) {
    auto text = old_spelling(Model());
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refusal(text.replace(at, from.size(), to));
  };
  for (const char* points : {"244,0;280", "244,0;280,x", "244;0;280,-36", "nan,0;280,-36", "244,0,280,-36"}) {
    EXPECT_EQ(with("244,0;280,-36", points), "m.xml:1: CONTROL_POINTS is \"" + std::string(points) +
                                                 "\"; expected pairs of numbers, as in \"552,-183;550,-180\"");
  }
  for (const char* points : {"", "244,0", "244,0;280,-36;1,1"}) {
    EXPECT_NE(with("244,0;280,-36", points).find("control points; BEZIER needs 2"), std::string::npos) << points;
  }
  EXPECT_NE(with("name=\"POSITION_X\" value=\"0\"", "name=\"POSITION_X\" value=\"zero\"").find("expected a finite"),
            std::string::npos);
  EXPECT_NE(with("xPosition=\"0\"", "xPosition=\"1e300\"").find("coordinates lie within"), std::string::npos);
  EXPECT_NE(with("244,0;280,-36", "1e300,0;280,-36").find("coordinates lie within"), std::string::npos);
  EXPECT_EQ(with("value=\"14000\"", "value=\"1e300\""), "accepted") << "the plant is as good";
  EXPECT_EQ(refusal("<model><element type=\"layout\"/></model>"),
            "m.xml:1: this is a drawing of openTCS 3.0 to 4.7 (.opentcs); open it in the plant overview of openTCS 4.8 "
            "to 4.14, which still read it, and save it as a plant model");
}

}  // namespace
}  // namespace fleetproof::opentcs_positions_test
