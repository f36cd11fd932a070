// `replay --html` and `simulate --html`: the page has the run as it was. Nothing here uses the product's geometry:
// poses are evaluated from the data of the page alone and compared with those that --poses prints.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::replay_html_test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;
using testing::Not;

struct Point {
  double x = 0.0, y = 0.0;
};
Point mix(Point a, Point b, double k) { return {a.x + (b.x - a.x) * k, a.y + (b.y - a.y) * k}; }
struct Placed {
  Point at;
  double heading_rad = 0.0;
};

// Between two points of a track, as a Bezier curve whose control points lie a third of the way along the directions.
Placed on_track(const Json& points, double way_um) {
  std::size_t i = 0;
  while (i + 8 < points.size() && points[i + 7].get<double>() < way_um) i += 4;
  const auto v = [&](std::size_t k) { return points[i + k].get<double>(); };
  const double length = std::max(1.0, v(7) - v(3)), k = std::clamp((way_um - v(3)) / length, 0.0, 1.0);
  const auto ahead = [&](std::size_t p, double part) {
    return Point{v(p) + part * length * std::cos(v(p + 2) / 1e6), v(p + 1) + part * length * std::sin(v(p + 2) / 1e6)};
  };
  const std::array<Point, 4> c = {ahead(0, 0.0), ahead(0, 1.0 / 3.0), ahead(4, -1.0 / 3.0), ahead(4, 0.0)};
  const Point a = mix(mix(c[0], c[1], k), mix(c[1], c[2], k), k), b = mix(mix(c[1], c[2], k), mix(c[2], c[3], k), k);
  const Point at = mix(a, b, k);
  return {{at.x / 1e6, at.y / 1e6}, std::atan2(b.y - a.y, b.x - a.x)};
}

double way_of(const Json& piece, double t_us) {
  double way = 0.0;
  const double since_us = t_us - piece[2].get<double>();
  for (std::size_t i = 9; i < piece.size(); i += 4) {
    const double d_s = (since_us - piece[i].get<double>()) / 1e6;
    if (d_s < 0.0) break;
    way = piece[i + 1].get<double>() + piece[i + 2].get<double>() * d_s + piece[i + 3].get<double>() * d_s * d_s / 2.0;
  }
  return std::min(way, std::abs(piece[8].get<double>()));
}

Placed placed(const Json& film, const Json& piece, double t_us) {
  const int manner = piece[1];
  if (manner != 1) {
    const double turned = manner == 2 ? std::copysign(way_of(piece, t_us), piece[8].get<double>()) : 0.0;
    return {{piece[5].get<double>() / 1e6, piece[6].get<double>() / 1e6}, (piece[7].get<double>() + turned) / 1e6};
  }
  const Json& points = film["tracks"][piece[5].get<std::size_t>()]["points_um_urad"];
  const bool against = (piece[6].get<int>() & 1) != 0, tail_first = (piece[6].get<int>() & 2) != 0;
  const double way_um = piece[7].get<double>() + way_of(piece, t_us);
  Placed on = on_track(points, against ? points.back().get<double>() - way_um : way_um);
  if (against != tail_first) on.heading_rad += 3.14159265358979;
  return on;
}

// Four corners of a footprint of the film.
std::array<Point, 4> corners_of(const Json& film, const Json& piece, double t_us) {
  const Placed pose = placed(film, piece, t_us);
  const Json& outline = film["outlines_um"][piece[4].get<std::size_t>()];
  const double ux = std::cos(pose.heading_rad), uy = std::sin(pose.heading_rad);
  std::array<Point, 4> corners;
  const std::array<std::pair<int, int>, 4> signs = {{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const double along = (outline[2].get<double>() + signs[i].first * outline[0].get<double>() / 2.0) / 1e6;
    const double aside = signs[i].second * outline[1].get<double>() / 2e6;
    corners[i] = {pose.at.x + along * ux - aside * uy, pose.at.y + along * uy + aside * ux};
  }
  return corners;
}

double to_side_m(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double k = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(p.x - a.x - k * dx, p.y - a.y - k * dy);
}

// Of two bodies that do not overlap.
double apart_m(const Json& film, std::size_t a, std::size_t b, double t_us) {
  const auto corners = [&](std::size_t body) {
    const Json* found = nullptr;
    for (const Json& piece : film["pieces_us_um_urad"]) {
      if (piece[0] == body && piece[2].get<double>() <= t_us) found = &piece;
    }
    return corners_of(film, *found, t_us);
  };
  const auto one = corners(a), other = corners(b);
  double least = 1e9;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      least = std::min(least, to_side_m(one[i], other[k], other[(k + 1) % 4]));
      least = std::min(least, to_side_m(other[i], one[k], one[(k + 1) % 4]));
    }
  }
  return least;
}

