// What --pieces says is enough to judge a run again: poses, and the smallest clearance, from the file alone. Nothing
// here uses the product's geometry.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::pieces_test {
namespace {

using Json = nlohmann::json;

struct P {
  double x = 0.0, y = 0.0;
};
P operator+(P a, P b) { return {a.x + b.x, a.y + b.y}; }
P operator-(P a, P b) { return {a.x - b.x, a.y - b.y}; }
P operator*(P a, double k) { return {a.x * k, a.y * k}; }
double dot(P a, P b) { return a.x * b.x + a.y * b.y; }
double size(P a) { return std::hypot(a.x, a.y); }
P point(const Json& j) { return {j[0].get<double>(), j[1].get<double>()}; }

struct Placed {
  P at, heading;
};

// A cubic Bezier curve, by the length of its arc.
class Cubic {
 public:
  explicit Cubic(std::array<P, 4> p) : p_(p) {
    ends_.push_back(0.0);
    for (int i = 0; i < kParts; ++i) ends_.push_back(ends_.back() + length(double(i) / kParts, double(i + 1) / kParts));
  }
  double length() const { return ends_.back(); }
  Placed at(double way) const {
    int part = 0;
    while (part + 1 < kParts && ends_[part + 1] < way) ++part;
    double low = double(part) / kParts, high = double(part + 1) / kParts;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (ends_[part] + length(double(part) / kParts, middle) < way ? low : high) = middle;
    }
    const double t = 0.5 * (low + high), u = 1.0 - t;
    const P where = p_[0] * (u * u * u) + p_[1] * (3 * u * u * t) + p_[2] * (3 * u * t * t) + p_[3] * (t * t * t);
    const P slope = derivative(t);
    return {where, slope * (1.0 / size(slope))};
  }

 private:
  static constexpr int kParts = 32;
  P derivative(double t) const {
    const double u = 1.0 - t;
    return (p_[1] - p_[0]) * (3 * u * u) + (p_[2] - p_[1]) * (6 * u * t) + (p_[3] - p_[2]) * (3 * t * t);
  }
  // Gauss and Legendre, five points.
  double length(double from, double to) const {
    constexpr std::array<double, 5> kX = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                          -0.9061798459386640};
    constexpr std::array<double, 5> kW = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                          0.2369268850561891, 0.2369268850561891};
    double sum = 0.0;
    for (std::size_t i = 0; i < kX.size(); ++i)
      sum += kW[i] * size(derivative(0.5 * (from + to) + 0.5 * (to - from) * kX[i]));
    return 0.5 * (to - from) * sum;
  }
  std::array<P, 4> p_;
  std::vector<double> ends_;
};

struct Motion {
  std::int64_t begin_ns = 0, end_ns = 0;
  std::string manner;
  Placed start;
  double length_m = 0.0, width_m = 0.0, ahead_m = 0.0, way_begin_m = 0.0;
  bool to_the_left = false, tail_first = false;
  std::vector<P> line;
  std::vector<Cubic> cubics;
  Json phases;

  explicit Motion(const Json& j)
      : begin_ns(j["begin_ns"]),
        end_ns(j["end_ns"]),
        manner(j["manner"]),
        start{point(j["position_m"]), point(j["heading"])},
        length_m(j["length_m"]),
        width_m(j["width_m"]),
        ahead_m(j["centre_ahead_m"]),
        way_begin_m(j.value("way_begin_m", 0.0)),
        to_the_left(j.value("to_the_left", false)),
        tail_first(j.value("tail_first", false)),
        phases(j.value("motion", Json::array())) {
    if (manner != "drive") return;
    for (const Json& p : j["track_m"]) line.push_back(point(p));
    for (std::size_t i = 0; line.size() > 2 && i + 3 < line.size(); i += 3)
      cubics.emplace_back(std::array<P, 4>{line[i], line[i + 1], line[i + 2], line[i + 3]});
  }
  double way(double t_s) const {
    double way = 0.0;
    for (const Json& phase : phases) {
      const double begin_s = phase["begin_s"], d = std::min(t_s, phase["end_s"].get<double>()) - begin_s;
      if (t_s < begin_s) break;
      way = phase["way"].get<double>() +
            d * (phase["speed"].get<double>() + 0.5 * d * phase["acceleration"].get<double>());
    }
    return way;
  }
  Placed pose(double ns) const {
    if (manner == "rest") return start;
    const double done = way((ns - double(begin_ns)) * 1e-9);
    if (manner == "turn") {
      const double a = to_the_left ? done : -done, c = std::cos(a), s = std::sin(a);
      return {start.at, {c * start.heading.x - s * start.heading.y, s * start.heading.x + c * start.heading.y}};
    }
    Placed on = on_track(way_begin_m + done);
    if (tail_first) on.heading = on.heading * -1.0;
    return on;
  }
  Placed on_track(double way) const {
    if (cubics.empty()) {
      const P d = (line[1] - line[0]) * (1.0 / size(line[1] - line[0]));
      return {line[0] + d * way, d};
    }
    for (std::size_t i = 0; i < cubics.size(); ++i) {
      if (way <= cubics[i].length() || i + 1 == cubics.size()) return cubics[i].at(way);
      way -= cubics[i].length();
    }
    return {};
  }
};

