// The pieces and poses of runs, judged again by a program of another language (../judge).
#include <gmock/gmock.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/support/program.hpp"

namespace fleetproof::judged_pieces_test {
namespace {

using testing::HasSubstr;

class JudgedPieces : public test::ProgramTest {
 protected:
  test::Finished judge(const std::string& more = "") const {
    return shell("python3 -B '" + test::source("tests/judge/judge.py") + "' p.json p.csv o.json " + more);
  }
  // The number that the judge prints before a word.
  static int count(const std::string& text, const std::string& word) {
    std::smatch match;
    return std::regex_search(text, match, std::regex("([0-9]+) " + word)) ? std::stoi(match[1]) : -1;
  }
  // Simulates a scenario file and has it judged again. Returns what the judge says.
  std::string judged(const std::string& file, int every_ms) const {
    const auto finished = run("simulate '" + file + "' --json --pieces p.json --poses p.csv --every-ms " +
                              std::to_string(every_ms) + " >o.json");
    EXPECT_TRUE(test::has_verdict(finished));
    const auto verdict = judge("'" + file + "'");
    EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
    std::cout << verdict.out;
    return verdict.out;
  }
  int clearance_um() const { return nlohmann::json::parse(read(path("o.json")))["min_clearance_um"]; }

  // One AGV that goes from a to b on a segment, with a load if its script picks one, and a rack beside its way.
  void write_scene(const std::string& script, const std::string& segment, const std::string& b, const std::string& rack,
                   const std::string& heading) const {
    write("s.json", R"({"version": 1, "name": "scene", "horizon_s": 30,
      "vehicle_types": [{"name": "fork", "centre_ahead_m": 0.3, "pick_s": 2, "drop_s": 2, "reverse_speed_mps": 0.7,
                         "loaded": {"extra_length_m": 0.5, "extra_width_m": 0.2}}],
      "agvs": [{"name": "F", "start": "a", "heading": )" +
                        heading + R"(, "transports": [{"from": "a", "to": "b", "release_s": 0}], "script": [)" +
                        script + R"(]}],
      "obstacles": [{"name": "rack", "length_m": 0.8, "width_m": 0.6, "heading": [0.8, 0.6], "position_m": )" +
                        rack +
                        R"(}],
      "layout": {"name": "scene", "floor_low_m": [-9, -9], "floor_high_m": [12, 12],
        "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": )" +
                        b + R"(}],
        "segments": [{"name": "ab", "from": "a", "to": "b")" +
                        segment + "}]}}");
  }
};

const std::string kMove = R"({"at_s": 1, "action": "move", "segment": "ab"})";
const std::string kBend = R"(, "control_points_m": [[2.5, 0], [4, 1.5]])";

TEST_F(JudgedPieces, FigureFourAndTheHoleInThePublishedRule) {
  EXPECT_THAT(judged(test::source("tests/scenarios/figure4.json"), 10), HasSubstr("; 5 durations; 1 violations"));
  EXPECT_EQ(clearance_um(), 14842);
  EXPECT_THAT(judged(test::source("tests/scenarios/parked_then_leaves.json"), 10), HasSubstr("; 2 durations; "));
}

// A corner that swings past a rack.
TEST_F(JudgedPieces, ATurn) {
  write_scene(kMove, "", "[6, 0]", "[1.3, 1.15]", "[0, 1]");
  EXPECT_GT(count(judged(path("s.json"), 3), "turn"), 500);
  EXPECT_GT(clearance_um(), 50'000);
  EXPECT_LT(clearance_um(), 150'000) << "driving past it, 170 mm";
}

TEST_F(JudgedPieces, ABend) {
  write_scene(kMove, kBend, "[4, 4]", "[2.2, 1.9]", "[1, 0]");
  EXPECT_THAT(judged(path("s.json"), 3), HasSubstr(" in a bend"));
}

TEST_F(JudgedPieces, ABendDrivenBackward) {
  write_scene(kMove, kBend + R"(, "travel": "backward")", "[4, 4]", "[2.2, 1.9]", "[-1, 0]");
  const std::string said = judged(path("s.json"), 3);
  EXPECT_THAT(said, HasSubstr(" in a bend"));
  EXPECT_GT(count(said, "backward"), 500);
}

// The load reaches nearer to the rack than the AGV does. Picked and dropped at rest: the hull changes where it stands.
TEST_F(JudgedPieces, ALoadThatChangesTheHull) {
  const std::string with_load = R"({"at_s": 1, "action": "pick"}, {"at_s": 5, "action": "move", "segment": "ab"},
                                   {"at_s": 20, "action": "drop"})";
  write_scene(R"({"at_s": 5, "action": "move", "segment": "ab"})", "", "[6, 0]", "[7.9, 0.1]", "[1, 0]");
  judged(path("s.json"), 7);
  const int empty_um = clearance_um();
  write_scene(with_load, "", "[6, 0]", "[7.9, 0.1]", "[1, 0]");
  EXPECT_GT(count(judged(path("s.json"), 7), "loaded"), 1000);
  EXPECT_LT(clearance_um(), empty_um - 200'000);
}

// Drawn worlds with bends, loads and drives backward.
TEST_F(JudgedPieces, RunsOfCampaigns) {
  write("a.toml",
        "replicates = 1\nhorizon_s = 60\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"corridor-sidings\", "
        "\"plant/back-in\", \"random-planar\"]\nfleet_sizes = [5]\n[world]\ntransports_per_agv_hour = 240\n"
        "[[vehicle]]\nname = \"fork\"\ncentre_ahead_m = 0.3\nloaded_extra_length_m = 0.4\n");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db")));
  int bends = 0, loaded = 0;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(run("replay a.db " + std::to_string(i) + " --scenario s.json").exit_code, 0);
    run("simulate s.json --json --pieces p.json --poses p.csv --every-ms 70 >o.json");
    const auto verdict = judge();
    EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
    bends += count(verdict.out, "bend");
    loaded += count(verdict.out, "loaded");
    std::filesystem::remove(path("s.json"));
  }
  EXPECT_GT(bends, 100);
  EXPECT_GT(loaded, 100);
}

// The judge sees what is off by a little more than it forgives.
TEST_F(JudgedPieces, TheJudgeNoticesWhatIsOff) {
  const std::string file = test::source("tests/scenarios/figure4.json");
  ASSERT_EQ(run("simulate '" + file + "' --json --pieces p.json --poses p.csv >o.json").exit_code, 1);
  ASSERT_EQ(judge().exit_code, 0);
  const std::string pieces = read(path("p.json")), poses = read(path("p.csv")), outcome = read(path("o.json"));
  const auto noticed = [&](const std::string& name, const std::string& text, const std::string& from,
                           const std::string& to) {
    const std::string changed = std::regex_replace(text, std::regex(from), to);
    ASSERT_NE(changed, text) << from;
    write(name, changed);
    const auto verdict = judge();
    EXPECT_EQ(verdict.exit_code, 1) << from;
    EXPECT_THAT(verdict.out, HasSubstr("DIFFERENCE: ")) << verdict.err;
    write(name, text);
  };
  noticed("p.csv", poses, "\nA,5,2.25,0,", "\nA,5,2.250000002,0,");
  noticed("o.json", outcome, "\"min_clearance_um\": 14842,\n  \"counters\"",
          "\"min_clearance_um\": 14844,\n  \"counters\"");
  noticed("p.json", pieces, "\"width_m\": 1.0", "\"width_m\": 1.00001");
}

}  // namespace
}  // namespace fleetproof::judged_pieces_test