struct Off {
  double place_m = 0.0, heading = 0.0;
  int poses = 0, curved = 0, backward = 0, turning = 0;
};

class ReplayHtml : public test::ProgramTest {
 protected:
  Json film(const std::string& file) const {
    const std::string page = read(path(file)), begin = "<script type=\"application/json\" id=\"film\">";
    const auto from = page.find(begin) + begin.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  }
  void compare_poses(Off& off) const {
    const Json data = film("p.html");
    std::map<std::string, std::vector<Json>> pieces;
    for (const Json& piece : data["pieces_us_um_urad"])
      pieces[data["bodies"][piece[0].get<std::size_t>()]["name"]].push_back(piece);
    std::istringstream csv(read(path("p.csv")));
    std::string line;
    std::getline(csv, line);
    while (std::getline(csv, line)) {
      std::istringstream fields(line);
      std::string name, field;
      std::getline(fields, name, ',');
      std::array<double, 5> v{};
      for (double& value : v) std::getline(fields, field, ','), value = std::stod(field);
      const double t_us = v[0] * 1e6;
      const auto& own = pieces.at(name);
      const auto piece = std::ranges::find_if(own, [&](const Json& p) { return t_us <= p[3].get<double>() + 0.5; });
      ASSERT_NE(piece, own.end()) << line;
      const Placed pose = placed(data, *piece, t_us);
      off.place_m = std::max(off.place_m, std::hypot(pose.at.x - v[1], pose.at.y - v[2]));
      off.heading =
          std::max(off.heading, std::hypot(std::cos(pose.heading_rad) - v[3], std::sin(pose.heading_rad) - v[4]));
      const bool drives = (*piece)[1] == 1;
      off.curved += drives && data["tracks"][(*piece)[5].get<std::size_t>()]["points_um_urad"].size() > 8 ? 1 : 0;
      off.backward += drives && (*piece)[6].get<int>() >= 2 ? 1 : 0;
      off.turning += (*piece)[1] == 2 ? 1 : 0;
      ++off.poses;
    }
  }
  // A run that ends in a contact: the agent takes silence for consent.
  void make_failure() {
    write("a.toml",
          "name = \"a\"\nreplicates = 4\nhorizon_s = 200\n[factors]\nagents = [\"timeout-grant\"]\nlayouts = "
          "[\"aisle-grid\"]\nfleet_sizes = [5]\nloss = [0.4]\ndelay_s = [2]\n[world]\ntransports_per_agv_hour = 60\n");
    ASSERT_EQ(run("run a.toml --db a.db --exit-zero").exit_code, 0);
  }
};

TEST_F(ReplayHtml, HasThePosesOfTheEngineToAMillimetre) {
  const std::string vehicle =
      "[world]\ntransports_per_agv_hour = 240\n[[vehicle]]\nname = \"fork\"\ncentre_ahead_m = 0.3\n"
      "loaded_extra_length_m = 0.4\n";
  write("a.toml",
        "replicates = 1\nhorizon_s = 60\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"corridor-sidings\", "
        "\"plant/overhang-pass\", \"random-planar\", \"loop-spurs\"]\nfleet_sizes = [5]\n" +
            vehicle);
  write("b.toml",
        "replicates = 1\nhorizon_s = 300\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"plant/back-in\"]\n"
        "fleet_sizes = [5]\n" +
            vehicle);
  Off off;
  for (const auto& [campaign, runs] : {std::pair("a", 4), {"b", 1}}) {
    ASSERT_TRUE(test::has_verdict(run(std::string("run ") + campaign + ".toml")));
    for (int i = 0; i < runs; ++i) {
      const auto replayed = run("replay " + std::string(campaign) + ".db " + std::to_string(i) +
                                " --html p.html --poses p.csv --every-ms 70");
      ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
      compare_poses(off);
    }
  }
  std::cout << off.poses << " poses, " << off.curved << " in bends, " << off.backward << " backward, " << off.turning
            << " turning: off by " << off.place_m << " m, " << off.heading << " of the heading\n";
  EXPECT_LT(off.place_m, 1e-3);
  EXPECT_LT(off.heading, 1e-3);
  EXPECT_GT(off.curved, 50);
  EXPECT_GT(off.backward, 20);
  EXPECT_GT(off.turning, 50);
}

