#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "reports/attempts/attempt_section.hpp"
#include "reports/attempts/looks.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::attempts_test {
namespace {

using samples::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

class Attempts : public testing::Test {
 protected:
  static CampaignRecord campaign(std::uint64_t seed, const std::string& program = "aa") {
    CampaignRecord record;
    record.seed = seed;
    record.plan_json = R"({"name":"n","replicates":3,"seed":)" + std::to_string(seed) + "}";
    record.plan_hash = seed;
    record.engine.program_sha256 = program;
    return record;
  }
  void tried(std::uint64_t seed, const std::string& verdict, const std::string& release = "r1",
             const std::string& program = "aa", const std::string& archive = "a.db", bool overwrites = false) {
    AttemptLedger ledger(path_);
    Attempt attempt = attempt_of(campaign(seed, program));
    attempt.id = std::to_string(++count_);
    attempt.begun_utc = "2026-01-0" + attempt.id + "T00:00:00Z";
    attempt.archive = archive;
    attempt.release = release;
    ledger.begin(attempt, overwrites);
    if (verdict.empty()) return;
    attempt.verdict = verdict;
    ledger.end(attempt);
  }
  std::string sentence(const CampaignRecord& of, double risk = 0.05) const {
    return attempts_sentence(attempt_history(AttemptLedger(path_), of), risk);
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "attempts.jsonl";
  int count_ = 0;
};

TEST_F(Attempts, AreUnknownWithoutALedgerAndNeverTheFirst) {
  EXPECT_EQ(sentence(campaign(1)), "Earlier attempts unknown: no ledger of attempts tells of this campaign.");
  std::filesystem::create_directory(path_);
  EXPECT_THROW(sentence(campaign(1)), InputError);
  AttemptHistory unreadable;
  unreadable.ledger_trouble = "a.jsonl: is a folder";
  EXPECT_EQ(attempts_sentence(unreadable, 0.05),
            "Earlier attempts unknown: the ledger cannot be read (a.jsonl: is a folder).");
  std::filesystem::remove(path_);
  tried(1, "demonstrated");
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("Earlier attempts unknown: the ledger names no other attempt"));
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("begins on 2026-01-01"));
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("no ledger of attempts tells of this campaign"));
}

TEST_F(Attempts, WithAChosenSeedMayFollowASearch) {
  tried(1, "demonstrated");
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("whether these worlds were seen before in a search, no ledger tells"));
  AttemptHistory fresh = attempt_history(AttemptLedger(path_), campaign(1));
  fresh.own->fresh_seed = true;
  EXPECT_THAT(attempts_sentence(fresh, 0.05), Not(HasSubstr("search")));
  EXPECT_THAT(attempts_sentence(fresh, 0.05), HasSubstr("whoever changes a byte of either gets other worlds"));
}

TEST_F(Attempts, OfNobodyKnowsWhichReleaseMayBeOfThisOne) {
  tried(1, "violated", "");
  tried(2, "demonstrated", "r1");
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("2 attempts for this release"));
  EXPECT_THAT(sentence(campaign(2)), Not(HasSubstr("other software")));
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("2 attempts for this release"));
}

TEST_F(Attempts, WithOtherSeedsAreToldWithTheirVerdictsAndTheAddedRisk) {
  tried(1, "violated");
  tried(2, "");
  tried(3, "demonstrated");
  const std::string text = sentence(campaign(3));
  EXPECT_THAT(text, HasSubstr("3 attempts for this release: this one and 2 others ("));
  EXPECT_THAT(text, HasSubstr("seed 1, plan digest 0000000000000001: violated"));
  EXPECT_THAT(text, HasSubstr("seed 2, plan digest 0000000000000002: aborted or still under way"));
  EXPECT_THAT(text, HasSubstr("at most 5 % of cases, by one of 3 in up to 15 %"));
}

TEST_F(Attempts, OverwrittenOnesStay) {
  tried(1, "violated", "r1", "aa", "a.db");
  tried(2, "demonstrated", "r1", "aa", "a.db", true);
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("seed 1, plan digest 0000000000000001: violated, overwritten"));
  tried(3, "demonstrated", "r1", "aa", "b.db", true);
  EXPECT_THAT(sentence(campaign(3)), HasSubstr("seed 2, plan digest 0000000000000002: demonstrated;"))
      << "another file was overwritten";
}

