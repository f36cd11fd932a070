// `simulate --at T --svg FILE` and `replay --at T --svg FILE`: the picture has the floor as it was at that instant.
// Nothing here uses the product's geometry: places are read off the axes, as a reader does, and compared with closed
// forms or with what --poses prints.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <regex>

#include "tests/support/program.hpp"

namespace fleetproof::moment_picture_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

struct P {
  double x = 0.0, y = 0.0;
};
using Points = std::vector<P>;

// Of each match: all of it, and its groups.
std::vector<std::vector<std::string>> all(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::vector<std::string>> matches;
  for (std::sregex_iterator match(text.begin(), text.end(), regex); match != std::sregex_iterator(); ++match)
    matches.emplace_back(match->begin(), match->end());
  return matches;
}

// Pixels to metres along one axis, by its first and its last number.
struct Axis {
  double first_px = 0.0, first_m = 0.0, last_px = 0.0, last_m = 0.0;

  Axis() = default;
  Axis(const std::string& svg, const std::string& line) {
    const auto ticks = all(svg, "<path d=\"" + line + "\"/>\n<text [^>]*stroke=\"none\">(-?[0-9]+)</text>");
    EXPECT_GE(ticks.size(), 4U);
    if (ticks.empty()) return;
    first_px = std::stod(ticks.front()[1]), first_m = std::stod(ticks.front()[2]);
    last_px = std::stod(ticks.back()[1]), last_m = std::stod(ticks.back()[2]);
  }
  double metres(double px) const { return first_m + (px - first_px) * (last_m - first_m) / (last_px - first_px); }
  double scale() const { return std::abs((last_px - first_px) / (last_m - first_m)); }
};

// A body or an activity: its title, and the paths of its group.
struct Group {
  std::vector<std::string> paths;
  std::vector<std::string> fills;
};

class Picture {
 public:
  explicit Picture(const std::string& svg)
      : svg_(svg), x_(svg, "M([0-9.]+) [0-9.]+V[0-9.]+"), y_(svg, "M[0-9.]+ ([0-9.]+)H[0-9.]+") {}

  Group group(const std::string& title) const {
    Group group;
    const std::size_t begin = svg_.find("<title>" + title + "</title>");
    EXPECT_NE(begin, std::string::npos) << title;
    if (begin == std::string::npos) return group;
    for (const auto& path :
         all(svg_.substr(begin, svg_.find("</g>", begin) - begin), "<path d=\"([^\"]*)\" fill=\"([^\"]*)\"")) {
      group.paths.push_back(path[1]);
      group.fills.push_back(path[2]);
    }
    return group;
  }
  bool has(const std::string& title) const { return svg_.find("<title>" + title + "</title>") != std::string::npos; }
  // The polygons of a path, in metres.
  std::vector<Points> polygons(const std::string& path) const {
    std::vector<Points> polygons;
    for (const auto& point : all(path, "([ML])([-0-9.]+) ([-0-9.]+)")) {
      if (point[1] == "M") polygons.emplace_back();
      polygons.back().push_back({x_.metres(std::stod(point[2])), y_.metres(std::stod(point[3]))});
    }
    return polygons;
  }
  double scale() const { return x_.scale(); }
  std::vector<std::string> words() const {
    std::vector<std::string> words;
    for (const auto& text : all(svg_, "font-size=\"12.5\"[^>]*>([^<]*)<")) words.push_back(text[1]);
    return words;
  }

 private:
  std::string svg_;
  Axis x_, y_;
};

// The way of a drive of `length_m` after `t_s` at 2 m/s, 0.5 m/s2 and 1 m/s2: a trapezoid, or a triangle.
double way_m(double length_m, double t_s) {
  const double peak = std::min(2.0, std::sqrt(length_m * 2.0 * 0.5 * 1.0 / 1.5)), up_s = peak / 0.5, down_s = peak;
  const double even_s = (length_m - peak * up_s / 2.0 - peak * down_s / 2.0) / peak;
  if (t_s <= 0.0) return 0.0;
  if (t_s <= up_s) return 0.25 * t_s * t_s;
  if (t_s <= up_s + even_s) return peak * (t_s - up_s / 2.0);
  const double left_s = std::max(0.0, up_s + even_s + down_s - t_s);
  return length_m - 0.5 * left_s * left_s;
}