TEST_F(ReplayHtml, HasTheMessagesBeliefsAndStatesOfTheTrace) {
  make_failure();
  ASSERT_EQ(run("replay a.db 0 --html p.html --trace-output t.jsonl --trace-format json").exit_code, 0);
  std::map<std::string, std::size_t> traced;
  std::istringstream lines(read(path("t.jsonl")));
  for (std::string line; std::getline(lines, line);) ++traced[Json::parse(line)["event"]];
  const Json data = film("p.html");
  std::size_t received = 0, lost = 0;
  const auto end_ms = data["end_us"].get<std::int64_t>() / 1000;
  for (const Json& message : data["messages_ms"]) {
    for (std::size_t i = 7; i < message.size(); i += 2) {
      const bool is_under_way = message[3].get<std::int64_t>() + message[i].get<std::int64_t>() > end_ms;
      if (!is_under_way) ++(message[i].get<int>() < 0 ? lost : received);
    }
  }
  EXPECT_GT(lost, 100U);
  EXPECT_EQ(data["messages_ms"].size(), traced["sent"]);
  EXPECT_EQ(received, traced["received"]);
  EXPECT_EQ(lost, traced["lost"]);
  EXPECT_EQ(data["beliefs_ms_mm_mrad"].size(), traced["believes"]);
  EXPECT_EQ(data["states_ms"].size(), traced["state"]);
  EXPECT_EQ(data["activities_ms"].size(), traced["begins"]);
}

TEST_F(ReplayHtml, OpensBeforeTheFirstViolationAndHasItsClearance) {
  make_failure();
  ASSERT_EQ(run("replay a.db 0 --html p.html --scenario s.json").exit_code, 0);
  const Json judged = Json::parse(run("simulate s.json --json").out), data = film("p.html");
  ASSERT_FALSE(judged["violations"].empty());
  const Json& first = judged["violations"][0];
  const double first_us = first["first_ns"].get<double>() / 1e3;
  EXPECT_NEAR(data["focus_us"].get<double>(), first_us, 1.0);
  EXPECT_LT(data["open_us"].get<double>(), first_us);
  EXPECT_GT(data["open_us"].get<double>(), first_us - 120e6) << "where the AGV decided";
  EXPECT_EQ(data["violations"].size(), judged["violations"].size());
  const Json& points = data["clearances"][0]["points_us_um"];
  double least_um = 1e12, last_us = -1.0;
  bool has_closest = false;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    EXPECT_GT(points[i].get<double>(), last_us);
    last_us = points[i].get<double>();
    least_um = std::min(least_um, points[i + 1].get<double>());
    has_closest = has_closest || std::abs(last_us - first["at_ns"].get<double>() / 1e3) <= 1.0;
  }
  EXPECT_EQ(least_um, first["min_clearance_um"].get<double>());
  EXPECT_TRUE(has_closest);
  const std::string page = read(path("p.html"));
  EXPECT_THAT(page, HasSubstr("<code>fleetproof replay a.db 0</code>"));
  EXPECT_THAT(page, HasSubstr("class=\"frame\""));
  EXPECT_THAT(page, HasSubstr(judged["digest"].get<std::string>()));
}

// Looked for in all pairs every 20 ms. Two AGVs come nearer by at most 4 m/s and by what their turns add. They may come
// as near more than once.
TEST_F(ReplayHtml, WithoutAViolationItHasThePairThatCameClosest) {
  write("n.toml",
        "kind = \"search\"\nreplicates = 1\nhorizon_s = 150\n[factors]\nagents = [\"hull-lock\"]\nlayouts = "
        "[\"aisle-grid\"]\nfleet_sizes = [7]\n[world]\ntransports_per_agv_hour = 120\n");
  run("run n.toml --db n.db");
  ASSERT_EQ(run("replay n.db 0 --html p.html").exit_code, 0);
  const Json data = film("p.html");
  ASSERT_TRUE(data["violations"].empty());
  const Json& nearest = data["nearest"];
  double least_m = 1e9;
  for (double t_us = 0.0; t_us < data["end_us"].get<double>(); t_us += 20'000.0) {
    for (std::size_t a = 0; a < 7; ++a) {
      for (std::size_t b = a + 1; b < 7; ++b) least_m = std::min(least_m, apart_m(data, a, b, t_us));
    }
  }
  const double told_m = nearest["clearance_um"].get<double>() / 1e6;
  EXPECT_LE(told_m, least_m + 0.001);
  EXPECT_GE(told_m, least_m - 0.1);
  const double told_at_us = nearest["at_us"].get<double>();
  EXPECT_NEAR(apart_m(data, nearest["a"], nearest["b"], told_at_us), told_m, 0.002);
  EXPECT_GT(told_at_us, 0.0) << "the fleet starts with more room than it has later";
  const auto& points = data["clearances"][0]["points_us_um"];
  EXPECT_THAT(read(path("p.html")), HasSubstr(fmt::format("m at {:.3f} s", std::floor(told_at_us / 1e3) / 1e3)));
  EXPECT_LT(points.front().get<double>(), told_at_us);
  EXPECT_EQ(data["focus_us"], nearest["at_us"]);
}

