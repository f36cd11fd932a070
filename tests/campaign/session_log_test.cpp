#include "campaign/batch/session_log.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::session_log_test {
namespace {

TEST(SessionLog, NothingIsAppendedToAForeignFile) {
  const samples::TemporaryFolder folder;
  samples::write_bytes(folder / "a.sessions.jsonl", "my notes\n");
  EXPECT_THROW(SessionLog(folder / "a.db"), InputError);
  EXPECT_EQ(samples::bytes_of(folder / "a.sessions.jsonl"), "my notes\n");
  samples::write_bytes(folder / "a.sessions.jsonl", "{\"started_utc\":\"2026-11-21T22:04:05Z\"}\n");
  EXPECT_NO_THROW(SessionLog(folder / "a.db"));
}

// All looks count, of all sessions with the same software; a merge names no software.
TEST(SessionLog, RemembersWhichAgentsDependOnEarlierRuns) {
  const samples::TemporaryFolder folder;
  const auto dependent = [&](const std::string& lines) {
    samples::write_bytes(folder / "a.sessions.jsonl", lines);
    return remembered_dependent_agents(folder / "a.db");
  };
  const auto begin = [](const std::string& software) {
    return R"({"started_utc":"x","plugins":{)" + software + "}}\n";
  };
  const auto end = [](const std::string& shown, const std::string& other) {
    return R"({"ended_utc":"x","looked_at_earlier_runs":{"a":{"dependent":)" + shown + R"(,"other":)" + other + "}}}\n";
  };
  const std::string first = begin(R"("a":{"sha256":"1"})"), second = begin(R"("a":{"sha256":"2"})");
  const std::set<std::string> none, a = {"a"};
  EXPECT_EQ(dependent(first + end("2", "0")), a);
  EXPECT_EQ(dependent(first + end("1", "0")), none) << "one look may be a chance";
  EXPECT_EQ(dependent(first + end("1", "0") + first + end("1", "0") + begin("")), a);
  EXPECT_EQ(dependent(first + end("2", "0") + first + end("0", "1")), none);
  EXPECT_EQ(dependent(first + end("2", "0") + second), none) << "other software";
  EXPECT_EQ(dependent("no JSON\n[1]\n" + first + end("\"2\"", "0") + R"({"looked_at_earlier_runs":{"a":3,"b":[2]}})"),
            none);
}

// Of damaged lines and of another ledger, none; a line of any kind stops no report.
TEST(SessionLog, RemembersTheLinesOfTheLastLedger) {
  const samples::TemporaryFolder folder;
  const std::string line = R"("ledger_line":7,"ledger_hash":"00000000000000ff"})";
  samples::write_bytes(folder / "a.sessions.jsonl",
                       R"({"ledger":"/old",)" + line + "\n" + R"({"ledger":5,)" + line + "\n" + R"({"ledger":"/new",)" +
                           line + "\n" + R"({"ledger":"/new","ledger_line":"7","ledger_hash":1})" + "\nno JSON\n");
  EXPECT_EQ(remembered_ledger_lines(folder / "a.db"), (std::vector<LogLine>{{7, 255}}));
}

TEST(SessionLog, RemembersWhatTheLastSessionOfItsAttemptTookOver) {
  const samples::TemporaryFolder folder;
  const auto taken = [&](const std::string& lines) {
    samples::write_bytes(folder / "a.sessions.jsonl", lines);
    return remembered_taken_over(folder / "a.db");
  };
  const std::string begin = R"({"started_utc":"x","attempt":"1"})"
                            "\n",
                    other = R"({"started_utc":"x","attempt":"2"})"
                            "\n",
                    first = R"({"runs_taken_over":30,"simulated_again":20,"drawn":10})"
                            "\n",
                    second = R"({"runs_taken_over":50,"simulated_again":"20","drawn":-1})"
                             "\n";
  EXPECT_EQ(taken(begin), std::nullopt);
  EXPECT_EQ(taken(begin + first), (TakenOver{30, 20, 10}));
  EXPECT_EQ(taken(begin + first + begin), (TakenOver{30, 20, 10})) << "there was nothing left to do";
  EXPECT_EQ(taken(begin + first + begin + second), (TakenOver{50, 0, 0})) << "what is no number is none";
  EXPECT_EQ(taken(begin + first + other), std::nullopt) << "the file was overwritten";
  EXPECT_EQ(taken("no JSON\n[1]\n"), std::nullopt);
}

TEST(SessionLog, RemembersTheSealThatTheLastSessionLeft) {
  const samples::TemporaryFolder folder;
  const auto left = [&](const std::string& lines) {
    samples::write_bytes(folder / "a.sessions.jsonl", lines);
    const RememberedSeal seal = remembered_seal(folder / "a.db");
    return std::pair(seal.has_end, seal.value);
  };
  using Left = std::pair<bool, std::optional<std::uint64_t>>;
  const std::string begin = R"({"started_utc":"x"})"
                            "\n",
                    end = R"({"ended_utc":"x","seal":"00000000000000ff"})"
                          "\n",
                    older = R"({"ended_utc":"x"})"
                            "\n";
  EXPECT_EQ(left(begin), Left(false, std::nullopt));
  EXPECT_EQ(left(begin + end), Left(true, 255U));
  EXPECT_EQ(left(begin + end + begin), Left(false, std::nullopt)) << "the last session noted none";
  EXPECT_EQ(left(begin + end + begin + older), Left(true, std::nullopt));
}

class RememberedPlugin : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(base_ + ".sessions.jsonl"); }

  std::string found(const std::string& log, const std::string& agent = "a/~0b") const {
    std::ofstream(base_ + ".sessions.jsonl") << log;
    return remembered_plugin(base_ + ".db", agent);
  }

  const std::string base_ =
      (std::filesystem::temp_directory_path() / ("fleetproof-session-log-" + std::to_string(getpid()))).string();
};

TEST_F(RememberedPlugin, IsTheFileOfTheLastSessionThatNamesTheAgent) {
  const std::string first = "{\"plugins\": {\"a/~0b\": {\"file\": \"/old.so\"}, \"x\": {\"file\": \"/x.so\"}}}\n";
  const std::string second = "{\"plugins\": {\"a/~0b\": {\"file\": \"/new.so\"}}}\n{\"ended_utc\": \"now\"}\n";
  EXPECT_EQ(found(first), "/old.so");
  EXPECT_EQ(found(first + second), "/new.so");
  EXPECT_EQ(found(first + second, "x"), "/x.so");
  EXPECT_EQ(found(first + second, "a"), "");
  EXPECT_EQ(remembered_plugin(base_ + "-none.db", "x"), "");
}

TEST_F(RememberedPlugin, LinesOfAnotherKindArePassedOver) {
  const std::string ours = "{\"plugins\": {\"a/~0b\": {\"file\": \"/a.so\"}}}\n";
  for (const std::string foreign :
       {"", "no JSON", "{\"plugins\":", "7", "null", "[\"plugins\"]", "\"plugins\"", "{\"plugins\": 7}",
        "{\"plugins\": [1]}", "{\"plugins\": {\"a/~0b\": \"/b.so\"}}", "{\"plugins\": {\"a/~0b\": {\"file\": 7}}}",
        "{\"plugins\": {\"a/~0b\": null}}", "{\"plugins\": {\"a/~0b\": {}}}", "\xff\xfe"}) {
    EXPECT_EQ(found(foreign), "") << foreign;
    EXPECT_EQ(found(ours + foreign + "\n"), "/a.so") << foreign;
  }
}

}  // namespace
}  // namespace fleetproof::session_log_test