TEST_F(Attempts, WithTheSamePlanAreOne) {
  tried(1, "");
  tried(1, "demonstrated");
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("no other attempt"));
  CampaignRecord longer = campaign(1);
  longer.plan_json = R"({"name":"other","replicates":30,"seed":1})";
  EXPECT_THAT(sentence(longer), HasSubstr("no other attempt")) << "more of the same worlds";
}

// Its bound holds for one number of replicates, so that each number is a try of its own.
TEST_F(Attempts, WithAFixedGateAnotherNumberOfReplicatesIsAnotherAttempt) {
  const auto digest = [](const std::string& replicates, const std::string& methods) {
    CampaignRecord record;
    record.plan_json = R"({"name":"n","seed":1,"replicates":)" + replicates + R"(,"gates":[)" + methods + "]}";
    return attempt_of(record).worlds;
  };
  const std::string fixed = R"({"method":"fixed"})", any_time = R"({"method":"any-time"})";
  EXPECT_NE(digest("60", any_time + "," + fixed), digest("30", any_time + "," + fixed));
  EXPECT_EQ(digest("60", fixed), digest("60", fixed));
  EXPECT_EQ(digest("60", any_time), digest("30", any_time));
}

TEST_F(Attempts, InTheSameWorldsWithAnotherVerdictAreOthers) {
  tried(1, "violated");
  tried(1, "violated");
  tried(1, "demonstrated");
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("3 attempts for this release: this one and 2 others ("));
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("seed 1, plan digest 0000000000000001: violated"));
  tried(1, "demonstrated");
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("this one and 2 others (")) << "the same verdict again is no other try";
}

TEST_F(Attempts, OfAnotherReleaseInTheSameWorldsAreTold) {
  tried(1, "violated", "r1", "aa");
  tried(1, "demonstrated", "r2", "bb");
  EXPECT_THAT(sentence(campaign(1, "bb")),
              HasSubstr("Another release was tried in the same worlds before (2026-01-01"));
  EXPECT_THAT(sentence(campaign(1, "aa")), Not(HasSubstr("Another release"))) << "it came later";
}

// A new name, another parameter or one more byte makes another release of the same software.
TEST_F(Attempts, AtTheSamePlanByOtherSoftwareAreNamedAndCounted) {
  tried(1, "violated", "r1", "aa");
  tried(2, "violated", "r1", "aa");
  tried(3, "demonstrated", "r2", "bb");
  const std::string text = sentence(campaign(3, "bb"));
  EXPECT_THAT(text, HasSubstr("names no other attempt for this release"));
  EXPECT_THAT(text, HasSubstr("names 2 attempts at the same plan by other software (seed 2, plan digest "
                              "0000000000000002: violated; seed 1, "));
  EXPECT_THAT(text, HasSubstr("by one of 3 in up to 15 %"));
  EXPECT_THAT(text, Not(HasSubstr("Another release"))) << "its worlds are others";
  tried(4, "violated", "r2", "bb");
  tried(3, "demonstrated", "r2", "bb");
  EXPECT_THAT(sentence(campaign(3, "bb")), HasSubstr("by one of 4 in up to 20 %")) << "with those of this release";
}