// The five drives of Fig. 4.
struct Drive {
  const char *name, *words;
  P from, ahead;
  double length_m, begin_s, end_s;
};
constexpr double kTop_m = 4.0 + 25.0 / 6.0;
const std::array<Drive, 5> kDrives = {
    {{"A", "A drives from 10 to 9, 2.000 s to 10.000 s", {0, 0}, {1, 0}, 10, 2, 10},
     {"B", "B drives from 6 to 1, 4.000 s to 9.000 s", {0, 4}, {0, 1}, 25.0 / 6.0, 4, 9},
     {"C", "C drives from 2 to 3, 7.000 s to 12.000 s", {1.39, kTop_m}, {1, 0}, 25.0 / 6.0, 7, 12},
     {"D", "D drives from 8 to 7, 6.000 s to 9.000 s", {6.85, 2.39}, {0, -1}, 1.5, 6, 9},
     {"E", "E drives from 4 to 5, 2.000 s to 5.000 s", {8, kTop_m}, {1, 0}, 1.5, 2, 5}}};

// Corners of the box from one place of the reference point to another, along an axis.
struct Box {
  double low_x, low_y, high_x, high_y;
};
Box box_of(P one, P other, P ahead) {
  const double half_x = std::abs(ahead.x) * 0.8 + std::abs(ahead.y) * 0.5,
               half_y = std::abs(ahead.x) * 0.5 + std::abs(ahead.y) * 0.8;
  return {std::min(one.x, other.x) - half_x, std::min(one.y, other.y) - half_y, std::max(one.x, other.x) + half_x,
          std::max(one.y, other.y) + half_y};
}
void expect_box(const std::vector<Points>& polygons, const Box& box, const std::string& what) {
  ASSERT_EQ(polygons.size(), 1U) << what;
  ASSERT_EQ(polygons[0].size(), 4U) << what;
  for (const double x : {box.low_x, box.high_x}) {
    for (const double y : {box.low_y, box.high_y})
      EXPECT_TRUE(std::ranges::any_of(polygons[0], [&](P p) { return std::hypot(p.x - x, p.y - y) < 5e-4; }))
          << what << ": no corner at " << x << ", " << y;
  }
}

constexpr const char *kWarm = "#f2bf9f", *kCold = "#b9d0e6",
                     *kTooClose = "stroke=\"#c00000\" stroke-width=\"2\"/>\n<path";

class MomentPicture : public test::ProgramTest {
 protected:
  std::string drawn(const std::string& words, double t_s) const {
    const auto finished = run(words + " --at " + std::to_string(t_s) + " --svg p.svg");
    EXPECT_TRUE(test::has_verdict(finished));
    EXPECT_EQ(shell("xmllint --noout --nonet p.svg").exit_code, 0);
    return read(path("p.svg"));
  }
  const std::string figure4_ = "simulate '" + test::source("tests/scenarios/figure4.json") + "'";
};

TEST_F(MomentPicture, BodiesAndHullsOfFigure4StandWhereTheClosedFormsPutThem) {
  for (const double t_s : {0.0, 3.0, 5.0, 6.5, 7.0, 8.08, 9.0, 10.25, 12.0}) {
    const Picture picture(drawn(figure4_, t_s));
    for (const Drive& drive : kDrives) {
      const auto at = [&](double way) {
        return P{drive.from.x + way * drive.ahead.x, drive.from.y + way * drive.ahead.y};
      };
      const std::string what = std::string(drive.name) + " at " + std::to_string(t_s);
      const P now = at(way_m(drive.length_m, t_s - drive.begin_s));
      expect_box(picture.polygons(picture.group(drive.name).paths.at(0)), box_of(now, now, drive.ahead), what);
      const bool in_progress = t_s >= drive.begin_s && t_s <= drive.end_s;
      EXPECT_EQ(picture.has(drive.words), in_progress) << what;
      if (in_progress)
        expect_box(picture.polygons(picture.group(drive.words).paths.at(3)),
                   box_of(at(0.0), at(drive.length_m), drive.ahead), what + ", hull");
    }
  }
}

