// report --evidence: a folder that an assessor can check with sha256sum and any CSV reader.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "campaign/run/sha256.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::evidence_set_test {
namespace {

using testing::HasSubstr;

// RFC 4180, on its own: fields of one record, with quotes taken off.
std::vector<std::string> fields_of(std::istream& in) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (char c; in.get(c);) {
    if (quoted && c == '"' && in.peek() == '"') {
      fields.back() += static_cast<char>(in.get());
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      fields.emplace_back();
    } else if (!quoted && c == '\r' && in.peek() == '\n') {
      in.get();
      return fields;
    } else {
      fields.back() += c;
    }
  }
  return {};
}

std::vector<std::vector<std::string>> records_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<std::vector<std::string>> records;
  for (auto fields = fields_of(in); !fields.empty(); fields = fields_of(in)) records.push_back(fields);
  return records;
}

class EvidenceSet : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("c.toml",
          "seed = 5\nreplicates = 12\nhorizon_s = 120\n[factors]\nagents = [{ name = \"=cmd,\\\"x\\\"\", agent = "
          "\"reckless\" }, \"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [5]\nloss = [0.4]\ndelay_s = "
          "[2]\n");
    run("run c.toml --db a.db");
  }
};

TEST_F(EvidenceSet, HoldsWhatItsSumsSay) {
  run("report a.db --evidence set");
  std::ifstream sums(path("set/SHA256SUMS"));
  std::set<std::string> named{"SHA256SUMS"};
  for (std::string sum, name; sums >> sum >> name;) {
    EXPECT_EQ(sha256_of_file(path("set/" + name)), sum) << name;
    named.insert(name);
  }
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(path("set"))) there.insert(entry.path().filename());
  EXPECT_EQ(there, named);
  EXPECT_THAT(there, testing::IsSupersetOf({"report.html", "report.txt", "report.json", "report.xml", "plan.json",
                                            "identity.json", "runs.csv", "violations.csv", "incidents.csv",
                                            "columns.csv", "replay.txt", "attempts.jsonl", "sessions.jsonl",
                                            "validity.txt", "a.db", "campaign.toml", "REPEAT.md"}));
  EXPECT_FALSE(std::filesystem::exists(path("set.partial")));
}

TEST_F(EvidenceSet, TablesHaveOneFieldForEachColumnOfTheDictionary) {
  run("report a.db --evidence set");
  std::map<std::string, std::vector<std::string>> columns;
  for (const auto& record : records_of(path("set/columns.csv"))) {
    ASSERT_EQ(record.size(), 5U);
    if (record[0] != "file") columns[record[0]].push_back(record[2]);
    EXPECT_FALSE(record[4].empty()) << record[2];
  }
  EXPECT_EQ(columns.size(), 3U);
  for (const auto& [file, names] : columns) {
    const auto records = records_of(path("set/" + file));
    ASSERT_FALSE(records.empty());
    EXPECT_EQ(records[0], names) << file;
    for (const auto& record : records) ASSERT_EQ(record.size(), names.size()) << file;
  }
  const auto runs = records_of(path("set/runs.csv"));
  ASSERT_EQ(runs.size(), 25U);
  EXPECT_EQ(runs[1][3], "'=cmd,\"x\"") << "no formula";
  EXPECT_EQ(runs[2][3], "hull-lock") << "each run has the factors of its own cell";
}

TEST_F(EvidenceSet, HoldsTheLogsAndTheIdentityOfItsCampaign) {
  run("report a.db --evidence set");
  EXPECT_THAT(read(path("attempts.jsonl")), HasSubstr("begins"));
  EXPECT_EQ(read(path("set/attempts.jsonl")), read(path("attempts.jsonl")));
  EXPECT_THAT(read(path("a.sessions.jsonl")), HasSubstr("started_utc"));
  EXPECT_EQ(read(path("set/sessions.jsonl")), read(path("a.sessions.jsonl")));
  EXPECT_THAT(read(path("set/report.xml")), testing::StartsWith("<?xml"));
  EXPECT_EQ(read(path("set/report.json")), run("report a.db --format json").out);
  const auto identity = nlohmann::json::parse(read(path("set/identity.json")));
  EXPECT_EQ(identity.at("campaign_file_sha256"), sha256_of_file(path("a.db")));
  EXPECT_EQ(nlohmann::json::parse(read(path("set/plan.json"))).at("seed"), 5);
  EXPECT_THAT(read(path("set/validity.txt")), HasSubstr(" of 24 runs have a trace that an earlier run"));
}

