#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

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
  EXPECT_EQ(sentence(campaign(1)), "Earlier attempts unknown: the ledger " + path_ + " cannot be read.");
  std::filesystem::remove(path_);
  tried(1, "demonstrated");
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("Earlier attempts unknown: the ledger names no other attempt"));
  EXPECT_THAT(sentence(campaign(1)), HasSubstr("begins on 2026-01-01"));
  EXPECT_THAT(sentence(campaign(2)), HasSubstr("no ledger of attempts tells of this campaign"));
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

TEST_F(Attempts, OfAnotherReleaseInOtherWorldsAreNoAttemptsOfThisOne) {
  tried(1, "violated", "r1", "aa");
  tried(2, "demonstrated", "r2", "bb");
  EXPECT_THAT(sentence(campaign(2, "bb")), HasSubstr("names no other attempt"));
  EXPECT_THAT(sentence(campaign(2, "bb")), Not(HasSubstr("Another release")));
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
