// The picture of a layout: sound XML, everything in it, the right way up.
#include "generators/map/layout_svg.hpp"

#include <gtest/gtest.h>

#include <array>
#include <pugixml.hpp>
#include <sstream>

#include "generators/families/layout_family.hpp"
#include "generators/map/layout_check.hpp"
#include "independent_check.hpp"

namespace fleetproof::layout_svg_test {
namespace {

pugi::xml_document parsed(const std::string& svg) {
  pugi::xml_document document;
  const auto result = document.load_string(svg.c_str());
  EXPECT_TRUE(result) << result.description();
  return document;
}

std::vector<pugi::xml_node> texts(const pugi::xml_document& document, const std::string& text) {
  std::vector<pugi::xml_node> found;
  for (const auto& node : document.child("svg").children("text")) {
    if (node.text().get() == text) found.push_back(node);
  }
  return found;
}

Layout pair(bool bidirectional) {
  Layout layout;
  layout.name = "low & <high>";
  layout.stations = {{"low", {0, 0}, Purpose::Storage}, {"high", {4, 5}, Purpose::Parking}};
  layout.segments = {{"low-high", StationId{0U}, StationId{1U}, bidirectional, {}}};
  fit_floor(layout, 3.0);
  return layout;
}

TEST(LayoutSvg, EveryFamilyIsSoundXmlWithEveryLaneAndStation) {
  for (const auto& family : layout_families()) {
    Draws draws(stream_key(7, Stream::Layout));
    const Layout layout = draw_map({&family, Range::Normal}, draws, 3)->layout();  // a plant with names, not tooltips
    const std::string svg = layout_svg(layout);
    const auto document = parsed(svg);
    for (const auto& station : layout.stations)
      EXPECT_EQ(texts(document, station.name).size(), 1U) << family.name << ": " << station.name;
    std::size_t lanes = 0;
    for (const auto& node : document.child("svg").children("path"))
      lanes += std::string_view(node.attribute("fill").value()) == "none" ? 1 : 0;
    EXPECT_EQ(lanes, layout.segments.size() + 1) << "and the scale bar";
    EXPECT_EQ(svg.find("style"), std::string::npos);
    EXPECT_EQ(svg.find("class"), std::string::npos);
    EXPECT_EQ(svg.find("script"), std::string::npos);
    EXPECT_EQ(svg, layout_svg(layout));
  }
}

TEST(LayoutSvg, TheFloorOfALaneIsAsWideAsItIs) {
  Layout layout = pair(true);
  const auto widest_px = [&] {
    double widest = 0.0;
    const auto document = parsed(layout_svg(layout));
    for (const auto& node : document.child("svg").children("path"))
      widest = std::max(widest, node.attribute("stroke-width").as_double());
    return widest;
  };
  EXPECT_LT(widest_px(), 3.0) << "no width is known";
  layout.segments[0].width_m = 1.5;
  EXPECT_NEAR(widest_px(), 1.5 * view_of(layout, 0.0).scale(), 0.06);
}

TEST(LayoutSvg, HigherIsHigherAndRightIsRight) {
  const auto document = parsed(layout_svg(pair(true)));
  const auto low = texts(document, "low"), high = texts(document, "high");
  ASSERT_EQ(low.size() + high.size(), 2U);
  EXPECT_GT(low[0].attribute("y").as_double(), high[0].attribute("y").as_double() + 50.0);
  EXPECT_LT(low[0].attribute("x").as_double(), high[0].attribute("x").as_double() - 50.0);
}

// A reader who measures a station on the axes finds its coordinates.
TEST(LayoutSvg, TheAxesAreInMetres) {
  for (const double far_m : {3.0, 40.0, 2000.0}) {
    Layout layout;
    layout.name = "far";
    layout.stations = {{"low", {-0.25 * far_m, -1.5}, Purpose::Storage},
                       {"high", {far_m, 0.7 * far_m}, Purpose::Storage}};
    layout.segments = {{"low-high", StationId{0U}, StationId{1U}, true, {}}};
    fit_floor(layout, 3.0);
    const auto document = parsed(layout_svg(layout));
    const auto axes = document.child("svg").children("g");
    std::vector<std::array<double, 4>> ends;  // the first and the last number of each axis: pixel, metres
    for (const auto& axis : {*axes.begin(), *std::next(axes.begin())}) {
      const bool is_x = ends.empty();
      std::vector<std::pair<double, double>> ticks;
      for (auto line = axis.child("path"); line; line = line.next_sibling("path")) {
        double x = 0.0, y = 0.0;
        std::istringstream(std::string(line.attribute("d").value()).substr(1)) >> x >> y;
        ticks.emplace_back(is_x ? x : y, line.next_sibling("text").text().as_double());
      }
      ASSERT_GE(ticks.size(), 3U) << far_m;
      EXPECT_LE(ticks.size(), 25U) << far_m;
      ends.push_back({ticks.front().first, ticks.front().second, ticks.back().first, ticks.back().second});
    }
    const auto metres = [&](std::size_t axis, double px) {
      const auto& [a_px, a_m, b_px, b_m] = ends[axis];
      return a_m + (px - a_px) * (b_m - a_m) / (b_px - a_px);
    };
    std::vector<std::array<double, 2>> marks;  // diamonds: their top has the x, their right the y
    for (const auto& group : document.child("svg").children("g")) {
      if (!group.child("title")) continue;
      std::string d = group.child("path").attribute("d").value();
      std::ranges::replace_if(
          d, [](char c) { return c == 'M' || c == 'L' || c == 'Z'; }, ' ');
      double top_x = 0.0, top_y = 0.0, right_x = 0.0, right_y = 0.0;
      std::istringstream(d) >> top_x >> top_y >> right_x >> right_y;
      marks.push_back({metres(0, top_x), metres(1, right_y)});
    }
    ASSERT_EQ(marks.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(marks[i][0], layout.stations[i].position_m.x(), 2e-3 * far_m);
      EXPECT_NEAR(marks[i][1], layout.stations[i].position_m.y(), 2e-3 * far_m);
    }
  }
}

TEST(LayoutSvg, NamesAreEscaped) {
  const auto document = parsed(layout_svg(pair(true)));
  EXPECT_EQ(std::string(document.child("svg").child("title").text().get()), "low & <high>: 2 stations, 1 segment");
}

TEST(LayoutSvg, OneWaySegmentsHaveAnArrowHead) {
  EXPECT_NE(layout_svg(pair(true)), layout_svg(pair(false)));
  const auto count = [](const std::string& svg) {
    const auto document = parsed(svg);
    int heads = 0;
    for (const auto& node : document.child("svg").children("path"))
      heads += std::string_view(node.attribute("fill").value()) == "#c2410c" ? 1 : 0;
    return heads;
  };
  EXPECT_EQ(count(layout_svg(pair(true))), 1) << "the legend's";
  EXPECT_EQ(count(layout_svg(pair(false))), 2);
}

TEST(LayoutSvg, OnCrowdedMapsNoNameCoversAnother) {
  Layout crowd;
  crowd.name = "crowd";
  for (std::size_t i = 0; i < 400; ++i) {
    crowd.stations.push_back(
        {"station-" + std::to_string(i), {static_cast<double>(i % 20), static_cast<double>(i / 20)}, Purpose::Routing});
    if (i > 0) crowd.segments.push_back({"s" + std::to_string(i), StationId{i - 1}, StationId{i}, true, {}});
  }
  fit_floor(crowd, 3.0);
  const auto document = parsed(layout_svg(crowd));
  std::vector<std::pair<double, double>> written;
  for (const auto& node : document.child("svg").children("text")) {
    if (!std::string_view(node.text().get()).starts_with("station-")) continue;
    written.emplace_back(node.attribute("x").as_double(), node.attribute("y").as_double());
  }
  EXPECT_GT(written.size(), 50U);
  EXPECT_LT(written.size(), 400U);
  for (std::size_t i = 0; i < written.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const bool same_line = std::abs(written[i].second - written[k].second) < 8.0;
      EXPECT_TRUE(!same_line || std::abs(written[i].first - written[k].first) > 40.0) << i << ", " << k;
    }
  }
}

// The pictures of the gallery are those that the program draws.
TEST(LayoutSvg, TheGalleryIsUpToDate) {
  for (const auto& family : layout_families()) {
    for (const Range range : {Range::Normal, Range::Stress}) {
      Draws draws(stream_key(3, Stream::Layout));
      const auto name = std::string(family.name) + (range == Range::Stress ? "-stress" : "");
      EXPECT_TRUE(layout_svg(draw_layout({&family, range}, draws)) ==
                  independent::file_text(independent::source_file("tests/layouts/gallery/" + name + ".svg")))
          << "draw it again: fleetproof generate " << family.name << " --seed 3 "
          << (range == Range::Stress ? "--stress " : "") << "--svg tests/layouts/gallery/" << name
          << ".svg > layout.json";
    }
  }
}

}  // namespace
}  // namespace fleetproof::layout_svg_test
