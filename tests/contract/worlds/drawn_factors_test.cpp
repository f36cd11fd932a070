// Campaigns with continuous factors, held streams and exemptions, as a user runs them.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/program.hpp"

namespace fleetproof::drawn_factors_test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kHead = "name = \"c\"\nseed = 5\nreplicates = 8\nhorizon_s = 90.0\n";
const std::string kFactors =
    "[factors]\nagents = [\"reckless\", \"timeout-grant\"]\nlayouts = [\"aisle-grid\", "
    "\"corridor-sidings\"]\nfleet_sizes = [4]\n"
    "loss = { from = 0.0, to = 0.4 }\ndelay_s = { from = 0.0, to = 2.0 }\n";
const std::string kGate = "[[gate]]\nagent = \"timeout-grant\"\nlimit = 0.5\n";

class DrawnFactors : public test::ProgramTest {
 protected:
  // The report of a run on two workers, after the same on one wrote the same bytes.
  std::string campaign(const std::string& text) {
    write("c.toml", text);
    const auto one = run("run c.toml --db one.db -j 1"), two = run("run c.toml --db c.db -j 2");
    EXPECT_TRUE(test::has_verdict(two));
    EXPECT_TRUE(read(path("one.db")) == read(path("c.db")));
    return run("report c.db --format markdown").out;
  }

  std::string ask(const std::string& sql) const {
    SQLite::Database db(path("c.db"));
    return db.execAndGet(sql).getString();
  }

  void expect_replayed(const std::string& index) const {
    const auto replayed = run("replay c.db " + index);
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err << replayed.out;
    EXPECT_THAT(replayed.out, HasSubstr("REPRODUCED"));
  }
};

TEST_F(DrawnFactors, AreStoredReplayedAndClaimedAsARegion) {
  const auto page = campaign(kHead + kFactors + kGate);
  EXPECT_THAT(page, HasSubstr("8 worlds wherever loss <= 40 % and delay <= 2 s (drawn uniformly"));
  EXPECT_THAT(page, HasSubstr("| 0 .. 40 % | 0 .. 2 s |"));
  EXPECT_EQ(ask("SELECT count(*) FROM v1_cells WHERE in_contract AND NOT is_worst_case"), "4");
  EXPECT_EQ(ask("SELECT count(DISTINCT loss) || ' ' || count(DISTINCT delay_s) || ' ' || count(DISTINCT replicate || ' "
                "' || loss || ' ' || delay_s) "
                "FROM v1_runs"),
            "8 8 8");
  EXPECT_EQ(ask("SELECT min(loss) > 0 AND max(loss) < 0.4 AND max(delay_s) > 1 AND max(delay_s) < 2 FROM v1_runs"),
            "1");
  // The radio did what was drawn: the share of messages lost goes with the loss.
  EXPECT_EQ(
      ask("SELECT max(abs(1.0 * receptions_lost / receptions - loss)) < 0.1 FROM (SELECT replicate, loss, "
          "sum(receptions) receptions, "
          "sum(receptions_lost) "
          "receptions_lost FROM v1_runs WHERE agent = 'timeout-grant' GROUP BY replicate) WHERE receptions > 1000"),
      "1");
  for (const auto* index : {"0", "13", "31"}) expect_replayed(index);
  {
    SQLite::Database db(path("c.db"), SQLite::OPEN_READWRITE);
    db.exec("UPDATE runs SET loss = loss + 1e-12 WHERE run_index = 13");
  }
  const auto replayed = run("replay c.db 13");
  EXPECT_EQ(replayed.exit_code, 3);
  EXPECT_THAT(replayed.out, HasSubstr("the factors of the run"));
  EXPECT_EQ(run("report c.db").exit_code, 3) << "a changed value does not pass its checksum";
}

TEST_F(DrawnFactors, AnEvenSampleIsForSearches) {
  for (const std::string sampling : {"latin-hypercube", "sobol"}) {
    const auto factors = kFactors + "sampling = \"" + sampling + "\"\n";
    const auto page =
        campaign("kind = \"search\"\n" + kHead + factors + "[[gate]]\nagent = \"timeout-grant\"\nkind = \"none\"\n");
    EXPECT_THAT(page, HasSubstr("drawn evenly (" + sampling + ")"));
    EXPECT_EQ(ask("SELECT count(DISTINCT cast(loss / 0.4 * 8 AS INTEGER)) || count(DISTINCT cast(delay_s / 2.0 * 8 AS "
                  "INTEGER)) FROM v1_runs"),
              "88");
    expect_replayed("31");
    std::filesystem::remove(path("one.db"));
    std::filesystem::remove(path("c.db"));
    write("claim.toml", kHead + factors);
    const auto refused = run("check claim.toml");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("kind to \"search\""));
  }
}

