// In the live file of a session that was killed, somebody puts other rows in the place of a few that failed. The rows
// have good checksums: they are those of sound software, or of an easier plan. The campaign then goes on.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::exchanged_rows_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ExchangedRows : public test::AuditedCampaign {
 protected:
  static std::string campaign(const std::string& agent, int replicates, const std::string& more = "") {
    return fmt::format(
        "name = \"c\"\nreplicates = {}\nhorizon_s = 60\ndefault_gates = false\n[factors]\nagents = [{}]\n"
        "layouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n[coverage]\nprobes = []\n{}",
        replicates, agent, more);
  }
  // Runs b.toml to its end, and a.toml until it has `rows` rows and is killed. Then `python` exchanges rows: db is the
  // live file, cut to its first rows, and take(where) takes those rows from the other file.
  void exchange(int rows, const std::string& python) const {
    write("exchange.py", R"py(
import sqlite3, sys
rows = int(sys.argv[1])
db = sqlite3.connect("a.db.partial")
db.execute("ATTACH 'b.db' AS other")
tables = {name: [column[1] for column in db.execute(f"PRAGMA main.table_info({name})")]
          for (name,) in db.execute("SELECT name FROM main.sqlite_schema WHERE type = 'table'")}
for name, columns in tables.items():
    if "run_index" in columns:
        db.execute(f"DELETE FROM main.{name} WHERE run_index >= {rows}")
def take(where):
    index = [i for (i,) in db.execute(f"SELECT run_index FROM main.runs WHERE {where}")]
    for name in ("runs", "violations", "incidents", "probes"):
        for run in index:
            db.execute(f"DELETE FROM main.{name} WHERE run_index = {run}")
            columns = ", ".join(tables[name])
            db.execute(f"INSERT INTO main.{name} SELECT {columns} FROM other.{name} WHERE run_index = {run}")
    assert index, where
    return index
FAILS = "violation AND run_index IN (SELECT run_index FROM other.runs WHERE outcome_class = 'clean')"
)py" + python + "\ndb.commit()\nprint('exchanged')\n");
    const auto done = shell(fmt::format(R"sh(
"$FLEETPROOF" run b.toml --db b.db >/dev/null 2>&1
"$FLEETPROOF" run a.toml --db a.db >/dev/null 2>&1 & pid=$!
for i in $(seq 400); do
  python3 -c '
import sqlite3, sys
sys.exit(sqlite3.connect("a.db.partial").execute("SELECT count(*) FROM runs").fetchone()[0] < {0})' 2>/dev/null && break
  sleep 0.1
done
kill -9 $pid; wait $pid 2>/dev/null
python3 exchange.py {0}
)sh",
                                        rows));
    ASSERT_THAT(done.out, HasSubstr("exchanged")) << done.err;
  }
  void expect_refused() const {
    const auto refused = run("run a.toml --db a.db");
    EXPECT_EQ(refused.exit_code, 3) << refused.out << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("is stored otherwise than this program simulates it"));
  }
  static constexpr const char *kReckless = "\"reckless\"", *kSound = "\"hull-lock\"";
};

