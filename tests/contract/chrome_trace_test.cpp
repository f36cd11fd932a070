// A run as Perfetto shows it: bars that do not overlap within a row, and an arrow for every message received.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof {
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
    ASSERT_LE(run("run a.toml").exit_code, 1);
    const auto replayed = run("replay a.db 0 --chrome-trace c.json --trace-output t.jsonl --trace-format json");
    ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
    events_ = Json::parse(read(path("c.json")))["traceEvents"];
    std::istringstream lines(read(path("t.jsonl")));
    for (std::string line; std::getline(lines, line);) trace_.push_back(Json::parse(line));
  }
  std::size_t count(const char* event) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(trace_, [&](const Json& line) { return line["event"] == event; }));
  }

  Json events_;
  std::vector<Json> trace_;
};

TEST_F(ChromeTrace, HasAnArrowForEveryMessageReceived) {
  std::map<std::uint64_t, Json> starts, ends;
  for (const Json& event : events_) {
    if (event["ph"] == "s") starts[event["id"]] = event;
    if (event["ph"] == "f") ends[event["id"]] = event;
  }
  ASSERT_GT(starts.size(), 20U);
  EXPECT_EQ(starts.size(), count("received"));
  ASSERT_EQ(starts.size(), ends.size());
  for (const auto& [id, start] : starts) {
    EXPECT_LT(start["ts"], ends.at(id)["ts"]);
    EXPECT_NE(start["pid"], ends.at(id)["pid"]);
    EXPECT_EQ(start["name"], ends.at(id)["name"]);
  }
}

TEST_F(ChromeTrace, HasABarForEveryActivityAndRowsWithNames) {
  std::size_t activities = 0;
  std::map<std::uint64_t, double> until;  // by body
  std::set<std::string> names;
  for (const Json& event : events_) {
    if (event["ph"] == "M" && event["name"] == "process_name") names.insert(event["args"]["name"]);
    if (event["ph"] != "X" || event["tid"] != 1) continue;
    ++activities;
    EXPECT_GE(event["ts"].get<double>(), until[event["pid"]] - 1e-3) << "activities follow each other";
    until[event["pid"]] = event["ts"].get<double>() + event["dur"].get<double>();
  }
  EXPECT_EQ(activities, count("begins"));
  EXPECT_EQ(names, (std::set<std::string>{"AGV 0", "AGV 1", "AGV 2", "AGV 3"}));
}

TEST_F(ChromeTrace, ShowsWhereTheDistanceIsBroken) {
  const auto shown = std::ranges::count_if(events_, [](const Json& e) { return e["ph"] == "X" && e["tid"] == 5; });
  EXPECT_EQ(2 * static_cast<std::size_t>(shown), count("distance"));
  EXPECT_GE(shown, 1);
}

}  // namespace
}  // namespace fleetproof
