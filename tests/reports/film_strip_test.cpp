#include "reports/markup/film_strip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <regex>
#include <sstream>

namespace fleetproof::html::film_strip_test {
namespace {

using testing::HasSubstr;

FilmBody agv(const char* name, double x_m, double y_m, bool involved) {
  FilmBody body;
  body.name = name;
  body.centre = {x_m, y_m};
  body.length_m = 2.0;
  body.width_m = 1.0;
  body.is_involved = involved;
  return body;
}

// Two AGVs that are 10 m apart, so that the window has a side of 10 m + 2 * 1.118 m + 3 m, rounded up.
FilmStrip two_agvs() {
  FilmStrip strip;
  FilmFrame frame;
  frame.time_s = 12.345;
  frame.is_worst = true;
  frame.clearance_m = 8.0;
  frame.bodies = {agv("AGV 0", 100.0, 50.0, true), agv("AGV 1", 110.0, 50.0, true), agv("AGV 2", 300.0, 50.0, false)};
  strip.frames = {frame};
  return strip;
}

pugi::xml_document parsed(const Element& element) {
  pugi::xml_document document;
  const std::string text = element.str();
  EXPECT_TRUE(document.load_buffer(text.data(), text.size(), pugi::parse_full)) << text;
  return document;
}

// The corners of a path such as M1 2L3 4Z, in pixels.
std::vector<FloorPoint> corners(const std::string& path) {
  static const std::regex pair(R"((-?[0-9.]+) (-?[0-9.]+))");
  std::vector<FloorPoint> points;
  for (std::sregex_iterator at(path.begin(), path.end(), pair), end; at != end; ++at)
    points.push_back({std::stod((*at)[1]), std::stod((*at)[2])});
  return points;
}

std::vector<std::string> bodies_of(const pugi::xml_document& document) {
  std::vector<std::string> paths;
  for (const auto& path : document.select_nodes("//svg/svg/path[@stroke='#2b3138']"))
    paths.emplace_back(path.node().attribute("d").value());
  return paths;
}

TEST(FilmStrip, bodies_are_to_scale) {
  const auto document = parsed(draw(two_agvs()));
  const auto bodies = bodies_of(document);
  ASSERT_EQ(bodies.size(), 2u) << "the third is far away";
  const auto first = corners(bodies[0]), second = corners(bodies[1]);
  ASSERT_EQ(first.size(), 4u);
  const double px_per_m = (second[0].x_m - first[0].x_m) / 10.0;
  EXPECT_NEAR(px_per_m, 156.0 / 16.0, 0.02) << "a window of 16 m";
  EXPECT_NEAR((first[0].x_m - first[3].x_m) / px_per_m, 2.0, 0.03) << "length, along the heading";
  EXPECT_NEAR((first[1].y_m - first[0].y_m) / px_per_m, 1.0, 0.03) << "width";
}

TEST(FilmStrip, a_turned_body_turns) {
  auto strip = two_agvs();
  strip.frames[0].bodies[0].heading = {0.0, 1.0};
  const auto first = corners(bodies_of(parsed(draw(strip)))[0]);
  EXPECT_NEAR(first[0].x_m, first[3].x_m, 0.11) << "the length is upright";
  EXPECT_LT(first[0].y_m, first[3].y_m) << "north is up";
}

TEST(FilmStrip, has_axes_in_metres_time_and_clearance) {
  const auto document = parsed(draw(two_agvs()));
  std::vector<std::string> texts;
  for (const auto& text : document.select_nodes("//svg/text")) texts.emplace_back(text.node().text().get());
  EXPECT_THAT(texts, testing::IsSupersetOf({"12.345 s", "8.00 m apart", "m", "AGV 0", "AGV 1"}));
  // The windows starts at x = 97, so the first round multiple of its step (2 m) is 98.
  EXPECT_THAT(texts, testing::Contains("98"));
}

TEST(FilmStrip, has_a_bar_of_its_scale) {
  const auto document = parsed(draw(two_agvs()));
  std::vector<std::string> texts;
  for (const auto& text : document.select_nodes("//svg/text")) texts.emplace_back(text.node().text().get());
  EXPECT_THAT(texts, testing::Contains("2 m"));
  const auto bar = corners(document.select_node("//svg/path[@class='scale']").node().attribute("d").value());
  ASSERT_EQ(bar.size(), 3u) << "two ends, and one of them once more";
  const auto bodies = bodies_of(document);
  const double px_per_m = (corners(bodies[1])[0].x_m - corners(bodies[0])[0].x_m) / 10.0;
  EXPECT_NEAR(bar[2].x_m - bar[0].x_m, 2.0 * px_per_m, 0.2);
}

TEST(FilmStrip, clearances_are_rounded_down) {
  auto strip = two_agvs();
  strip.frames[0].clearance_m = 0.0999;
  EXPECT_THAT(draw(strip).str(), HasSubstr("0.09 m apart"));
  strip.frames[0].clearance_m = 0.1 - 1e-9;  // 99 999 micrometres in the archive
  EXPECT_THAT(draw(strip).str(), HasSubstr("0.09 m apart"));
  strip.frames[0].clearance_m = 1.55 - 1e-15;
  EXPECT_THAT(draw(strip).str(), HasSubstr("1.55 m apart"));
  strip.frames[0].clearance_m = 0.0;
  EXPECT_THAT(draw(strip).str(), HasSubstr("they touch"));
}

TEST(FilmStrip, a_frame_without_a_clearance_says_why) {
  auto strip = two_agvs();
  strip.frames[0].clearance_m.reset();
  strip.frames[0].without_clearance = "load not on the floor";
  const auto document = parsed(draw(strip));
  std::vector<std::string> texts;
  for (const auto& text : document.select_nodes("//svg/text")) texts.emplace_back(text.node().text().get());
  EXPECT_THAT(texts, testing::Contains("load not on the floor"));
  EXPECT_THAT(document.select_node("//svg").node().attribute("aria-label").value(), HasSubstr("load not on the floor"));
}

// Of all names of a frame. A letter is about 5 px wide, a line 9 px high.
struct NameBox {
  std::string name;
  double left, right, top, bottom;
};
std::vector<NameBox> name_boxes(const pugi::xml_document& document) {
  std::vector<NameBox> boxes;
  for (const auto& text : document.select_nodes("//svg/svg/text")) {
    const std::string name = text.node().text().get();
    const double x = text.node().attribute("x").as_double(), y = text.node().attribute("y").as_double();
    const double half = 2.5 * static_cast<double>(name.size());
    boxes.push_back({name, x - half, x + half, y - 9.0, y});
  }
  return boxes;
}

TEST(FilmStrip, names_do_not_lie_on_each_other_among_twenty_agvs) {
  for (const std::size_t involved : {2U, 5U}) {
    for (const double apart_m : {0.1, 0.6, 1.2}) {
      auto strip = two_agvs();
      auto& bodies = strip.frames[0].bodies;
      FilmBody one = bodies[0];
      bodies.clear();
      for (std::size_t i = 0; i < 20; ++i) {
        one.name = "AGV " + std::to_string(i);
        one.centre = {10.0 + apart_m * static_cast<double>(i % 5), 10.0 + apart_m * static_cast<double>(i / 5)};
        one.is_involved = i % 7 < 1 + involved / 5 && i / 7 < involved;
        bodies.push_back(one);
      }
      strip.least_side_m = 12.0;
      const auto boxes = name_boxes(parsed(draw(strip)));
      EXPECT_GE(boxes.size(), 2U) << "those involved have their names";
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          const bool apart = boxes[i].right <= boxes[k].left || boxes[k].right <= boxes[i].left ||
                             boxes[i].bottom <= boxes[k].top || boxes[k].bottom <= boxes[i].top;
          EXPECT_TRUE(apart) << boxes[i].name << " and " << boxes[k].name << ", bodies " << apart_m << " m apart";
        }
      }
    }
  }
}