// Figs. 6, 7, 9 and 10: whose activity perimeters overlap, and where the safety perimeter is broken.
TEST_F(MomentPicture, ConflictsAreThoseOfThePaper) {
  const auto fill = [](const Picture& picture, std::size_t drive) {
    return picture.group(kDrives.at(drive).words).fills.at(3);
  };
  const std::string at_3 = drawn(figure4_, 3.0);
  EXPECT_EQ(fill(Picture(at_3), 0), kCold);
  EXPECT_EQ(fill(Picture(at_3), 4), kCold);
  EXPECT_THAT(Picture(at_3).words(),
              ElementsAre("A drives from 10 to 9, 2.000 s to 10.000 s; E drives from 4 to 5, 2.000 s to 5.000 s",
                          "No activity perimeter has another one or a body in it."));
  // A and E drive alone; C, which is to drive later, stands 0.09 m beside the hull of B.
  const std::string at_4 = drawn(figure4_, 4.5);
  for (const auto& [drive, colour] : {std::pair(0U, kCold), {1U, kWarm}, {4U, kCold}})
    EXPECT_EQ(fill(Picture(at_4), drive), colour) << drive;
  EXPECT_THAT(Picture(at_4).words().back(), HasSubstr("B and C: C stands in the activity perimeter of B; now "));
  EXPECT_THAT(at_4, Not(HasSubstr(kTooClose)));
  const std::string at_8 = drawn(figure4_, 8.08);
  for (std::size_t drive = 0; drive < 4; ++drive) EXPECT_EQ(fill(Picture(at_8), drive), kWarm) << drive;
  EXPECT_EQ(all(at_8, kTooClose).size(), 2U) << "A and D";
  EXPECT_THAT(
      Picture(at_8).words(),
      ElementsAre("A drives from 10 to 9, 2.000 s to 10.000 s; B drives from 6 to 1, 4.000 s to 9.000 s; "
                  "C drives from 2 to 3, 7.000 s to 12.000 s",
                  "D drives from 8 to 7, 6.000 s to 9.000 s",
                  "A and D: activity perimeters overlap, both in progress 6.000 s to 9.000 s; now 0.014 m apart, "
                  "below the safety distance of 0.10 m",
                  "B and C: activity perimeters overlap, both in progress 7.000 s to 9.000 s; now 0.381 m apart"));
  EXPECT_THAT(at_8,
              HasSubstr("<title>Fig. 4 of the paper: A and D come too close, B and C nearly, T = 8.08 s</title>"));
}

// The other hole of the paper's rule: who only stands there for a while.
TEST_F(MomentPicture, ABodyThatStandsInAnActivityPerimeterIsNamed) {
  const std::string parked = "simulate '" + test::source("tests/scenarios/parked_then_leaves.json") + "'";
  EXPECT_THAT(Picture(drawn(parked, 1.0)).words().at(1),
              HasSubstr("X and Y: Y stands in the activity perimeter of X; "));
  EXPECT_THAT(Picture(drawn(parked, 3.0)).words().at(1), HasSubstr("now 0.050 m apart, below the safety distance"));
}

// Hulls of parallel drives, 0.15 m, 0.25 m and 0.20 m apart: perimeters that reach 0.10 m overlap in the first pair.
TEST_F(MomentPicture, PerimetersOverlapBelowTwiceTheSafetyDistance) {
  std::string agvs, stations, segments;
  const std::array<double, 4> lanes_m = {0.0, 1.15, 2.40, 3.60};
  for (std::size_t i = 0; i < lanes_m.size(); ++i) {
    const std::string n = std::to_string(i), y = std::to_string(lanes_m[i]), more = i == 0 ? "" : ", ";
    agvs += more + R"({"name": "P)" + n + R"(", "start": "a)" + n +
            R"(", "heading": [1, 0], "script": [{"at_s": 1, "action": "move", "segment": "s)" + n + R"("}]})";
    stations += more + R"({"name": "a)" + n + R"(", "position_m": [0, )" + y + R"(]}, {"name": "b)" + n +
                R"(", "position_m": [9, )" + y + "]}";
    segments += more + R"({"name": "s)" + n + R"(", "from": "a)" + n + R"(", "to": "b)" + n + R"("})";
  }
  write("lanes.json", R"({"version": 1, "name": "lanes", "horizon_s": 9, "agvs": [)" + agvs +
                          R"(], "layout": {"name": "lanes", "floor_low_m": [-3, -3], "floor_high_m": [12, 7],
                             "stations": [)" +
                          stations + R"(], "segments": [)" + segments + "]}}");
  const auto words = Picture(drawn("simulate lanes.json", 3.0)).words();
  ASSERT_EQ(words.size(), 3U);
  EXPECT_EQ(words[2], "P0 and P1: activity perimeters overlap, both in progress 1.000 s to 8.500 s; now 0.150 m apart");
}