TEST_F(DrawnFactors, AHeldWorldIsReplayedAndSaidToBeOne) {
  const auto page = campaign(kHead + kFactors +
                             "[vary]\nhold = [\"layout\", \"placement\", \"transports\", \"motion\", \"faults\", "
                             "\"agent\"]\nheld_replicate = 3\n" +
                             kGate);
  EXPECT_THAT(page, HasSubstr("in one warehouse for each of 2 layouts and fleet sizes, with the placement, transports, "
                              "motion, faults, agent of replicate 3"));
  for (const auto* index : {"0", "12", "31"}) expect_replayed(index);
  // Agents that send nothing would do the same in every replicate; what the radio loses differs.
  EXPECT_EQ(ask("SELECT count(DISTINCT receptions_lost) > 4 FROM v1_runs WHERE agent = 'timeout-grant' AND layout = "
                "'aisle-grid'"),
            "1");
  EXPECT_EQ(ask("SELECT count(DISTINCT transports_released) FROM v1_runs WHERE layout = 'aisle-grid'"), "1");
  const auto scenario = run("replay c.db 0 --scenario s.json");
  EXPECT_THAT(read(path("s.json")), HasSubstr("\"stream_seeds\""));
  EXPECT_EQ(run("check s.json").exit_code, 0);
  run("replay c.db 12 --scenario s.json");
  EXPECT_THAT(read(path("s.json")), Not(HasSubstr("\"stream_seeds\"")));
}

TEST_F(DrawnFactors, ExemptionsHeadTheReportAndAreReplayed) {
  const auto page = campaign(
      kHead + kFactors +
      "[world]\nplacement = \"charger-bank\"\n[law]\nexempt_purposes = [\"charging\"]\nexempt_radius_m = 1.5\n" +
      kGate);
  EXPECT_LT(page.find("AGVs within 1.5 m of a station for charging may be closer"), page.find("gate \"gate 1\""));
  EXPECT_THAT(run("report c.db --format json").out,
              HasSubstr("\"exemptions\": [\n    {\n      \"purposes\": \"charging\","));
  expect_replayed("17");
}

TEST_F(DrawnFactors, ExemptPairsHeadTheReportAndAreReplayed) {
  const auto page =
      campaign(kHead + kFactors +
               "[[vehicle]]\nname = \"tugger\"\n[law]\nexempt_pairs = [[\"tugger\", \"obstacle\"]]\n" + kGate);
  EXPECT_LT(page.find("tugger and obstacle may be closer than the safety distance"), page.find("gate \"gate 1\""));
  EXPECT_THAT(run("report c.db --format json").out,
              HasSubstr("\"exemptions\": [\n    {\n      \"pair\": \"tugger and obstacle\""));
  expect_replayed("17");
  run("replay c.db 0 --scenario s.json");
  EXPECT_THAT(run("simulate s.json --agent hull-lock").out,
              HasSubstr("exempt from the safety distance (contact is not): tugger and obstacle\n"));
  EXPECT_THAT(run("simulate s.json --agent hull-lock --json").out,
              HasSubstr("\"exempt_pairs\": [\n    [\n      \"tugger\",\n      \"obstacle\"\n    ]\n  ]"));
}

TEST_F(DrawnFactors, TheReplayLineOfASharedObjectsAgentFindsIt) {
  write("c.toml", "replicates = 2\nhorizon_s = 300.0\n[factors]\nagents = [\"" + std::string(FLEETPROOF_PLUGIN) +
                      "\"]\nlayouts = [\"corridor-sidings\"]\nfleet_sizes = [6]\nloss = [1.0]\n");
  run("run c.toml --db c.db");
  EXPECT_THAT(run("report c.db").out, HasSubstr("fleetproof replay c.db 0"));
  EXPECT_EQ(run("replay c.db 0").exit_code, 0) << "the session log remembers the file";
  EXPECT_EQ(run("replay c.db 0 --in-process").exit_code, 0);
  EXPECT_EQ(run("replay c.db 0 --plugin " + std::string(FLEETPROOF_PLUGIN)).exit_code, 0);
  std::filesystem::remove(path("c.sessions.jsonl"));
  const auto refused = run("replay c.db 0");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("no session log beside c.db says where it is"));
}

TEST_F(DrawnFactors, ALawThatMeasuresNoClearanceSaysSo) {
  const std::string scenario = test::source("tests/scenarios/parked_then_leaves.json");
  const auto paper = run("simulate " + scenario + " --law paper"), exact = run("simulate " + scenario);
  EXPECT_THAT(paper.out, HasSubstr("smallest clearance not measured"));
  EXPECT_THAT(exact.out, Not(HasSubstr("not measured")));
  EXPECT_THAT(run("simulate " + scenario + " --law paper --json").out, HasSubstr("\"clearance_measured\": false"));
  EXPECT_THAT(run("simulate " + scenario + " --json").out, HasSubstr("\"clearance_measured\": true"));
}

}  // namespace
}  // namespace fleetproof::drawn_factors_test