// A letter is about 5 px wide.
TEST(FilmStrip, names_near_an_edge_are_not_cut) {
  auto strip = two_agvs();
  strip.least_side_m = 20.0;
  strip.frames[0].bodies[2] = agv("load of AGV 22", 95.5, 56.0, false);  // the window is from 95 m to 115 m
  strip.frames[0].bodies.push_back(agv("load of AGV 23", 114.5, 56.0, false));
  int found = 0;
  for (const auto& each : parsed(draw(strip)).select_nodes("//svg/text")) {
    if (!std::string(each.node().text().get()).starts_with("load")) continue;
    ++found;
    EXPECT_GE(each.node().attribute("x").as_double(), 30.0 + 14 * 5.0 / 2.0);
    EXPECT_LE(each.node().attribute("x").as_double(), 30.0 + 156.0 - 14 * 5.0 / 2.0);
  }
  EXPECT_EQ(found, 2);
}

// AGV 3 stands where AGV 2 does, AGV 4 far from both; the AGVs of the failure are named in any case.
TEST(FilmStrip, a_name_covers_no_other) {
  auto strip = two_agvs();
  strip.least_side_m = 20.0;
  strip.frames[0].bodies = {agv("AGV 2", 104.0, 55.0, false), agv("AGV 3", 104.5, 55.0, false),
                            agv("AGV 4", 104.0, 44.0, false), agv("AGV 0", 100.0, 50.0, true),
                            agv("AGV 1", 100.2, 50.0, true)};
  std::vector<std::string> names;
  for (const auto& each : parsed(draw(strip)).select_nodes("//svg/svg/text"))
    names.emplace_back(each.node().text().get());
  EXPECT_THAT(names, testing::UnorderedElementsAre("AGV 0", "AGV 1", "AGV 2", "AGV 4"));
}

