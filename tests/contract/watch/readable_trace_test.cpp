// A trace says of each message which it is, how old it is and where its AGVs are, and shows where the distance breaks.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::readable_trace_test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

class ReadableTrace : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml",
          "replicates = 4\nhorizon_s = 120\n[factors]\nagents = [\"stale-grant\", \"reckless\"]\n"
          "layouts = [\"corridor-sidings\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n[world]\n"
          "transports_per_agv_hour = 240\n[radio]\nduplicates = 0.1\n");
    ASSERT_TRUE(test::has_verdict(run("run a.toml")));
  }
  std::vector<Json> lines_of(const std::string& file) const {
    std::vector<Json> lines;
    std::istringstream text(read(path(file)));
    for (std::string line; std::getline(text, line);) lines.push_back(Json::parse(line));
    return lines;
  }
  Json simulated(const std::string& words) const { return Json::parse(run(words + " --json").out); }
};

// Everything a line says of a message follows from the line in which it was sent.
TEST_F(ReadableTrace, EveryMessageIsTheOneThatWasSent) {
  ASSERT_EQ(run("replay a.db 0 --trace-output t.jsonl --trace-format json").exit_code, 0);
  std::map<std::uint64_t, Json> sent;
  std::uint64_t received = 0, lost = 0;
  std::int64_t last_ns = 0;
  for (const Json& line : lines_of("t.jsonl")) {
    EXPECT_GE(line["t_ns"].get<std::int64_t>(), last_ns);
    last_ns = line["t_ns"];
    if (!line.contains("message")) continue;
    const Json& message = line["message"];
    const std::uint64_t number = message["number"];
    if (line["event"] == "sent") {
      EXPECT_EQ(number, sent.size() + 1) << "numbered in the order of sending";
      EXPECT_EQ(message["sender"], line["body"]);
      EXPECT_EQ(message["sent_ns"], line["t_ns"]);
      if (message["kind"] == "GRANT") {
        EXPECT_THAT(message["content"], StartsWith("answers "));
      }
      sent[number] = message;
      continue;
    }
    ASSERT_TRUE(sent.contains(number));
    for (const char* key : {"kind", "content", "bytes", "sender", "sent_ns"})
      EXPECT_EQ(message[key], sent[number][key]);
    EXPECT_EQ(message["age_ns"].get<std::int64_t>(),
              line["t_ns"].get<std::int64_t>() - message["sent_ns"].get<std::int64_t>());
    EXPECT_NE(line["body"], message["sender"]);
    (line["event"] == "received" ? received : lost) += 1;
  }
  EXPECT_GT(received, 20U);
  EXPECT_GT(lost, 20U);
}

// The archive says where each violation begins and where it is closest.
TEST_F(ReadableTrace, LinesStandWhereTheDistanceBreaksAndWhereItIsClosest) {
  ASSERT_EQ(run("replay a.db 1 --scenario s.json --trace-output t.jsonl --trace-format json").exit_code, 0);
  const Json judged = simulated("simulate s.json");
  ASSERT_GE(judged["violations"].size(), 1U);
  std::vector<std::int64_t> told_ns, expected_ns;
  for (const Json& line : lines_of("t.jsonl")) {
    if (line["event"] == "distance") told_ns.push_back(line["t_ns"]);
  }
  for (const Json& violation : judged["violations"]) {
    expected_ns.push_back(violation["first_ns"]);
    expected_ns.push_back(violation["at_ns"]);
  }
  std::ranges::sort(expected_ns);
  EXPECT_EQ(told_ns, expected_ns);
  const std::string text = run("simulate s.json --trace --trace-kind distance").err;
  EXPECT_THAT(text, HasSubstr("falls below 0.10 m"));
  EXPECT_THAT(text, testing::ContainsRegex("^ +[0-9]+\\.[0-9]{9}  AGV"));
}

TEST_F(ReadableTrace, IsTheSameOfAReplayAndOfItsScenario) {
  ASSERT_EQ(run("replay a.db 0 --scenario s.json --trace-output a.txt").exit_code, 0);
  ASSERT_TRUE(test::has_verdict(run("simulate s.json --trace-output b.txt")));
  EXPECT_EQ(read(path("a.txt")), read(path("b.txt")));
  EXPECT_EQ(run("replay a.db 0 --trace").err, read(path("a.txt")));
}

TEST_F(ReadableTrace, ShowsWhatIsAskedFor) {
  const auto shown = [&](const std::string& words) {
    EXPECT_TRUE(test::has_verdict(run("replay a.db 0 --trace-format json --trace-output t.jsonl " + words)));
    return lines_of("t.jsonl");
  };
  const auto all = shown("");
  std::size_t wanted = 0;
  for (const Json& line : all) {
    const bool is_event = line["event"] == "received" || line["event"] == "begins";
    const std::int64_t t_ns = line["t_ns"];
    wanted += is_event && line["body"] == "AGV 1" && t_ns >= 20'000'000'000 && t_ns <= 70'500'000'000 ? 1 : 0;
  }
  ASSERT_GT(wanted, 5U);
  EXPECT_EQ(
      shown("--trace-body 'AGV 1' --trace-kind received --trace-kind begins --trace-from 20 --trace-to 70.5").size(),
      wanted);
  EXPECT_THAT(run("replay a.db 0 --trace --trace-body Bob").err, HasSubstr("there is no \"Bob\" in this run"));
  EXPECT_THAT(run("replay a.db 0 --trace --trace-kind recieved").err, HasSubstr("\"recieved\" is not an event"));
  EXPECT_EQ(run("replay a.db 0 --trace --trace-format xml").exit_code, 2);
}

TEST_F(ReadableTrace, OverwritesOnlyATrace) {
  write("mine.txt", "my notes\n");
  EXPECT_EQ(run("replay a.db 0 --trace-output mine.txt").exit_code, 2);
  EXPECT_EQ(read(path("mine.txt")), "my notes\n");
  for (const char* format : {"text", "json"}) {
    const std::string words = std::string("replay a.db 0 --trace-output t --trace-format ") + format;
    EXPECT_EQ(run(words).exit_code, 0);
    EXPECT_EQ(run(words).exit_code, 0) << "a trace may be replaced";
  }
}

// A turn that was cut short names its goal, a drive its lane and its direction.
TEST_F(ReadableTrace, SaysWhereBodiesAre) {
  ASSERT_EQ(run("replay a.db 0 --trace-output t.txt").exit_code, 0);
  const std::string text = read(path("t.txt"));
  EXPECT_THAT(text, testing::ContainsRegex("begins         turn to -?[0-9]+\\.[0-9] deg"));
  EXPECT_THAT(text, testing::ContainsRegex("m/s on [^ ]+ from station [^ ]+ to [^ ]+"));
  EXPECT_THAT(text, testing::ContainsRegex("0\\.000 m/s at station "));
}

}  // namespace
}  // namespace fleetproof::readable_trace_test
