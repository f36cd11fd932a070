// What the pages for people count stands in the JSON report, too.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::json_counts_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class JsonCounts : public test::ProgramTest {
 protected:
  void write_campaign(int replicates) const {
    write("a.toml", "seed = 5\nreplicates = " + std::to_string(replicates) +
                        "\nhorizon_s = 120\n[factors]\nagents = [\"hull-lock\", \"reckless\"]\nlayouts = "
                        "[\"aisle-grid\", \"fishbone\"]\nfleet_sizes = [3, 5]\nloss = [0.0, 0.4]\ndelay_s = [0]\n");
  }
  json report() const { return json::parse(run("report a.db --json").out); }
};

// Of all runs that are stored: a campaign that stopped at its first failure has no complete replicate.
TEST_F(JsonCounts, AfterFailFastAreThoseOfTheText) {
  write_campaign(40);
  run("run a.toml --db a.db --fail-fast 3");
  const std::string text = run("report a.db").out;
  const json counted = report();
  ASSERT_EQ(counted["campaign"]["complete_replicates"], 0);
  ASSERT_EQ(counted["contract_failures"].size(), 1U);
  const json& reckless = counted["contract_failures"][0];
  EXPECT_EQ(reckless["agent"], "reckless");
  EXPECT_TRUE(reckless["under_test"].get<bool>());
  EXPECT_EQ(reckless["runs"], 3);
  EXPECT_THAT(text, HasSubstr("agent reckless broke the safety distance in 3 runs within the contract region"));
  EXPECT_THAT(text, HasSubstr(reckless["worst_run"]["replay"].get<std::string>()));
}

TEST_F(JsonCounts, ByLayoutAndFleetAreThoseOfTheTables) {
  write_campaign(4);
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db")));
  const json counted = report();
  std::uint64_t all = 0, by_layout = 0, by_fleet = 0;
  for (const json& row : counted["breakdowns"]) {
    if (row["agent"] != "reckless") continue;
    const std::uint64_t violating = row["violating_runs"];
    if (!row["layout"].is_null()) {
      by_layout += violating;
    } else if (!row["fleet_size"].is_null()) {
      by_fleet += violating;
    } else {
      all += violating;
    }
    EXPECT_LE(row["failing_worlds"], row["worlds"]);
    EXPECT_TRUE(row["claim"].is_object());
  }
  EXPECT_GT(all, 0U);
  EXPECT_EQ(by_layout, all);
  EXPECT_EQ(by_fleet, all);
}

// The flags of a run, and what it counts as, in the archive and in the table.
TEST_F(JsonCounts, TablesSayHowARunIsJudged) {
  write_campaign(2);
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db")));
  run("report a.db --evidence set");
  const std::string table = read(path("set/runs.csv"));
  EXPECT_THAT(table, HasSubstr(",failed,unknown,judged\r\n"));
  EXPECT_THAT(table, HasSubstr(",failed\r\n"));
  EXPECT_THAT(table, HasSubstr(",passed\r\n"));
  EXPECT_THAT(read(path("set/columns.csv")), HasSubstr("before the first contact"));
}

}  // namespace
}  // namespace fleetproof::json_counts_test