// The oracle asks the exported table: contacts of agents under test, their other violations, then reference agents.
TEST_F(EvidenceSet, ReplaysExactlyTheFailingRunsTheWorstOfTheSoftwareUnderTestFirst) {
  write("d.toml",
        "seed = 13\nreplicates = 60\nhorizon_s = 40\n[factors]\nagents = [\"reckless\", { name = \"mine\", agent = "
        "\"timeout-grant\", role = \"candidate\" }]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = "
        "[0.4]\ndelay_s = "
        "[2]\n");
  run("run d.toml --db d.db");
  run("report d.db --evidence set");
  const auto runs = records_of(path("set/runs.csv"));
  const auto column = [&](const char* name) { return std::ranges::find(runs[0], name) - runs[0].begin(); };
  const auto agent = column("agent"), contact = column("contact"), violation = column("violation");
  ASSERT_LT(std::max({agent, contact, violation}), std::ssize(runs[0]));
  std::vector<std::string> kinds;
  std::string expected;
  for (const std::string name : {"mine", "reckless"}) {
    for (const std::string touched : {"1", "0"}) {
      std::size_t found = 0;
      for (std::size_t i = 1; i < runs.size(); ++i) {
        if (runs[i][agent] != name || runs[i][violation] != "1" || runs[i][contact] != touched) continue;
        expected += "fleetproof replay d.db " + runs[i][0] + "\n";
        ++found;
      }
      if (found > 0) kinds.push_back(name + touched);
    }
  }
  EXPECT_THAT(kinds, testing::IsSupersetOf({"mine1", "mine0", "reckless1"})) << "an order of one kind shows nothing";
  EXPECT_EQ(read(path("set/replay.txt")), "# Call these in this folder.\n" + expected);
}

// The commands of REPEAT.md with the exit codes that it promises: each indented line, and the "Ends with N" behind it.
std::vector<std::pair<std::string, int>> promises_of(const std::string& page) {
  std::vector<std::pair<std::string, int>> promises;
  std::istringstream lines(page);
  std::string command;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("    ")) command = line.substr(4);
    if (command.empty() || !line.starts_with("Ends with ")) continue;
    promises.emplace_back(command, std::stoi(line.substr(10)));
    command.clear();
  }
  return promises;
}

// In another folder, with nothing but a copy of the evidence and the program.
TEST_F(EvidenceSet, IsRepeatedByFollowingItsPageAlone) {
  write("plant.json", run("generate aisle-grid --seed 3").out);
  std::filesystem::copy_file(FLEETPROOF_FAILING_AGENT, path("mine.so"));
  write(
      "e.toml",
      "seed = 7\nreplicates = 3\nhorizon_s = 120\n[factors]\nagents = [{ file = \"./mine.so\", config = "
      "\"segfault 40\" }, \"reckless\"]\nlayouts = [\"plant.json\"]\nfleet_sizes = [6]\nloss = [0.4]\ndelay_s = [2]\n");
  const auto made = run("run e.toml --db e.db");
  ASSERT_TRUE(test::has_verdict(made));
  ASSERT_EQ(run("report e.db --evidence set").exit_code, made.exit_code);
  std::filesystem::create_directory(path("later"));
  std::filesystem::rename(path("set"), path("later/set"));
  for (const char* gone : {"e.toml", "e.db", "e.sessions.jsonl", "attempts.jsonl", "plant.json", "mine.so"})
    std::filesystem::remove(path(gone));
  const auto promises = promises_of(read(path("later/set/REPEAT.md")));
  ASSERT_EQ(promises.size(), 5U);
  for (const auto& [command, exit_code] : promises) {
    const auto finished =
        shell("mkdir -p bin; ln -sf \"$FLEETPROOF\" bin/fleetproof; PATH=$PWD/bin:$PATH; cd later/set; " + command);
    EXPECT_EQ(finished.exit_code, exit_code) << command << "\n" << finished.out << finished.err;
    if (!command.ends_with("--digest")) continue;
    EXPECT_THAT(read(path("later/set/REPEAT.md")), HasSubstr("prints the digest " + finished.out.substr(0, 16) + "."));
  }
  EXPECT_EQ(promises[3].second, made.exit_code) << promises[3].first;
  const auto replayed =
      shell("PATH=$PWD/bin:$PATH; cd later/set; grep -v '^#' replay.txt | head -2 | bash -e; cat layout-1.json");
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, testing::StartsWith("REPRODUCED"));
  EXPECT_THAT(read(path("later/set/replay.txt")), HasSubstr(" --plugin plugin-1.so\n"));
}

