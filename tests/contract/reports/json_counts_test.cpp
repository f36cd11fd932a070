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

// Where bodies lie on the floor, flags and judgement differ.
TEST_F(JsonCounts, TableAndArchiveJudgeEachRunAlike) {
  write("a.toml",
        "seed = 5\nreplicates = 12\nhorizon_s = 120\n[factors]\nagents = [\"hull-lock\", \"reckless\"]\nlayouts = "
        "[\"aisle-grid\"]\nfleet_sizes = [3]\n[faults]\nobstacles_per_hour = 120\n");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db")));
  run("report a.db --evidence set");
  write("compare.py", R"(
import csv, sqlite3
words = ("run_index", "violation", "failed", "unknown", "judged")
table = [tuple(row[word] for word in words) for row in csv.DictReader(open("set/runs.csv", newline=""))]
rows = sqlite3.connect("a.db").execute("SELECT " + ", ".join(words) + " FROM v1_runs ORDER BY run_index")
archive = [tuple(str(value) for value in row) for row in rows]
assert table == archive, (table, archive)
print(*sorted({row[4] for row in table}), any(row[1] == "1" and row[4] == "unknown" for row in table))
)");
  const auto compared = shell("python3 -B compare.py");
  EXPECT_EQ(compared.out, "failed passed unknown True\n") << compared.err;
}

}  // namespace
}  // namespace fleetproof::json_counts_test
