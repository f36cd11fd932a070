// A program that speaks lockstep, from the campaign file to the trace of a run.
#include <gmock/gmock.h>

#include <optional>

#include "storage/archive_reader.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::lockstep_campaign_test {
namespace {

using testing::HasSubstr;

class LockstepCampaign : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    for (const std::string script : {"twin.py", "unruly.py"})
      std::filesystem::copy_file(test::source("tests/bridges/programs/" + script), path(script));
  }
  test::Finished campaign(const std::string& agents, int replicates = 2) {
    write("c.toml", "name = \"c\"\nkind = \"search\"\nreplicates = " + std::to_string(replicates) +
                        "\nhorizon_s = 8\n[factors]\nagents = [" + agents +
                        "]\nlayouts = [\"corridor-sidings\"]\nfleet_sizes = [2]\nloss = [0.4]\ndelay_s = [2]\n");
    return run("run c.toml --db c.db --overwrite --jobs 1");
  }
};

TEST_F(LockstepCampaign, RunsReplaysAndIsWatched) {
  const auto finished = campaign(R"({ run = "python3 -B twin.py", way = "lockstep", name = "candidate" })");
  ASSERT_TRUE(test::has_verdict(finished));
  EXPECT_THAT(run("replay c.db 1").out, HasSubstr("REPRODUCED"));
  ASSERT_EQ(run("replay c.db 0 --scenario s.json").exit_code, 0);
  const auto traced = run("simulate s.json --plugin 'lockstep:python3 -B twin.py' --trace");
  ASSERT_TRUE(test::has_verdict(traced));
  EXPECT_THAT(traced.out, HasSubstr("woke"));
  write("twin.py", read(path("twin.py")) + "\n# another build\n");
  EXPECT_THAT(run("replay c.db 1").err, HasSubstr("is not the one of the campaign"));
}

TEST_F(LockstepCampaign, AProgramThatBreaksItsProtocolCostsItsRuns) {
  const auto finished = campaign(R"({ run = "python3 -B unruly.py no-json", way = "lockstep" }, "reckless")");
  ASSERT_TRUE(test::has_verdict(finished));
  EXPECT_THAT(run("report c.db").out, HasSubstr("the lockstep program sent a line that is no JSON object"));
  const auto checked = run("check c.toml");
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_THAT(checked.err, HasSubstr("warning: c.toml: \"unruly\" crashed or hung in "));
  EXPECT_THAT(checked.err, HasSubstr("the lockstep program sent a line that is no JSON object"));
}

// The simplest relative of hull-lock, among lost and late messages and restarts.
TEST_F(LockstepCampaign, TheExampleThatLocksLanesKeepsItsDistanceAndDelivers) {
  std::filesystem::copy_file(test::source("tests/examples/lane_lock.py"), path("lane_lock.py"));
  write("c.toml",
        "name = \"c\"\nkind = \"search\"\nreplicates = 6\nhorizon_s = 100\n[factors]\nagents = [{ run = \"env "
        "'PYTHONPATH=" +
            test::source("core/sdk/python") + R"(' python3 -B lane_lock.py", way = "lockstep" }]
layouts = ["random-planar"]
fleet_sizes = [3]
loss = [0.4]
delay_s = [2]
[world]
transports_per_agv_hour = 60
[faults]
restarts_per_agv_hour = 60
)");
  ASSERT_TRUE(test::has_verdict(run("run c.toml --db c.db")));
  std::uint64_t done = 0, faults = 0;
  ArchiveReader(path("c.db")).for_each_run([&](const RunRecord& run) {
    EXPECT_FALSE(run.outcome.violation || run.outcome.crash) << run.run_index << run.outcome.message;
    done += run.outcome.counters.transports_done;
    faults += run.outcome.counters.faults;
  });
  EXPECT_GT(done, 0U);
  EXPECT_GT(faults, 10U);
}

// Audits have new processes, and look closer at runs that differ in them.
TEST_F(LockstepCampaign, DependenceOnEarlierRunsIsCalledThat) {
  const auto tried = [&](const std::string& how) {
    ASSERT_TRUE(test::has_verdict(campaign(R"({ run = "python3 -B unruly.py )" + how + R"(", way = "lockstep" })", 3)));
  };
  tried("keep-state");
  EXPECT_THAT(run("report c.db").out,
              HasSubstr("depends on earlier runs | agent unruly: this software depends on earlier runs of the same"));
  EXPECT_THAT(run("report c.db --format json").out, HasSubstr("\"depends_on_earlier_runs\": true"));
  EXPECT_THAT(read(path("c.sessions.jsonl")), HasSubstr(R"({"unruly":{"dependent":2,"other":0}})"));
  tried("draw");
  EXPECT_THAT(run("report c.db").out, HasSubstr("not deterministic | agent unruly: this software is not determ"));
}

