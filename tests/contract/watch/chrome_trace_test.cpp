// A run as Perfetto shows it: bars that do not overlap within a row, and an arrow for every message received.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::chrome_trace_test {
namespace {

using Json = nlohmann::json;

class ChromeTrace : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write(
        "a.toml",
        "replicates = 2\nhorizon_s = 100\n[factors]\nagents = [\"grants-for-good\"]\nlayouts = [\"corridor-sidings\"]\n"
        "fleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n[world]\ntransports_per_agv_hour = 240\n[faults]\n"
        "protective_stops_per_agv_hour = 60\n");
    ASSERT_TRUE(test::has_verdict(run("run a.toml")));
    const auto replayed = run("replay a.db 0 --chrome-trace c.json --trace-output t.jsonl --trace-format json");
    ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
    events_ = Json::parse(read(path("c.json")))["traceEvents"];
    for (const Json& event : events_) {
      if (event["name"] == "thread_name") rows_[event["tid"]] = event["args"]["name"];
    }
    std::istringstream lines(read(path("t.jsonl")));
    for (std::string line; std::getline(lines, line);) trace_.push_back(Json::parse(line));
  }
  std::size_t count(const char* event) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(trace_, [&](const Json& line) { return line["event"] == event; }));
  }

  std::string row_of(const Json& event) const { return rows_.at(event["tid"]); }

  Json events_;
  std::map<std::uint64_t, std::string> rows_;
  std::vector<Json> trace_;
};

TEST_F(ChromeTrace, HasAnArrowForEveryMessageReceived) {
  std::map<std::uint64_t, Json> sent;
  std::size_t received = 0;
  for (const Json& event : events_) {
    if (event.contains("flow_out")) {
      EXPECT_TRUE(sent.emplace(event["bind_id"], event).second);
    }
    if (!event.contains("flow_in")) continue;
    ++received;
    const auto& start = sent.at(event["bind_id"]);
    EXPECT_LT(start["ts"], event["ts"]);
    EXPECT_NE(start["pid"], event["pid"]);
    EXPECT_EQ(start["name"], event["name"]);
  }
  EXPECT_EQ(sent.size(), count("sent"));
  ASSERT_GT(received, 20U);
  EXPECT_EQ(received, count("received"));
}

TEST_F(ChromeTrace, HasABarForEveryActivityAndRowsWithNames) {
  std::size_t activities = 0;
  std::map<std::uint64_t, double> until;  // by body
  for (const Json& event : events_) {
    if (event["ph"] != "X" || row_of(event) != "does") continue;
    ++activities;
    EXPECT_GE(event["ts"].get<double>(), until[event["pid"]] - 1e-3) << "activities follow each other";
    until[event["pid"]] = event["ts"].get<double>() + event["dur"].get<double>();
  }
  EXPECT_EQ(activities, count("begins"));
  std::set<std::string> names;
  for (const Json& event : events_) {
    if (event["name"] == "process_name") names.insert(event["args"]["name"]);
  }
  EXPECT_EQ(names, (std::set<std::string>{"AGV 0", "AGV 1", "AGV 2", "AGV 3"}));
}

TEST_F(ChromeTrace, ShowsWhereTheDistanceIsBroken) {
  const auto shown = std::ranges::count_if(
      events_, [&](const Json& e) { return e["ph"] == "X" && row_of(e) == "below the safety distance"; });
  EXPECT_EQ(2 * static_cast<std::size_t>(shown), count("distance"));
  EXPECT_GE(shown, 1);
}

