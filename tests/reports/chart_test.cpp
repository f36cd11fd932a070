#include "reports/campaign_page/chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "core/base/error.hpp"

namespace fleetproof::html::chart_test {
namespace {

pugi::xml_document parsed(const Element& element) {
  pugi::xml_document document;
  const std::string text = element.str();
  EXPECT_TRUE(document.load_buffer(text.data(), text.size(), pugi::parse_full)) << text;
  return document;
}

// So many curves from (1, 1) to (100, `last`), which fall one after the other by `step`.
CurveChart falling(std::size_t curves, double last, double step) {
  CurveChart chart{"falling", "x", "y", {}, true, false, {}};
  for (std::size_t i = 0; i < curves; ++i) {
    chart.curves.push_back({"c", {{1.0, 1.0}, {100.0, last - step * static_cast<double>(i)}}});
  }
  return chart;
}

std::vector<pugi::xml_node> lines_of(const pugi::xml_document& document) {
  std::vector<pugi::xml_node> lines;
  for (const auto& path : document.select_nodes("/svg/path")) lines.push_back(path.node());
  return lines;
}

TEST(CurveChart, twelve_lines_differ_in_colour_and_in_dashes) {
  const auto document = parsed(draw(falling(12, 0.9, 0.05)));
  std::set<std::string> dashes, colours;
  for (const auto& line : lines_of(document)) {
    dashes.insert(line.attribute("stroke-dasharray").value());
    colours.insert(line.attribute("stroke").value());
  }
  EXPECT_EQ(colours.size(), 12u);
  EXPECT_EQ(dashes.size(), 12u) << "a print in grey has nothing but the dashes";
}

TEST(CurveChart, a_line_of_the_legend_looks_like_its_curve) {
  const auto document = parsed(draw(falling(12, 0.9, 0.05)));
  const auto lines = lines_of(document);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto sample = parsed(draw_sample(i));
    const auto line = sample.select_node("//line").node();
    for (const char* name : {"stroke", "stroke-dasharray"})
      EXPECT_STREQ(line.attribute(name).value(), lines[i].attribute(name).value()) << i;
    EXPECT_EQ(sample.select_node("//text").node().text().as_uint(), i + 1);
  }
}

// The numbers of the curves with their places, from the top.
std::vector<std::pair<double, std::string>> numbers_of(const pugi::xml_document& document) {
  std::vector<std::pair<double, std::string>> numbers;
  for (const auto& text : document.select_nodes("/svg/text[@font-weight='600' and @text-anchor='start']")) {
    const std::string shown = text.node().text().get();
    if (shown.find_first_not_of("0123456789, ") == std::string::npos)
      numbers.emplace_back(text.node().attribute("y").as_double(), shown);
  }
  return numbers;
}

TEST(CurveChart, lines_on_each_other_stay_visible) {
  const auto document = parsed(draw(falling(4, 0.1, 0.0)));
  std::set<double> turns;
  for (const auto& line : lines_of(document)) {
    EXPECT_STREQ(line.attribute("stroke-dasharray").value(), "12 36") << "one turn in four";
    turns.insert(line.attribute("stroke-dashoffset").as_double());
  }
  EXPECT_THAT(turns, testing::ElementsAre(-36.0, -24.0, -12.0, 0.0));
  EXPECT_THAT(numbers_of(document), testing::ElementsAre(testing::Pair(testing::_, "1, 2, 3, 4")));
  const double width = document.child("svg").attribute("width").as_double();
  EXPECT_GE(width, 64.0 + 450.0 + 8.0 + 10 * 6.0) << "the numbers have room beside the plot";
}

TEST(CurveChart, numbers_of_close_ends_do_not_cover_each_other) {
  const auto numbers = numbers_of(parsed(draw(falling(5, 0.5, 0.01))));
  ASSERT_EQ(numbers.size(), 5u);
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i) EXPECT_GE(numbers[i + 1].first, numbers[i].first + 11.9);
  EXPECT_EQ(numbers[0].second, "1");
}

// Before, the axis had no end, and drawing took all memory.
TEST(CurveChart, refuses_what_no_axis_can_show) {
  for (const double value : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(), 0.0}) {
    auto chart = falling(1, 0.3, 0.0);
    chart.curves[0].points.emplace_back(200.0, value);
    EXPECT_THROW(draw(chart), InvariantViolation);
  }
}

TEST(CurveChart, a_limit_does_not_lie_on_the_axis) {
  auto chart = falling(1, 0.3, 0.0);
  for (const double limit : {0.01, 0.0101, 0.001}) {
    chart.levels = {{limit, "limit"}};
    const auto document = parsed(draw(chart));
    const auto line = document.select_node("/svg/line[@stroke-opacity='0.8']").node();
    EXPECT_LT(line.attribute("y1").as_double(), 24.0 + 210.0 - 8.0) << limit << ": the axis is at 234 px";
    for (const auto& text : document.select_nodes("/svg/text[@text-anchor='end']"))
      EXPECT_LE(text.node().attribute("y").as_double(), 238.0) << "no mark below the axis";
  }
}

}  // namespace
}  // namespace fleetproof::html::chart_test