TEST_F(Attempts, AtAnotherPlanByOtherSoftwareAreNone) {
  const auto conditions = [](const std::string& plan) {
    CampaignRecord record;
    record.plan_json = plan;
    return attempt_of(record).conditions;
  };
  const std::string plan = R"({"name":"n","seed":1,"replicates":3,"horizon_s":60,"agent_config":"x",)"
                           R"("factors":{"agents":["a"],"loss":[0]},"gates":[{"name":"g","agent":"a","limit":0.1}]})";
  for (const auto& [from, to] :
       std::initializer_list<std::pair<std::string, std::string>>{{R"("agents":["a"])", R"("agents":["b"])"},
                                                                  {R"("agent":"a")", R"("agent":"b")"},
                                                                  {R"("name":"g")", R"("name":"h")"},
                                                                  {R"("agent_config":"x")", R"("agent_config":"y")"},
                                                                  {R"("seed":1)", R"("seed":2)"},
                                                                  {R"("replicates":3)", R"("replicates":9)"}}) {
    std::string other = plan;
    EXPECT_EQ(conditions(other.replace(other.find(from), from.size(), to)), conditions(plan)) << to;
  }
  for (const auto& [from, to] :
       std::initializer_list<std::pair<std::string, std::string>>{{R"("horizon_s":60)", R"("horizon_s":61)"},
                                                                  {R"("loss":[0])", R"("loss":[0.1])"},
                                                                  {R"("limit":0.1)", R"("limit":0.2)"}}) {
    std::string other = plan;
    EXPECT_NE(conditions(other.replace(other.find(from), from.size(), to)), conditions(plan)) << to;
  }
}

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

void write_lines(const std::string& path, const std::vector<std::string>& lines) {
  std::ofstream file(path);
  for (const std::string& line : lines) file << line << "\n";
}

TEST_F(Attempts, OfALedgerThatSomebodyChangedAreToldSo) {
  for (const std::uint64_t seed : {1, 2, 3}) tried(seed, "violated");
  const auto lines = lines_of(path_);
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_THAT(sentence(campaign(3)), Not(HasSubstr("changed the ledger")));
  auto without = lines;
  without.erase(without.begin(), without.begin() + 2);  // an attempt is taken out
  write_lines(path_, without);
  EXPECT_THAT(sentence(campaign(3)), HasSubstr("Line 1 of the ledger does not follow the line before it"));
  auto other = lines;
  other[1].replace(other[1].find("violated"), 8, "demonstr");
  write_lines(path_, other);
  EXPECT_THAT(sentence(campaign(3)), HasSubstr("Line 3 of the ledger"));
  auto swapped = lines;
  std::swap(swapped[0], swapped[2]);
  write_lines(path_, swapped);
  EXPECT_THAT(sentence(campaign(3)), HasSubstr("changed the ledger"));
}

TEST_F(Attempts, OfALedgerThatAnOlderProgramBeganGoOn) {
  std::ofstream(path_) << R"({"attempt":"begins","id":"old","release":"r0","worlds":"w"})"
                          "\n";
  tried(1, "violated");
  EXPECT_THAT(sentence(campaign(1)), Not(HasSubstr("changed the ledger")));
  auto lines = lines_of(path_);
  lines[0][15] = 'x';
  write_lines(path_, lines);
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("Line 2 of the ledger"));
}

TEST_F(Attempts, HaveALineThatASessionLogCanName) {
  AttemptLedger ledger(path_);
  Attempt attempt = attempt_of(campaign(1));
  attempt.id = "1";
  const LogLine line = ledger.begin(attempt, false);
  EXPECT_EQ(line.number, 1U);
  tried(2, "violated");
  EXPECT_TRUE(AttemptLedger(path_).has(line));
  EXPECT_EQ(AttemptLedger(path_).attempts().front().line, line);
  EXPECT_FALSE(AttemptLedger(path_).has({line.number, line.hash + 1}));
  EXPECT_FALSE(AttemptLedger(path_).has({9, line.hash}));
  EXPECT_FALSE(AttemptLedger(folder_ / "none.jsonl").has(line));
  AttemptHistory history = attempt_history(AttemptLedger(path_), campaign(1));
  history.ledger_lost_line = true;
  history.has_session_log = false;
  EXPECT_THAT(attempts_sentence(history, 0.05),
              HasSubstr("The session log names a line of a ledger that is not there"));
  EXPECT_THAT(attempts_sentence(history, 0.05), HasSubstr("There is no session log beside the results file"));
}