TEST_F(EvidenceSet, HoldsTheFilesOfACommand) {
  std::filesystem::copy_file(test::source("tests/bridges/programs/twin.py"), path("twin.py"));
  write("start.sh", "#!/bin/sh\nexec \"$@\"\n");
  std::filesystem::permissions(path("start.sh"), std::filesystem::perms::owner_all);
  write("e.toml", R"(seed = 7
replicates = 2
horizon_s = 8
[factors]
agents = [{ run = "./start.sh python3 -B twin.py", way = "lockstep" }]
layouts = ["corridor-sidings"]
fleet_sizes = [2]
loss = [0.4]
delay_s = [2]
)");
  ASSERT_TRUE(test::has_verdict(run("run e.toml --db e.db")));
  run("report e.db --evidence set");
  for (const char* gone : {"twin.py", "start.sh"})
    std::filesystem::rename(path(gone), path("gone." + std::string(gone)));
  const std::string page = read(path("set/REPEAT.md"));
  EXPECT_THAT(page, HasSubstr("* `program-1-2-twin.py`: a file of the command of agent twin.\n"));
  EXPECT_THAT(page, HasSubstr("What the command of agent twin finds by itself, such as an interpreter"));
  EXPECT_THAT(page, HasSubstr("Ends with 0: every run is the same"));
  const auto verified = shell(
      "mkdir bin; ln -s \"$FLEETPROOF\" bin/fleetproof; PATH=$PWD/bin:$PATH; cd set; sha256sum -c --quiet SHA256SUMS "
      "&& " +
      promises_of(page).back().first);
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  run("report e.db --evidence other");
  const std::string without = read(path("other/REPEAT.md"));
  EXPECT_THAT(without, HasSubstr("the program of agent twin: not in this folder"));
  EXPECT_THAT(without, HasSubstr("Cannot be done without the programs"));
}

TEST_F(EvidenceSet, SaysWhatIsNotAtHandAnyMore) {
  std::filesystem::copy_file(FLEETPROOF_FAILING_AGENT, path("mine.so"));
  write("e.toml",
        "seed = 7\nreplicates = 2\nhorizon_s = 60\n[factors]\nagents = [\"./mine.so\"]\nlayouts = "
        "[\"aisle-grid\"]\nfleet_sizes = [3]\n");
  ASSERT_TRUE(test::has_verdict(run("run e.toml --db e.db")));
  std::filesystem::remove(path("mine.so"));
  write("e.toml", "# another one\n");
  run("report e.db --evidence set");
  const std::string page = read(path("set/REPEAT.md"));
  EXPECT_THAT(page, HasSubstr("the program of agent failing: not in this folder"));
  EXPECT_THAT(page, HasSubstr("e.toml was changed since"));
  EXPECT_THAT(page, HasSubstr("Cannot be done without the programs"));
  EXPECT_FALSE(std::filesystem::exists(path("set/campaign.toml")));
  write("mine.so", "another build");
  run("report e.db --evidence other");
  EXPECT_THAT(read(path("other/REPEAT.md")), HasSubstr("mine.so is not what made the results"));
  EXPECT_FALSE(std::filesystem::exists(path("other/plugin-1.so")));
}

TEST_F(EvidenceSet, NamesTheCommitOfTheProgram) {
  run("report a.db --evidence set");
  const auto identity = nlohmann::json::parse(read(path("set/identity.json")));
  const std::string commit = identity.at("engine").at("source_commit");
  EXPECT_FALSE(commit.empty());
  EXPECT_THAT(read(path("set/REPEAT.md")), HasSubstr(commit));
  EXPECT_THAT(run("--version").out, HasSubstr(commit));
}

TEST_F(EvidenceSet, IsGoneIfTheDiskIsFull) {
  for (const std::string blocks : {"4", "100"}) {  // of 1 KiB: in the first file, and in a later one
    const auto cut = shell("ulimit -f " + blocks + "; \"$FLEETPROOF\" report a.db --evidence set");
    EXPECT_EQ(cut.exit_code, 3) << blocks;
    EXPECT_THAT(cut.err, HasSubstr("cannot be written"));
    EXPECT_FALSE(std::filesystem::exists(path("set")));
    EXPECT_FALSE(std::filesystem::exists(path("set.partial")));
  }
}

TEST_F(EvidenceSet, IsNeverWrittenOverAnythingAndNeverHalf) {
  std::filesystem::create_directory(path("set"));
  const auto refused = run("report a.db --evidence set");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("there already"));
  std::filesystem::create_directory(path("mine.partial"));
  write("mine.partial/notes.txt", "mine");
  EXPECT_EQ(run("report a.db --evidence mine").exit_code, 2);
  EXPECT_EQ(read(path("mine.partial/notes.txt")), "mine");
  EXPECT_EQ(run("report a.db --evidence no/such/place").exit_code, 2);
  EXPECT_EQ(run("report a.db --evidence set2 --json").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("set2")));
}

}  // namespace
}  // namespace fleetproof::evidence_set_test