TEST(FilmStrip, only_what_reaches_into_the_window_is_drawn) {
  auto strip = two_agvs();
  strip.lanes = {{{90.0, 50.0}, {120.0, 50.0}}, {{90.0, 90.0}, {120.0, 90.0}}};
  strip.stations = {{105.0, 50.0}, {500.0, 50.0}};
  const auto document = parsed(draw(strip));
  const std::string lanes = document.select_node("//path[@stroke='#9aa3ad']").node().attribute("d").value();
  EXPECT_EQ(std::ranges::count(lanes, 'M'), 1);
  const std::string stations = document.select_node("//path[@fill='#7b8590']").node().attribute("d").value();
  EXPECT_EQ(std::ranges::count(stations, 'M'), 1);
}

TEST(FilmStrip, names_and_notes_stay_text) {
  auto strip = two_agvs();
  strip.frames[0].bodies[0].name = "<b>\"&'\xe2\x80\xae";
  strip.note = "</p><script>]]>";
  const auto document = parsed(draw(strip));
  EXPECT_EQ(document.select_nodes("//b | //script").size(), 0u);
  EXPECT_STREQ(document.select_node("//p").node().text().get(), "</p><script>]]>");
}

TEST(FilmStrip, without_frames_it_says_why) {
  FilmStrip strip;
  strip.note = "No film strip: the software is gone";
  const auto document = parsed(draw(strip));
  EXPECT_EQ(document.select_nodes("//svg").size(), 0u);
  EXPECT_STREQ(document.select_node("//p").node().text().get(), "No film strip: the software is gone");
}

// Far away, something moves: the picture is the same.
TEST(FilmStrip, frames_that_look_the_same_are_drawn_once) {
  auto strip = two_agvs();
  strip.frames.assign(4, strip.frames[0]);
  for (std::size_t i = 0; i < 4; ++i) {
    strip.frames[i].time_s = 1.0 + static_cast<double>(i);
    strip.frames[i].is_worst = i == 1;
    strip.frames[i].bodies[2].centre.x_m += static_cast<double>(i);
  }
  strip.frames[3].bodies[0].centre.x_m += 1.0;
  std::vector<std::string> times;
  const auto document = parsed(draw(strip));
  for (const auto& frame : document.select_nodes("//div/svg"))
    times.emplace_back(frame.node().attribute("aria-label").value());
  EXPECT_THAT(times, testing::ElementsAre("at 2.000 s, 8.00 m apart", "at 4.000 s, 8.00 m apart"));
  EXPECT_THAT(document.select_node("//p").node().text().get(), HasSubstr("From 1.000 s to 4.000 s"));
}

TEST(FilmStrip, a_strip_of_nothing_is_drawn) {
  FilmStrip strip;
  strip.frames.resize(1);
  EXPECT_EQ(parsed(draw(strip)).select_nodes("//div/svg").size(), 1u);
}

}  // namespace
}  // namespace fleetproof::html::film_strip_test
