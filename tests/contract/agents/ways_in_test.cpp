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
  std::map<std::uint64_t, Outcome> outcomes(const std::string& vehicle, const std::string& computer) const {
    campaign("c.toml", vehicle, computer);
    EXPECT_TRUE(test::has_verdict(run("run c.toml --db c.db --overwrite --jobs 1")));
    std::map<std::uint64_t, Outcome> found;
    ArchiveReader(path("c.db")).for_each_run([&](const RunRecord& run) { found[run.run_index] = run.outcome; });
    return found;
  }
};

TEST_F(WaysIn, HaveEqualTraces) {
  const auto built_in = outcomes("\"follower\"", "\"zone-server\"");
  ASSERT_EQ(built_in.size(), 8U);
  std::uint64_t done = 0, faults = 0;
  for (const auto& [run, outcome] : built_in) {
    EXPECT_TRUE(outcome.message.empty()) << outcome.message;
    done += outcome.counters.transports_done;
    faults += outcome.counters.faults;
  }
  EXPECT_GT(done, 10U);
  EXPECT_GT(faults, 20U);
  const auto is_same = [&](const std::string& vehicle, const std::string& computer) {
    SCOPED_TRACE(vehicle);
    for (const auto& [run, outcome] : outcomes(vehicle, computer)) {
      EXPECT_EQ(outcome.message, "");
      EXPECT_EQ(outcome.digest, built_in.at(run).digest) << "run " << run;
    }
  };
  const std::string object = "\"" + kPair + "\"";
  is_same(object, object);
  is_same(kHosted, kHosted);
  is_same(in_python("follower.py"), "\"zone-server\"");
}

TEST_F(WaysIn, TheExampleOfAFleetHasEqualTraces) {
  const std::string callbacks = "\"" + beside_tests("depot.so") + "\"";
  const auto expected = outcomes(callbacks, callbacks);
  const std::string straight = "\"" + beside_tests("depot_straight.so") + "\"", python = in_python("depot.py");
  for (const std::string& way : {straight, python}) {
    SCOPED_TRACE(way);
    for (const auto& [run, outcome] : outcomes(way, way)) {
      EXPECT_EQ(outcome.message, "");
      EXPECT_EQ(outcome.digest, expected.at(run).digest) << "run " << run;
    }
  }
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