using Timeline = std::vector<Motion>;

const Motion& at(const Timeline& body, double ns) {
  for (const Motion& motion : body) {
    if (ns <= double(motion.end_ns)) return motion;
  }
  return body.back();
}

std::array<P, 4> corners(const Motion& m, double ns) {
  const Placed p = m.pose(ns);
  const P centre = p.at + p.heading * m.ahead_m, along = p.heading * (0.5 * m.length_m),
          across = P{-p.heading.y, p.heading.x} * (0.5 * m.width_m);
  return {centre + along + across, centre - along + across, centre - along - across, centre + along - across};
}

double to_side(P p, P a, P b) {
  const double k = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
  return size(p - (a + (b - a) * k));
}

bool inside(P p, const std::array<P, 4>& r) {
  for (int i = 0; i < 4; ++i) {
    const P side = r[(i + 1) % 4] - r[i], to = p - r[i];
    if (side.x * to.y - side.y * to.x < 0.0) return false;
  }
  return true;
}

double distance(const std::array<P, 4>& a, const std::array<P, 4>& b) {
  double least = 1e9;
  for (int i = 0; i < 4; ++i) {
    if (inside(a[i], b) || inside(b[i], a)) return 0.0;
    for (int k = 0; k < 4; ++k)
      least = std::min({least, to_side(a[i], b[k], b[(k + 1) % 4]), to_side(b[i], a[k], a[(k + 1) % 4])});
  }
  return least;
}

// Looks every 20 ms, and between the neighbours of each low point by thirds.
double smallest_clearance(const std::vector<Timeline>& bodies, double end_ns) {
  double least = 1e9;
  const double step_ns = 2e7;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      const auto gap = [&](double ns) {
        return distance(corners(at(bodies[a], ns), ns), corners(at(bodies[b], ns), ns));
      };
      std::vector<double> gaps;
      for (double ns = 0.0; ns <= end_ns; ns += step_ns) gaps.push_back(gap(ns));
      for (std::size_t i = 0; i < gaps.size(); ++i) {
        const bool low = (i == 0 || gaps[i] <= gaps[i - 1]) && (i + 1 == gaps.size() || gaps[i] <= gaps[i + 1]);
        if (!low || gaps[i] > std::min(least, 0.6) + 0.2) continue;
        double from = std::max(0.0, (double(i) - 1.0) * step_ns), to = std::min(end_ns, (double(i) + 1.0) * step_ns);
        for (int n = 0; n < 60; ++n) {
          const double p = from + (to - from) / 3.0, q = to - (to - from) / 3.0;
          (gap(p) <= gap(q) ? to : from) = gap(p) <= gap(q) ? q : p;
        }
        least = std::min({least, gaps[i], gap(0.5 * (from + to))});
      }
    }
  }
  return least;
}

// How far the file's own account lies from the product's.
struct Difference {
  int poses = 0, curved = 0, backward = 0, near = 0;  // near: runs whose bodies came within 0.5 m
  double pose_m = 0.0, gap_m = 0.0;
};

class Pieces : public test::ProgramTest {
 protected:
  std::vector<Timeline> timelines(const std::string& file) const {
    std::vector<Timeline> bodies;
    const Json json = Json::parse(read(path(file)));
    for (const Json& body : json["bodies"]) {
      names_.push_back(body["body"]);
      Timeline& timeline = bodies.emplace_back();
      for (const Json& piece : body["pieces"]) timeline.emplace_back(piece);
      for (std::size_t i = 1; i < timeline.size(); ++i) EXPECT_EQ(timeline[i].begin_ns, timeline[i - 1].end_ns);
    }
    return bodies;
  }
  void judge_again(const std::string& campaign, int index, double horizon_ns, Difference& off) {
    names_.clear();
    const auto replayed = run("replay " + campaign + ".db " + std::to_string(index) +
                              " --pieces p.json --poses p.csv --every-ms 70 --scenario s.json");
    ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
    const auto bodies = timelines("p.json");
    std::istringstream csv(read(path("p.csv")));
    std::string line;
    std::getline(csv, line);
    while (std::getline(csv, line)) judge_pose(line, bodies, off);
    const Json judged = Json::parse(run("simulate s.json --json").out);
    if (judged["min_clearance_um"].is_null()) return;
    ++off.near;
    const double clearance_m = judged["min_clearance_um"].get<double>() * 1e-6;
    off.gap_m = std::max(off.gap_m, std::abs(smallest_clearance(bodies, horizon_ns) - clearance_m));
  }
  void judge_pose(const std::string& line, const std::vector<Timeline>& bodies, Difference& off) const {
    std::istringstream fields(line);
    std::string name, field;
    std::getline(fields, name, ',');
    std::array<double, 6> v{};
    for (double& value : v) std::getline(fields, field, ','), value = std::stod(field);
    const auto body = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
    const Motion& motion = at(bodies.at(body), v[0] * 1e9);
    const Placed pose = motion.pose(v[0] * 1e9);
    off.pose_m = std::max({off.pose_m, size(pose.at - P{v[1], v[2]}), size(pose.heading - P{v[3], v[4]})});
    off.curved += motion.cubics.empty() ? 0 : 1;
    off.backward += motion.tail_first ? 1 : 0;
    ++off.poses;
  }
  mutable std::vector<std::string> names_;
};