TEST_F(Attempts, SayWhichShareOfTakenOverRowsMayBeExchanged) {
  const auto troubles = [](const TakenOver& taken) {
    AttemptHistory history;
    history.taken_over = taken;
    return attempt_troubles(history);
  };
  EXPECT_EQ(troubles({2000, 340, 300}),
            " 2000 runs were stored by an earlier session; the last one simulated 340 of them again, 300 drawn at "
            "random: if more than 0.994 % of the rows had been exchanged, that would have shown with 95 %.")
      << "1 - 0.05^(1/300)";
  EXPECT_THAT(troubles({2000, 7, 0}),
              HasSubstr("7 of them again, 0 drawn at random: whether somebody had exchanged rows"));
  EXPECT_EQ(troubles({300, 300, 280}), "") << "all of them";
}

TEST_F(Attempts, NameASessionLogThatDoesNotFitTheFile) {
  AttemptHistory history;
  EXPECT_EQ(attempt_troubles(history), "");
  history.log_is_foreign = history.log_names_no_file = history.log_has_no_end = true;
  for (const char* said :
       {"The session log is that of another results file", "does not say which file", "noted no end"})
    EXPECT_THAT(attempts_sentence(history, 0.05), HasSubstr(said));
  history.has_session_log = false;
  EXPECT_THAT(attempts_sentence(history, 0.05), Not(HasSubstr("another results file")));
}

TEST_F(Attempts, InOtherWorldsCountOnceHoweverOftenTheyAreRepeated) {
  tried(1, "");
  tried(1, "violated");
  tried(2, "demonstrated");
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("this one and 1 other ("));
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("seed 1, plan digest 0000000000000001: violated"));
}

TEST_F(Attempts, TheLastWithThisPlanIsThatOfTheCampaignFile) {
  tried(1, "violated");
  tried(1, "demonstrated");
  EXPECT_EQ(attempt_history(AttemptLedger(path_), campaign(1)).own->id, "2");
}

TEST_F(Attempts, TheLatestOthersAreTold) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) tried(seed, "violated");
  const std::string text = sentence(campaign(5));
  EXPECT_THAT(text, HasSubstr("(seed 4, "));
  EXPECT_THAT(text, HasSubstr("seed 2, "));
  EXPECT_THAT(text, Not(HasSubstr("seed 1, ")));
  EXPECT_THAT(text, HasSubstr("1 more"));
}

TEST_F(Attempts, WithOtherLibrariesAreOfOtherSoftware) {
  CampaignRecord other = campaign(1);
  other.engine.libraries = "SQLite 3.41";
  EXPECT_NE(attempt_of(other).software, attempt_of(campaign(1)).software);
}

TEST_F(Attempts, ABrokenLineIsCountedAndCostsNothingElse) {
  tried(1, "violated");
  std::ofstream(path_, std::ios::app) << "{\"attempt\":\"begins\",\"id\":\"9\n[]\n";
  tried(2, "demonstrated");
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("this one and 1 other ("));
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("2 lines of the ledger cannot be read"));
}

TEST_F(Attempts, AForeignFileIsRefusedAndStaysAsItIs) {
  samples::write_bytes(path_, "my notes\n");
  EXPECT_THROW(AttemptLedger{path_}, InputError);
  EXPECT_EQ(samples::bytes_of(path_), "my notes\n");
}

TEST_F(Attempts, LooksCountByTheRunsThatWereThere) {
  const std::string archive = folder_ / "a.db";
  EXPECT_EQ(looks_at(archive), std::nullopt);
  note_look(archive, 5);
  EXPECT_EQ(looks_at(archive), std::nullopt) << "only an existing session log takes the record";
  samples::write_bytes(folder_ / "a.sessions.jsonl",
                       "{\"started_utc\":\"x\"}\n{\"ended_utc\":\"x\",\"runs_stored\":100}\n");
  EXPECT_EQ(looks_at(archive), 1U);
  note_look(archive, 100);
  EXPECT_EQ(looks_at(archive), 1U) << "the same runs again";
  note_look(archive, 140);
  note_look(archive, 140);
  EXPECT_EQ(looks_at(archive), 2U);
  EXPECT_EQ(std::ranges::count(samples::bytes_of(folder_ / "a.sessions.jsonl"), '\n'), 3) << "one line for each look";
}

}  // namespace
}  // namespace fleetproof::attempts_test