TEST_F(ReplayHtml, TheSameRunGivesTheSamePageAlsoFromAScenarioFile) {
  make_failure();
  ASSERT_EQ(run("replay a.db 0 --html p.html --scenario s.json").exit_code, 0);
  ASSERT_EQ(run("replay a.db 0 --html q.html").exit_code, 0);
  EXPECT_EQ(read(path("p.html")), read(path("q.html")));
  EXPECT_TRUE(test::has_verdict(run("simulate s.json --html r.html")));
  EXPECT_EQ(film("r.html"), film("p.html"));
  EXPECT_THAT(read(path("r.html")), HasSubstr("<code>fleetproof simulate s.json --agent timeout-grant</code>"));
}

TEST_F(ReplayHtml, OverwritesOnlyAReplayPage) {
  make_failure();
  ASSERT_EQ(run("report a.db --html report.html --exit-zero").exit_code, 0);
  write("mine.html", "<!DOCTYPE html>\n<p>fleetproof replay</p>\n");
  for (const char* file : {"report.html", "mine.html"}) {
    const auto before = read(path(file));
    const auto refused = run(std::string("replay a.db 0 --html ") + file);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("is there already and is not a replay page"));
    EXPECT_EQ(read(path(file)), before);
  }
  ASSERT_EQ(run("replay a.db 0 --html p.html").exit_code, 0);
  const auto first = read(path("p.html"));
  ASSERT_EQ(run("replay a.db 1 --html p.html").exit_code, 0);
  EXPECT_NE(read(path("p.html")), first);
  EXPECT_EQ(run("report a.db --html p.html --exit-zero").exit_code, 2) << "a report replaces no replay page";
}

TEST_F(ReplayHtml, ADeadlockSaysWhoWaitsForWhom) {
  write("d.toml",
        "replicates = 1\nkind = \"search\"\nhorizon_s = 400\n[factors]\nagents = [\"never-makes-way\"]\nlayouts = "
        "[\"corridor-sidings\"]\nfleet_sizes = [8]\n[world]\ntransports_per_agv_hour = 120\n");
  run("run d.toml --db d.db");
  ASSERT_EQ(run("replay d.db 0 --html p.html").exit_code, 0);
  const std::string page = read(path("p.html"));
  ASSERT_THAT(page, HasSubstr("<h1>Deadlock: "));
  EXPECT_THAT(page, testing::ContainsRegex("<p>AGV [0-9]+ stood at [^<]* and that it waited for AGV [0-9]+ \\(since "));
  EXPECT_THAT(page, HasSubstr("id=\"who-waits-for-whom\""));
  EXPECT_THAT(page, HasSubstr("this pair came closest of all"));
  EXPECT_GE(film("p.html")["involved"].size(), 2U);
}

// The server never repeats a grant: it believes that the AGVs have what the radio has lost.
TEST_F(ReplayHtml, AStallOfACentralFleetSaysWhatTheServerHadSaid) {
  write("g.toml",
        "seed = 77\nreplicates = 2\nkind = \"search\"\nhorizon_s = 300\n[factors]\nagents = [{ vehicle = "
        "\"follower\", computer = \"grants-once\" }]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [5]\nloss = [0.4]\n"
        "delay_s = [2]\n[world]\ntransports_per_agv_hour = 30\n");
  run("run g.toml --db g.db");
  ASSERT_EQ(run("replay g.db 0 --html p.html").exit_code, 0);
  const std::string page = read(path("p.html"));
  ASSERT_THAT(page, HasSubstr("<h1>Deadlock: "));
  EXPECT_THAT(page,
              testing::ContainsRegex("the last that said something else, GRANT #[0-9]+ [^<]*, lost by chance\\."));
  const Json shown = film("p.html");
  EXPECT_EQ(shown["involved"].size(), 5U) << "no circle is known: the fleet stands";
  EXPECT_THAT(page, HasSubstr("<code>fleetproof explain g.db 0</code>"));
}