// The main process plays what a worker hands on in pieces.
TEST_F(LockstepCampaign, ATapeOfManyPiecesIsPlayed) {
  ASSERT_TRUE(test::has_verdict(campaign(R"({ run = "python3 -B unruly.py talk", way = "lockstep" })")));
  const auto traced = run("replay c.db 1 --trace --trace-output t.txt --html p.html");
  EXPECT_THAT(traced.out, HasSubstr("REPRODUCED"));
  EXPECT_THAT(read(path("t.txt")), HasSubstr("word 99 of event 9"));
  EXPECT_GT(std::filesystem::file_size(path("t.txt")), 500'000U);
}

// A Python program on the computer and on board, from the campaign to the smallest case of a failure.
TEST_F(LockstepCampaign, AFleetWithAComputerIsReplayedAndShrunk) {
  std::filesystem::copy_file(test::source("core/sdk/python/starting/master.py"), path("master.py"));
  const std::string python =
      "{ run = \"env 'PYTHONPATH=" + test::source("core/sdk/python") + "' python3 -B master.py\", way = \"lockstep\" }";
  write("c.toml", "name = \"c\"\nkind = \"search\"\nreplicates = 2\nhorizon_s = 60\n[factors]\nagents = [{ vehicle = " +
                      python + ", computer = " + python + R"(, name = "mine" }]
layouts = ["aisle-grid"]
fleet_sizes = [4]
loss = [0.2]
delay_s = [1]
[world]
transports = "open"
transports_per_agv_hour = 120
[[computers]]
name = "server"
[computers.faults]
restarts_per_hour = 60
)");
  ASSERT_TRUE(test::has_verdict(run("run c.toml --db c.db --jobs 2")));
  std::optional<std::uint64_t> failed;
  std::uint64_t restarts = 0;
  ArchiveReader(path("c.db")).for_each_run([&](const RunRecord& run) {
    EXPECT_FALSE(run.outcome.crash) << run.outcome.message;
    if (run.outcome.violation && !failed) failed = run.run_index;
    restarts += run.outcome.counters.faults;
  });
  ASSERT_TRUE(failed) << "nobody asks before it drives";
  EXPECT_GT(restarts, 0U);
  EXPECT_THAT(run("report c.db").out, HasSubstr("Agent mine: 2 runs were audited, and every one came out the same."));
  EXPECT_THAT(run("replay c.db " + std::to_string(*failed) + " --trace").out, HasSubstr("REPRODUCED"));
  const auto shrunk = run("shrink c.db " + std::to_string(*failed) + " --output s.json --max-trials 10");
  EXPECT_EQ(shrunk.exit_code, 0) << shrunk.out << shrunk.err;
  ASSERT_EQ(run("replay c.db 0 --scenario s.json").exit_code, 0);
  const std::string both = "\"lockstep:env 'PYTHONPATH=" + test::source("core/sdk/python") + "' python3 -B master.py\"";
  EXPECT_TRUE(test::has_verdict(run("simulate s.json --agent " + both + " --computer server=" + both)));
}

TEST_F(LockstepCampaign, WhatIsWrongIsNamed) {
  const auto refused = [&](const std::string& agent, const std::string& sentence) {
    const auto finished = campaign(agent);
    EXPECT_EQ(finished.exit_code, 2) << agent;
    EXPECT_THAT(finished.err, HasSubstr(sentence)) << agent;
  };
  refused(R"({ run = "python3 twin.py" })", "run needs a way: way = \"lockstep\"");
  refused(R"({ run = "python3 twin.py", way = "socket" })", "\"socket\"");
  refused(R"({ way = "lockstep" })", "way says how the command in run is spoken to");
  refused(R"({ run = "python3 twin.py", way = "lockstep", file = "a.so" })", "either run = \"...\" or file = \"...\"");
  refused(R"({ run = "python3 'twin.py", way = "lockstep" })", "has a quote that does not end");
  refused(R"({ run = "./twin {avg}", way = "lockstep" })", "has {avg}, which means nothing");
  refused(R"({ run = "no-such-program-anywhere", way = "lockstep" })", "cannot be started: no-such-program-anywhere");
  refused(R"({ run = "python3 -B unruly.py ends-at-once", way = "lockstep" })", "ended with exit code 1");
  write("lost.py", "import no_such_module_anywhere\n");
  refused(R"({ run = "python3 -B lost.py", way = "lockstep" })",
          "ended with exit code 1: ModuleNotFoundError: No module named 'no_such_module_anywhere'");
}

}  // namespace
}  // namespace fleetproof::lockstep_campaign_test