TEST_F(ExchangedRows, AFewOfThreeHundredAreFound) {
  write("a.toml", campaign(kReckless, 100'000));
  write("b.toml", campaign(kSound, 300));
  exchange(300, "take(FAILS + ' ORDER BY run_index LIMIT 3')");
  expect_refused();
}

// One row of 2000, and the audit that knew better.
TEST_F(ExchangedRows, ARowIsFoundAlthoughItsAuditWasChangedWithIt) {
  write("a.toml", campaign(kReckless, 100'000, "[audit]\nshare = 0.02\n"));
  write("b.toml", campaign(kSound, 2000));
  exchange(2000, R"py(
run = take("run_index IN (SELECT run_index FROM main.audits) AND " + FAILS + " ORDER BY run_index DESC LIMIT 1")[0]
same = f"(SELECT checksum FROM main.runs WHERE run_index = {run})"
db.execute(f"UPDATE audits SET checksum = {same} WHERE run_index = {run}")
)py");
  expect_refused();
}

// By the rows of the same software with a smaller safety distance: the clearance stays.
TEST_F(ExchangedRows, ARowIsFoundByItsClearance) {
  write("a.toml", campaign(kReckless, 100'000));
  write("b.toml", campaign(kReckless, 2000, "[law]\nsafety_distance_m = 0.001\n"));
  exchange(2000, "take(FAILS + ' AND run_index > 1000 ORDER BY run_index LIMIT 1')");
  expect_refused();
}

// What the agents did in a run that failed is still there. This software differs in audits alone, so that its failed
// runs are recorded; a row that it does not repeat becomes an audit that differs.
TEST_F(ExchangedRows, ARowIsFoundByItsRecording) {
  write("a.toml", campaign(test::failing("audit-throw 2"), 100'000, "[audit]\nshare = 0.0001\n"));
  write("b.toml", campaign(kSound, 2000));
  exchange(2000, R"py(
run = take("run_index IN (SELECT run_index FROM main.recordings) AND run_index > 900 AND "
           "run_index NOT IN (SELECT run_index FROM main.audits) AND " + FAILS + " ORDER BY run_index LIMIT 1")[0]
open("run.txt", "w").write(str(run))
)py");
  (void)run("run a.toml --db a.db --max-time 5");
  EXPECT_EQ(shell(R"sh(python3 -c '
import sqlite3
run = int(open("run.txt").read())
print(sqlite3.connect("a.db").execute("SELECT count(*) FROM audits a JOIN runs r USING (run_index) WHERE run_index = ? "
                                      "AND a.checksum <> r.checksum", (run,)).fetchone()[0])')sh")
                .out,
            "1\n");
}

TEST_F(ExchangedRows, TheHeadSaysHowManyRowsMayHaveBeenExchanged) {
  const std::string gate =
      "[[gate]]\nname = \"g\"\nagent = \"hull-lock\"\nlimit = 0.5\nmin_transports_per_agv_hour = 0\n";
  write("a.toml", campaign(kSound, 100'000, gate));
  write("b.toml", campaign(kSound, 1, gate));
  exchange(1000, "");
  (void)run("run a.toml --db a.db --max-time 5");
  const std::string head = std::regex_replace(run("report a.db").out, std::regex("\\s+"), " ");
  const json taken = json::parse(run("report a.db --format json").out).at("attempts").at("taken_over");
  EXPECT_EQ(taken.at("runs"), 1000);
  const int again = taken.at("simulated_again"), drawn = taken.at("drawn");
  EXPECT_GE(again, drawn);
  EXPECT_GE(drawn, 100) << "of 300, in two seconds";
  EXPECT_NEAR(taken.at("most_exchanged"), 1.0 - std::pow(0.05, 1.0 / drawn), 1e-12);
  EXPECT_THAT(head, HasSubstr(fmt::format("1000 runs were stored by an earlier session; the last one simulated {} of "
                                          "them again, {} drawn at random: if more than ",
                                          again, drawn)));
  EXPECT_THAT(head, HasSubstr("of the rows had been exchanged, that would have shown with 95 %."));
}

TEST_F(ExchangedRows, NothingIsSaidIfAllWereSimulatedAgainOrNoneWasTakenOver) {
  const std::string gate =
      "[[gate]]\nname = \"g\"\nagent = \"hull-lock\"\nlimit = 0.5\nmin_transports_per_agv_hour = 0\n";
  write("a.toml", campaign(kSound, 60, gate));
  (void)run("run a.toml --db a.db --replicates 30");
  const auto attempts = [&] { return json::parse(run("report a.db --format json").out).at("attempts"); };
  EXPECT_TRUE(attempts().at("taken_over").is_null());
  (void)run("run a.toml --db a.db");
  EXPECT_EQ(attempts().at("taken_over").at("runs"), 30);
  EXPECT_EQ(attempts().at("taken_over").at("simulated_again"), 30);
  EXPECT_THAT(run("report a.db").out, testing::Not(HasSubstr("by an earlier session")));
  (void)run("run a.toml --db a.db --overwrite");
  EXPECT_TRUE(attempts().at("taken_over").is_null()) << "that is another attempt";
}

}  // namespace
}  // namespace fleetproof::exchanged_rows_test
