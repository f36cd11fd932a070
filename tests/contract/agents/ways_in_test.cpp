// A fleet with a server does the same whatever the way in: built in, as a shared object, or as processes.
#include <gmock/gmock.h>

#include <map>
#include <string>

#include "storage/archive_reader.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::ways_in_test {
namespace {

std::string beside_tests(const std::string& name) {
  const std::filesystem::path file(FLEETPROOF_TALKING_AGENT);
  return (file.parent_path() / name).string();
}
const std::string kPair = beside_tests("../core/agents/libfleetproof_central_plugin.so");

std::string process(const std::string& command) { return "{ run = \"" + command + "\", way = \"lockstep\" }"; }
const std::string kHosted = process(beside_tests("lockstep_host") + " " + kPair);

std::string in_python(const std::string& example) {
  return process("env PYTHONPATH=" + test::source("core/sdk/python") + " python3 -B " +
                 test::source("tests/examples/" + example));
}

class WaysIn : public test::ProgramTest {
 protected:
  // Where lanes bend, cross and run close to each other, with everything that goes wrong; with calls that cost nothing,
  // and with calls that take time.
  void campaign(const std::string& file, const std::string& vehicle, const std::string& computer) const {
    write(file, R"(kind = "search"
seed = 3
replicates = 2
horizon_s = 120
[factors]
agents = [{ name = "candidate", vehicle = )" +
                    vehicle + ", computer = " + computer + R"( }]
layouts = ["random-planar/stress", "plant/stress"]
fleet_sizes = [3]
loss = [0.3]
delay_s = [2]
call_cost_s = [0, 0.002]
[[computers]]
name = "server"
[computers.faults]
restarts_per_hour = 30
restart_s = 2
disk_losses_per_hour = 10
disk_loss_s = 2
[world]
transports = "open"
withdrawn_share = 0.2
transports_per_agv_hour = 240
[faults]
restarts_per_agv_hour = 20
freezes_per_agv_hour = 20
)");
  }
  using Outcomes = std::map<std::uint64_t, Outcome>;
  Outcomes outcomes(const std::string& vehicle, const std::string& computer) const {
    campaign("c.toml", vehicle, computer);
    EXPECT_TRUE(test::has_verdict(run("run c.toml --db c.db --overwrite --jobs 1")));
    Outcomes found;
    ArchiveReader(path("c.db")).for_each_run([&](const RunRecord& run) { found[run.run_index] = run.outcome; });
    return found;
  }
  // Of a fleet to which much happens.
  Outcomes worked(const std::string& vehicle, const std::string& computer) const {
    const Outcomes found = outcomes(vehicle, computer);
    EXPECT_EQ(found.size(), 8U);
    std::uint64_t done = 0, drives = 0, faults = 0;
    for (const auto& [run, outcome] : found) {
      EXPECT_EQ(outcome.message, "");
      done += outcome.counters.transports_done;
      drives += outcome.counters.drives;
      faults += outcome.counters.faults;
    }
    EXPECT_GT(done, 1U);
    EXPECT_GT(drives, 50U);
    EXPECT_GT(faults, 20U);
    return found;
  }
  static void expect_equal(const Outcomes& found, const Outcomes& expected, const std::string& way) {
    SCOPED_TRACE(way);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [run, outcome] : found) {
      EXPECT_EQ(outcome.message, "");
      EXPECT_EQ(outcome.digest, expected.at(run).digest) << "run " << run;
    }
  }
};

TEST_F(WaysIn, HaveEqualTraces) {
  const auto built_in = worked("\"follower\"", "\"zone-server\"");
  const std::string object = "\"" + kPair + "\"";
  expect_equal(outcomes(object, object), built_in, "object");
  expect_equal(outcomes(kHosted, kHosted), built_in, "processes in C++");
  expect_equal(outcomes(in_python("follower.py"), "\"zone-server\""), built_in, "vehicles in Python");
}

TEST_F(WaysIn, TheExampleOfAFleetHasEqualTraces) {
  const std::string callbacks = "\"" + beside_tests("depot.so") + "\"";
  const std::string straight = "\"" + beside_tests("depot_straight.so") + "\"", python = in_python("depot.py");
  const auto expected = worked(callbacks, callbacks);
  expect_equal(outcomes(straight, straight), expected, "straight-line code");
  expect_equal(outcomes(python, python), expected, "Python");
}

TEST_F(WaysIn, ProcessesGiveTheSameBytesWithAnyNumberOfWorkers) {
  campaign("c.toml", kHosted, "\"zone-server\"");
  for (const std::string jobs : {"1", "2", "7"})
    ASSERT_TRUE(test::has_verdict(run("run c.toml --db " + jobs + ".db --jobs " + jobs)));
  EXPECT_EQ(read(path("1.db")), read(path("2.db")));
  EXPECT_EQ(read(path("1.db")), read(path("7.db")));
}

}  // namespace
}  // namespace fleetproof::ways_in_test