// The stroke around a hull is as wide as twice the safety distance: to scale.
TEST_F(MomentPicture, PerimetersAreToScale) {
  const std::string svg = drawn(figure4_, 8.08);
  const Picture picture(svg);
  const auto width = all(svg.substr(svg.find("A drives")), "stroke-width=\"([0-9.]+)\" stroke-linejoin=\"round\"");
  ASSERT_GE(width.size(), 2U);
  EXPECT_NEAR(std::stod(width[1][1]) / picture.scale(), 2.0 * 0.10, 1e-3);
  // The safety perimeter of A: sides 0.10 m from those of the body, and round corners.
  const std::string perimeter = picture.group("A").paths.at(1);
  double least_y = 1e9, most_y = -1e9;
  for (const auto& polygon : picture.polygons(perimeter)) {
    for (const P p : polygon) least_y = std::min(least_y, p.y), most_y = std::max(most_y, p.y);
  }
  EXPECT_NEAR(least_y, -0.6, 5e-4);
  const auto arcs = all(perimeter, "A([0-9.]+) ");
  ASSERT_EQ(arcs.size(), 4U);
  EXPECT_NEAR(std::stod(arcs[0][1]) / picture.scale(), 0.10, 1e-3);
}

double to_side(P p, P a, P b) {
  const double along_x = b.x - a.x, along_y = b.y - a.y;
  const double k =
      std::clamp(((p.x - a.x) * along_x + (p.y - a.y) * along_y) / (along_x * along_x + along_y * along_y), 0.0, 1.0);
  return std::hypot(p.x - a.x - k * along_x, p.y - a.y - k * along_y);
}

// 0 inside.
double outside_by(P p, const Points& polygon) {
  double least = 1e9;
  int left = 0, right = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const P a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    left += side > 0.0 ? 1 : 0;
    right += side < 0.0 ? 1 : 0;
    least = std::min(least, to_side(p, a, b));
  }
  return left == 0 || right == 0 ? 0.0 : least;
}
double outside_by(P p, const std::vector<Points>& polygons) {
  double least = 1e9;
  for (const Points& polygon : polygons) least = std::min(least, outside_by(p, polygon));
  return least;
}

// The corners of the body at each instant of --poses from one second to another.
std::vector<Points> bodies(const std::string& csv, double from_s, double to_s) {
  std::vector<Points> bodies;
  for (const auto& row : all(csv, "fork,([^,\n]+),([^,\n]+),([^,\n]+),([^,\n]+),([^,\n]+),")) {
    std::array<double, 5> v{};
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::stod(row[i + 1]);
    if (v[0] < from_s || v[0] > to_s) continue;
    const P ahead{v[3], v[4]}, centre{v[1] + 0.3 * ahead.x, v[2] + 0.3 * ahead.y};
    Points corners;
    for (const auto& [along, aside] : {std::pair(0.8, 0.5), {-0.8, 0.5}, {-0.8, -0.5}, {0.8, -0.5}})
      corners.push_back({centre.x + along * ahead.x - aside * ahead.y, centre.y + along * ahead.y + aside * ahead.x});
    bodies.push_back(corners);
  }
  return bodies;
}

// A turn, and a drive through a bend: the hull has all that the body covers, and nothing else.
TEST_F(MomentPicture, TheHullOfATurnAndOfABendIsWhatTheBodySweeps) {
  write("bend.json", R"({"version": 1, "name": "bend", "horizon_s": 15,
    "vehicle_types": [{"name": "fork", "length_m": 1.6, "width_m": 1, "centre_ahead_m": 0.3}],
    "agvs": [{"name": "fork", "start": "a", "heading": [0, 1],
              "script": [{"at_s": 1, "action": "move", "segment": "ab"}]}],
    "layout": {"name": "bend", "floor_low_m": [-3, -3], "floor_high_m": [7, 7],
      "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [4, 4]}],
      "segments": [{"name": "ab", "from": "a", "to": "b", "bidirectional": true,
                    "control_points_m": [[2.5, 0], [4, 1.5]]}]}})");
  ASSERT_EQ(run("simulate bend.json --poses p.csv --every-ms 1").exit_code, 0);
  const std::string csv = read(path("p.csv"));
  int found = 0;
  for (const double t_s : {1.5, 6.0}) {
    const std::string svg = drawn("simulate bend.json", t_s);
    const Picture picture(svg);
    const auto title = all(svg, "<title>(fork (turns|drives from a to b), ([0-9.]+) s to ([0-9.]+) s)</title>");
    ASSERT_EQ(title.size(), 1U) << t_s;
    ++found;
    const auto hull = picture.polygons(picture.group(title[0][1]).paths.at(3));
    EXPECT_GT(hull.size(), 3U);
    const auto swept = bodies(csv, std::stod(title[0][3]) - 0.005, std::stod(title[0][4]) + 0.005);
    ASSERT_GT(swept.size(), 1000U);
    double missing_m = 0.0, too_much_m = 0.0;
    for (const Points& body : swept) {
      for (const P corner : body) missing_m = std::max(missing_m, outside_by(corner, hull));
    }
    for (const Points& part : hull) {
      for (const P corner : part) too_much_m = std::max(too_much_m, outside_by(corner, swept));
    }
    EXPECT_LT(missing_m, 2e-3) << title[0][1];
    EXPECT_LT(too_much_m, 2e-3) << title[0][1];
  }
  EXPECT_EQ(found, 2);
}