// By the rules of Perfetto's reader: nothing is left out, moved or bound to another slice. Three AGVs in a heap: the
// episodes below the safety distance lie across each other.
TEST_F(ChromeTrace, PerfettoCountsNoError) {
  const auto read_as_perfetto = [&](const std::string& file) {
    return shell("python3 -B '" + test::source("tests/judge/chrome_trace.py") + "' " + file);
  };
  const auto verdict = read_as_perfetto("c.json");
  EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
  EXPECT_THAT(verdict.out, testing::HasSubstr(" " + std::to_string(count("received")) + " flows, 4 processes"));
  write("crowd.toml",
        "horizon_s = 100\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"corridor-sidings\"]\n"
        "fleet_sizes = [8]\n[world]\ntransports_per_agv_hour = 240\n");
  ASSERT_TRUE(test::has_verdict(run("run crowd.toml")));
  ASSERT_EQ(run("replay crowd.db 0 --chrome-trace crowd.json").exit_code, 0);
  const auto crowd = read_as_perfetto("crowd.json");
  EXPECT_EQ(crowd.exit_code, 0) << crowd.out << crowd.err;

  const std::string trace = read(path("c.json"));
  for (const auto& [from, to] : {std::pair("\"flow_out\":true", "\"flow_in\":true"),
                                 {"\"ph\":\"i\"", "\"ph\":\"q\""},
                                 {"\"dur\":0,", "\"dur\":-1,"},
                                 {"\"tid\":1000003,", "\"tid\":1,"}}) {
    std::string changed = trace;
    write("changed.json", changed.replace(changed.find(from), std::string(from).size(), to));
    const auto noticed = read_as_perfetto("changed.json");
    EXPECT_EQ(noticed.exit_code, 1) << from;
    EXPECT_THAT(noticed.out, testing::HasSubstr("ERROR: ")) << noticed.err;
  }
  const std::string bar = R"({"ph": "X", "pid": 1, "tid": 1001, "name": "b", "args": {"details": ""}, )";
  write("crossing.json", R"({"traceEvents": [)" + bar + R"("ts": 0, "dur": 5}, )" + bar + R"("ts": 4, "dur": 2}]})");
  EXPECT_THAT(read_as_perfetto("crossing.json").out, testing::HasSubstr("ERROR: overlaps another slice"));
}

// Perfetto drops what lies deeper than 512 slices; things without length at one instant lie on each other.
TEST_F(ChromeTrace, ManyMessagesAtOneInstantAreAllThere) {
  constexpr int kAtOnce = 700;
  write("two.json", R"({"version": 1, "name": "two", "horizon_s": 5,
    "vehicle_types": [{"name": "cart", "length_m": 1.6, "width_m": 1}],
    "agvs": [{"name": "A", "start": "a", "heading": [1, 0]}, {"name": "B", "start": "b", "heading": [1, 0]}],
    "layout": {"name": "two", "floor_low_m": [-3, -3], "floor_high_m": [20, 30],
      "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [8, 0]}],
      "segments": [{"name": "ab", "from": "a", "to": "b"}, {"name": "ba", "from": "b", "to": "a"}]}})");
  std::string calls;
  for (int i = 0; i < kAtOnce; ++i) calls += "0 1000 all HELLO;";
  calls.pop_back();
  const auto ran = run("simulate two.json --agent talker --plugin '" + std::string(FLEETPROOF_TALKING_AGENT) +
                       "' --agent-config '" + calls + "' --chrome-trace two.trace");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto verdict = shell("python3 -B '" + test::source("tests/judge/chrome_trace.py") + "' two.trace");
  EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
  EXPECT_THAT(verdict.out, testing::HasSubstr(" " + std::to_string(kAtOnce) + " flows, 2 processes"));
  std::map<std::string, int> rows;
  std::map<std::uint64_t, std::string> names;
  const Json events = Json::parse(read(path("two.trace")))["traceEvents"];
  for (const Json& event : events) {
    if (event["name"] == "thread_name") names[event["tid"]] = event["args"]["name"];
  }
  for (const Json& event : events) {
    if (event.contains("flow_out")) ++rows[names.at(event["tid"])];
  }
  EXPECT_EQ(rows, (std::map<std::string, int>{{"radio", 200}, {"radio, more at one instant", 500}}));
}

}  // namespace
}  // namespace fleetproof::chrome_trace_test
