// A script that picks and drops where the AGV stands, without driving first.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::scripted_here_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ScriptedHere : public test::ProgramTest {
 protected:
  // An AGV at station a with a load there for station b, 8 m away. `heading`: what station a wants, if anything.
  static std::string scenario(const std::string& script, const std::string& heading = "") {
    return R"({"version": 1, "name": "here", "horizon_s": 40,
      "vehicle_types": [{"name": "fork", "pick_s": 3, "drop_s": 2, "loaded": {"extra_length_m": 0.4}}],
      "agvs": [{"name": "F", "start": "a", "heading": [1, 0],
                "transports": [{"from": "a", "to": "b", "release_s": 0}], "script": [)" +
           script + R"(]}],
      "layout": {"name": "two", "floor_low_m": [-3, -3], "floor_high_m": [12, 3],
        "stations": [{"name": "a", "position_m": [0, 0])" +
           heading + R"(}, {"name": "b", "position_m": [8, 0]}],
        "segments": [{"name": "ab", "from": "a", "to": "b"}]}})";
  }
  // Instants and activities, as the trace has them.
  std::vector<std::string> activities() const {
    std::vector<std::string> found;
    std::istringstream lines(read(path("trace.jsonl")));
    for (std::string line; std::getline(lines, line);) {
      const auto record = nlohmann::json::parse(line);
      const std::string event = record["event"];
      if (event == "begins" || event == "ends" || event == "load moves")
        found.push_back(std::to_string(record["t_ns"].get<std::int64_t>() / 1'000'000'000) + " " + event + " " +
                        record["details"].get<std::string>());
    }
    return found;
  }
  std::string refused(const std::string& script, const std::string& heading = "") const {
    write("s.json", scenario(script, heading));
    const auto finished = run("simulate s.json");
    EXPECT_EQ(finished.exit_code, 2) << script;
    EXPECT_EQ(finished.out, "");
    return finished.err;
  }
};

const std::string kPickMoveDrop =
    R"({"at_s": 1, "action": "pick"}, {"at_s": 10, "action": "move", "segment": "ab"}, {"at_s": 20, "action": "drop"})";

TEST_F(ScriptedHere, PicksAndDropsAtTheStationWhereItStands) {
  write("s.json", scenario(kPickMoveDrop));
  const auto finished = run("simulate s.json --json --trace-output trace.jsonl --trace-format json --at 6 --svg p.svg");
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(activities(), ElementsAre("0 load moves 0 at a", "1 begins pick", "4 load moves 0 on F", "4 ends pick",
                                        "10 begins drive ab", "17 ends drive", "20 begins drop", "22 load moves 0 at b",
                                        "22 ends drop"));
  const auto counters = nlohmann::json::parse(finished.out)["counters"];
  EXPECT_EQ(counters["transports_done"], 1);
  EXPECT_EQ(counters["drives"], 1);
  EXPECT_EQ(counters["refused_calls"], 0);
  EXPECT_THAT(read(path("p.svg")), HasSubstr("<title>F, loaded</title>")) << "between pick and drop";
}

// A pick before the move, a move that is still under way: the run says what was refused.
TEST_F(ScriptedHere, ACallThatComesTooEarlyIsCounted) {
  write("s.json", scenario(R"({"at_s": 1, "action": "move", "segment": "ab"}, {"at_s": 2, "action": "drop"})"));
  const auto finished = run("simulate s.json");
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.err,
              HasSubstr("note: the controller refused 1 call of the script; see --trace --trace-kind refused\n"));
  EXPECT_THAT(run("simulate s.json --trace --trace-kind refused").err, HasSubstr("refused        drop"));
}

TEST_F(ScriptedHere, StepsThatAreImpossibleAreRefusedByName) {
  EXPECT_THAT(refused(R"({"at_s": 1, "action": "move"})"),
              HasSubstr("s.json:4: /agvs/0/script/0/action: \"move\" is refused: a move needs a segment; name it"));
  EXPECT_THAT(refused(R"({"at_s": 1, "action": "pick", "backward": true})"),
              HasSubstr("/agvs/0/script/0/backward: true is refused: without a segment the AGV does not drive; leave "
                        "backward out, or name the segment"));
  EXPECT_THAT(
      refused(R"({"at_s": 1, "action": "drop"})", R"(, "heading": [0, 1])"),
      HasSubstr("/agvs/0/script/0/action: \"drop\" is refused: \"F\" cannot drop at \"a\" with its first heading "
                "[1, 0]; the station wants [0, 1]: start with that heading, or name a segment to drive first"));
  EXPECT_THAT(refused(R"({"at_s": 1, "action": "pick", "segment": ""})"), HasSubstr("there is no such segment"));
}

}  // namespace
}  // namespace fleetproof::scripted_here_test