// Of bold letters of 12 px; their boxes touch at most.
TEST_F(MomentPicture, NamesOfTwentyAgvsDoNotLieOnEachOther) {
  std::string agvs, stations, segments;
  for (int i = 0; i < 20; ++i) {
    const std::string at = "[" + std::to_string(1.3 * (i % 5)) + ", " + std::to_string(1.3 * (i / 5)) + "]";
    stations += fmt::format(R"({}{{"name": "s{}", "position_m": {}}})", i > 0 ? ", " : "", i, at);
    agvs += fmt::format(R"({}{{"name": "carrier {}", "start": "s{}", "heading": [1, 0]}})", i > 0 ? ", " : "", i, i);
    if (i > 0) segments += fmt::format(R"({}{{"from": "s{}", "to": "s{}"}})", i > 1 ? ", " : "", i - 1, i);
  }
  segments += R"(, {"from": "s19", "to": "s0"})";
  write("crowd.json", R"({"version": 1, "name": "crowd", "horizon_s": 20,
    "vehicle_types": [{"name": "cart", "length_m": 1, "width_m": 1}], "agvs": [)" +
                          agvs + R"(], "layout": {"name": "crowd", "floor_low_m": [-30, -30], "floor_high_m": [60, 60],
    "stations": [)" + stations +
                          R"(], "segments": [)" + segments + "]}}");
  const std::string svg = drawn("simulate crowd.json --agent reckless", 3.0);
  struct NameBox {
    std::string name;
    double x, y, half;
  };
  std::vector<NameBox> boxes;
  for (const auto& text : all(svg, "<text x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*>(carrier [0-9]+)</text>"))
    boxes.push_back({text[3], std::stod(text[1]), std::stod(text[2]), 3.5 * static_cast<double>(text[3].size())});
  EXPECT_GE(boxes.size(), 4U);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const bool apart = std::abs(boxes[i].x - boxes[k].x) >= boxes[i].half + boxes[k].half ||
                         std::abs(boxes[i].y - boxes[k].y) >= 11.5;
      EXPECT_TRUE(apart) << boxes[i].name << " and " << boxes[k].name;
    }
  }
}

TEST_F(MomentPicture, TheSameRunGivesTheSameBytesAndReplayDrawsWhatSimulateDraws) {
  EXPECT_EQ(drawn(figure4_, 8.08), drawn(figure4_, 8.08));
  EXPECT_NE(drawn(figure4_, 8.08), drawn(figure4_, 8.09));
  write("a.toml",
        "horizon_s = 60\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"random-planar\"]\nfleet_sizes = [5]\n"
        "[world]\ntransports_per_agv_hour = 240\n");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db")));
  const std::string replayed = drawn("replay a.db 0 --scenario s.json", 31.25);
  EXPECT_EQ(replayed, drawn("simulate s.json", 31.25));
  EXPECT_THAT(replayed, HasSubstr(", loaded</title>"));
}

TEST_F(MomentPicture, AnInstantOutsideTheRunIsRefused) {
  for (const std::string at : {"12.000000001", "-0.001", "nan", "inf", "1e300"}) {
    const auto refused = run(figure4_ + " --at " + at + " --svg p.svg --pieces p.json");
    EXPECT_EQ(refused.exit_code, 2) << at;
    EXPECT_THAT(refused.err, HasSubstr(" s; the run lasts from 0 to 12 s; choose an instant in it\n")) << at;
    EXPECT_FALSE(std::filesystem::exists(path("p.svg")) || std::filesystem::exists(path("p.json"))) << at;
  }
  const auto refused = [&](const std::string& words) {
    const auto finished = run(figure4_ + words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    return finished.err;
  };
  EXPECT_THAT(refused(" --svg p.svg"), HasSubstr("--svg: needs the instant of the picture; name its second with --at"));
  EXPECT_THAT(refused(" --at 3"), HasSubstr("--at: is the instant of a picture; name its file with --svg"));
  EXPECT_THAT(refused(" --at 3 --svg no/where.svg"),
              HasSubstr("no/where.svg: cannot be written (No such file or directory); choose another path for --svg"));
}

}  // namespace
}  // namespace fleetproof::moment_picture_test