TEST_F(Pieces, GiveThePosesAndTheSmallestClearanceOfARun) {
  const std::string vehicle =
      "[world]\ntransports_per_agv_hour = 240\n[[vehicle]]\nname = \"fork\"\ncentre_ahead_m = 0.3\n"
      "loaded_extra_length_m = 0.4\n";
  write("a.toml",
        "replicates = 2\nhorizon_s = 60\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"corridor-sidings\", "
        "\"plant/overhang-pass\", \"random-planar\"]\nfleet_sizes = [5]\n" +
            vehicle);
  write("b.toml",
        "replicates = 2\nhorizon_s = 300\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"plant/back-in\"]\n"
        "fleet_sizes = [5]\n" +
            vehicle);
  Difference off;
  for (const auto& [campaign, runs, horizon_ns] : {std::tuple("a", 6, 60e9), {"b", 2, 300e9}}) {
    ASSERT_TRUE(test::has_verdict(run(std::string("run ") + campaign + ".toml")));
    for (int i = 0; i < runs; ++i) judge_again(campaign, i, horizon_ns, off);
  }
  std::cout << off.poses << " poses, " << off.curved << " in bends, " << off.backward << " backward: off by "
            << off.pose_m << " m; " << off.near << " runs below 0.5 m: off by " << off.gap_m << " m\n";
  EXPECT_LT(off.pose_m, 1e-9);
  EXPECT_LT(off.gap_m, 2e-6) << "the archive has whole micrometres";
  EXPECT_GE(off.near, 4);
  EXPECT_GT(off.curved, 50);
  EXPECT_GT(off.backward, 20);
}

// ---- no piece is empty

class EmptyPieces : public test::ProgramTest {
 protected:
  // A move that a fault meets at the instant at which it begins.
  void write_figure4(const std::string& name, const Json& faults) const {
    Json scenario = Json::parse(read(test::source("tests/scenarios/figure4.json")));
    scenario["faults"] = faults;
    write(name, scenario.dump());
  }
  void expect_no_empty_piece(const std::string& scenario, const std::string& agent) const {
    SCOPED_TRACE(scenario);
    const auto simulated = run("simulate '" + scenario + "' --agent " + agent + " --pieces p.json --html p.html");
    ASSERT_TRUE(test::has_verdict(simulated)) << simulated.err;
    const Json told = Json::parse(read(path("p.json")));
    for (const Json& body : told["bodies"]) {
      std::int64_t until_ns = body["pieces"][0]["begin_ns"];
      for (const Json& piece : body["pieces"]) {
        EXPECT_GE(piece["begin_ns"], until_ns) << "later only if the operator has taken it from the floor";
        EXPECT_GT(piece["end_ns"], piece["begin_ns"]) << piece["manner"];
        until_ns = piece["end_ns"];
        const Motion motion(piece);
        if (motion.manner == "rest") continue;
        EXPECT_FALSE(motion.phases.empty()) << motion.manner << " at " << motion.begin_ns;
        EXPECT_GT(motion.way(double(motion.end_ns - motion.begin_ns) * 1e-9), 0.0) << motion.manner;
      }
    }
    const std::string page = read(path("p.html")), begin = "<script type=\"application/json\" id=\"film\">";
    const auto from = page.find(begin) + begin.size();
    const Json film = Json::parse(page.substr(from, page.find("</script>", from) - from));
    EXPECT_FALSE(film["pieces_us_um_urad"].empty());
    for (const Json& piece : film["pieces_us_um_urad"]) EXPECT_LT(piece[2], piece[3]) << piece;
  }
};

TEST_F(EmptyPieces, AreNotWritten) {
  write_figure4("breakdown.json", {{{"kind", "breakdown"}, {"agv", "A"}, {"at_s", 2}, {"lasts_s", 3}}});
  write_figure4("stop.json", {{{"kind", "protective-stop"}, {"agv", "E"}, {"at_s", 2}, {"lasts_s", 1e-9}}});
  for (const std::string scenario : {"breakdown.json", "stop.json"}) expect_no_empty_piece(scenario, "scripted");
  for (const std::string agent : {"hull-lock", "reckless"}) {
    for (const std::string scenario : {"frozen_while_dropping", "restarted_while_dropping"})
      expect_no_empty_piece(test::source("tests/scenarios/" + scenario + ".json"), agent);
  }
}

}  // namespace
}  // namespace fleetproof::pieces_test