// There is nothing to see before it, so the strip shows what comes after.
TEST_F(ReplayHtml, ADeadlockRightFromTheStartIsShownAsItLasts) {
  write("d.toml",
        "seed = 5\nreplicates = 1\nkind = \"search\"\nhorizon_s = 200\n[factors]\nagents = "
        "[\"never-makes-way\"]\nlayouts = [\"corridor-sidings\"]\nfleet_sizes = [12]\n[world]\n"
        "transports_per_agv_hour = 400\n");
  run("run d.toml --db d.db");
  ASSERT_EQ(run("replay d.db 0 --html p.html").exit_code, 0);
  const std::string page = read(path("p.html"));
  const double focus_s = film("p.html")["focus_us"].get<double>() / 1e6;
  ASSERT_LT(focus_s, 10.0);
  // The page opens when all of the circle say for whom they wait.
  const Json shown = film("p.html");
  EXPECT_GE(shown["open_us"], shown["focus_us"]);
  std::map<std::size_t, int> waits;
  for (const Json& wait : shown["waits_ms"]) {
    if (wait[1] <= shown["open_us"].get<std::int64_t>() / 1000) waits[wait[0]] = wait[2];
  }
  for (const std::size_t body : shown["involved"])
    EXPECT_THAT(shown["involved"], testing::Contains(Json(waits[body]))) << body;
  const std::regex frame("aria-label=\"at ([0-9.]+) s");
  std::vector<double> frames_s;
  for (std::sregex_iterator at(page.begin(), page.end(), frame), end; at != end; ++at)
    frames_s.push_back(std::stod((*at)[1]));
  ASSERT_GE(frames_s.size(), 2U);
  EXPECT_NEAR(frames_s[0], focus_s, 0.01) << "before it, all stood as they do";
  // A picture that shows nothing new is left out, and the page says so.
  EXPECT_LT(frames_s.size(), 6U);
  EXPECT_THAT(page, HasSubstr("While nothing moves here, there is no further picture"));
  std::vector<std::string> floors;
  for (auto at = page.find("<svg x="); at != std::string::npos; at = page.find("<svg x=", at + 1))
    floors.push_back(page.substr(at, page.find("</svg>", at) - at));
  EXPECT_EQ(floors.size(), frames_s.size());
  EXPECT_EQ(std::ranges::adjacent_find(floors), floors.end());
}

// Its recording plays the run: the software would end this process.
TEST_F(ReplayHtml, ACrashOfAPlugInIsShownFromItsRecording) {
  std::filesystem::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
  write("c.toml",
        "kind = \"search\"\nhorizon_s = 30\n[factors]\nagents = [{ file = \"failing.so\", config = \"abort 1\" "
        "}]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n");
  ASSERT_TRUE(test::has_verdict(run("run c.toml --db c.db")));
  const auto replayed = run("replay c.db 0 --html p.html");
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(read(path("p.html")), testing::ContainsRegex("<h1>Crash of the agent of AGV [0-9]+ at "));
}

// In the browser: the scripts run, the address decides the instant and the AGV, and the panel has the pose of the
// engine.
TEST_F(ReplayHtml, RunsInABrowser) {
  if (shell("command -v chromium").exit_code != 0) GTEST_SKIP() << "there is no chromium";
  make_failure();
  ASSERT_EQ(run("replay a.db 0 --html p.html --poses p.csv --every-ms 500").exit_code, 0);
  const auto shown = shell(
      "timeout 120 chromium --headless=new --no-sandbox --disable-gpu --user-data-dir=\"$PWD/profile\" "
      "--enable-logging=stderr --dump-dom \"file://$PWD/p.html#t=20.5&agv=2\"");
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("data-ready=\"yes\""));
  EXPECT_THAT(shown.err, Not(HasSubstr("Uncaught")));
  EXPECT_THAT(shown.err, Not(HasSubstr("Content Security Policy")));
  EXPECT_THAT(shown.out, HasSubstr("id=\"clock\">20.500 s<"));
  std::smatch pose;
  const std::regex words(
      "class=\"who[^\"]*\">AGV 2</div><table><tbody><tr><td class=\"soft\">at</td><td>"
      "\\(([-0-9.]+), ([-0-9.]+)\\) m");
  ASSERT_TRUE(std::regex_search(shown.out, pose, words));
  std::istringstream csv(read(path("p.csv")));
  bool found = false;
  for (std::string line; std::getline(csv, line);) {
    std::smatch at;
    if (!std::regex_match(line, at, std::regex("AGV 2,20.5,([^,]*),([^,]*),.*"))) continue;
    found = true;
    EXPECT_NEAR(std::stod(pose[1]), std::stod(at[1]), 0.0101);
    EXPECT_NEAR(std::stod(pose[2]), std::stod(at[2]), 0.0101);
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace fleetproof::replay_html_test
