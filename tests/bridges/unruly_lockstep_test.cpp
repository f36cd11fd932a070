// What becomes of a program that breaks the protocol of lockstep.
#include <stdexcept>

#include "tests/bridges/lockstep_bench.hpp"

namespace fleetproof::unruly_lockstep_test {
namespace {

using lockstep::LockstepProgram;
using testing::ElementsAre;
using testing::HasSubstr;

struct Case {
  std::string how, sentence;
};

class Unruly : public testing::TestWithParam<Case> {};

// All that it hosts: two AGVs.
TEST_P(Unruly, CrashesAllThatItHosts) {
  const LockstepProgram program(test::python("unruly.py", GetParam().how));
  const test::ToldRun first = test::run_of(program);
  EXPECT_TRUE(first.outcome.crash);
  EXPECT_FALSE(first.outcome.hang);
  EXPECT_THAT(first.outcome.message, HasSubstr("agent of agv-1: the lockstep program " + GetParam().sentence));
  const auto crashes =
      std::ranges::count_if(first.trace, [](const auto& line) { return std::get<2>(line) == TraceKind::AgentCrashed; });
  EXPECT_EQ(crashes, 2);
}

// The next run finds a new process, in which the same happens.
TEST(UnrulyLockstep, CrashesInEachRunAndInItsRecording) {
  const LockstepProgram program(test::python("unruly.py", "no-json"));
  const test::ToldRun first = test::run_of(program);
  test::expect_same(test::run_of(program), first);
  const test::ToldRun recorded = test::recorded(test::row_of_tens({0, 3}, 5.0), program.type());
  test::expect_same(recorded, first);
  test::expect_same(test::played(test::row_of_tens({0, 3}, 5.0), recorded.tape), first);
}

INSTANTIATE_TEST_SUITE_P(
    Lines, Unruly,
    testing::Values(
        Case{"no-json", R"(sent a line that is no JSON object: "starting up ...")"},
        Case{"no-object", R"(sent a line that is no JSON object: "[1, 2]")"},
        Case{"no-calls", R"(sent a line without "calls": "{"call": []}")"},
        Case{"unknown-call", R"(made an unknown call: "["fly",3]")"},
        Case{"wrong-argument", R"(made a call whose argument 1 is no number from 0 on: "["move",-1]")"},
        Case{"missing-argument", R"(made a call whose argument 2 is missing: "["set_timer",1]")"},
        Case{"no-kind", R"(made a call whose argument 1 has no "kind": "["describe")"},
        Case{"unknown-field", R"(made a call whose argument 1 has an unknown field, "anwsers": "["describe")"},
        Case{"no-byte", "made a call whose argument 1 has a character above U+00FF"},
        Case{"calls-no-list", R"(has calls that are no list in the line "{"calls": 3}")"},
        Case{"unknown-ask", R"(made an unknown call: "["fly"]" in the line "{"ask": ["fly"]}")"},
        Case{"deep", R"(sent lists in lists, more than 64 deep: "{"calls": [[[)"},
        Case{"no-utf8", "sent a line that is no JSON object"}, Case{"exit", "ended with exit code 3"},
        Case{"signal", "ended with a signal: Aborted"}, Case{"close", "closed its standard input or output"},
        Case{"half-a-line", R"(ended in the middle of a line: "{"calls"")"},
        Case{"long", "sent more than 16 MB without a line feed"}, Case{"leave-a-child", "ended with exit code 0"}),
    [](const auto& one) {
      std::string name = one.param.how;
      std::erase(name, '-');
      return name;
    });

TEST(UnrulyLockstep, WhatComesAfterAWholeAnswerIsFiledAtTheNextEvent) {
  for (const Case& after : {Case{"two-lines", "sent a line that nothing had asked for: \"{\"calls\": []}"},
                            Case{"flood", "sent a line that nothing had asked for: \"{\"calls\": []}"},
                            Case{"close-input", "closed its standard input or output"}}) {
    const LockstepProgram program(test::python("unruly.py", after.how));
    EXPECT_THAT(test::run_of(program).outcome.message, HasSubstr(after.sentence)) << after.how;
  }
}

TEST(UnrulyLockstep, HasTheThreeStandardStreamsAndNoOtherFile) {
  const LockstepProgram program(test::python("unruly.py", "other-descriptors"));
  EXPECT_THAT(test::logged(test::run_of(program)), ElementsAre("0"));
}

TEST(UnrulyLockstep, AWrongAnswerToByeIsFiledOnce) {
  const LockstepProgram program(test::python("unruly.py", "no-bye"));
  for (int run = 0; run < 2; ++run) {
    const Outcome outcome = test::run_of(program, test::row_of_tens({0}, 1.5)).outcome;
    EXPECT_TRUE(outcome.crash);
    EXPECT_THAT(outcome.message, HasSubstr("does not answer bye with bye"));
  }
}

// The other AGV drives on: a participant has failed, not the program.
TEST(UnrulyLockstep, AParticipantMayFailByItself) {
  const LockstepProgram crash(test::python("unruly.py", "fail")), hang(test::python("unruly.py", "fail-hang"));
  const Outcome crashed = test::run_of(crash).outcome, hung = test::run_of(hang).outcome;
  EXPECT_EQ(crashed.message, "agent of agv-1: the battery is on fire");
  EXPECT_TRUE(crashed.crash && !crashed.hang);
  EXPECT_EQ(crashed.counters.drives, 0U) << "no call counts after it";
  EXPECT_EQ(hung.message, "agent of agv-1: it does not come back");
  EXPECT_TRUE(hung.hang && !hung.crash);
}

TEST(UnrulyLockstep, WhatIsRefusedUnaskedComesBackAtTheSameInstant) {
  const LockstepProgram program(test::python("unruly.py", "refused"));
  const test::ToldRun run = test::run_of(program, test::row_of_tens({0}, 0.5));
  EXPECT_THAT(test::logged(run), ElementsAre(R"([{"call": 0, "name": "move", "result": "invalid"}, )"
                                             R"({"call": 2, "name": "send_unicast", "result": "invalid"}])"));
  EXPECT_EQ(run.outcome.counters.drives, 1U);
  EXPECT_EQ(run.outcome.counters.activations, 1U);
}

TEST(UnrulyLockstep, IsRefusedWhereItStarts) {
  const auto why_not = [](const std::string& command) -> std::string {
    try {
      const LockstepProgram program(command);
      return "";
    } catch (const std::runtime_error& refused) {
      return refused.what();
    }
  };
  EXPECT_THAT(why_not("/no/such/program --fast"), HasSubstr("cannot be started: /no/such/program: No such file"));
  EXPECT_THAT(why_not(test::python("unruly.py", "no-hello")), HasSubstr("does not answer hello with hello"));
  EXPECT_THAT(why_not(test::python("unruly.py", "other-version")), HasSubstr("speaks another version of lockstep"));
  EXPECT_THAT(why_not(test::python("unruly.py", "ends-at-once")), HasSubstr("ended with exit code 1"));
}

// ---- which process hosts what

TEST(LockstepProcess, HostsAllAndServesRunAfterRunUntilItIsRenewed) {
  LockstepProgram program(test::python("unruly.py", "pid"));
  const auto pids = [&] { return test::logged(test::run_of(program, test::row_of_tens({0, 3}, 0.5))); };
  const auto first = pids();
  ASSERT_EQ(first.size(), 4U);
  EXPECT_EQ(first[0], first[2]) << "one for both AGVs";
  EXPECT_EQ(pids(), first);
  program.renew();
  EXPECT_NE(pids(), first);
}

TEST(LockstepProcess, IsOneEachIfItsCommandNamesTheParticipant) {
  const LockstepProgram program(test::python("unruly.py", "pid {agv} '{name}'"));
  const auto lines = test::logged(test::run_of(program, test::row_of_tens({0, 3}, 0.5)));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_NE(lines[0], lines[2]);
  EXPECT_THAT(lines[1], testing::StartsWith("0 "));
  EXPECT_THAT(lines[3], testing::StartsWith("1 "));
}

TEST(LockstepProcess, IsNewForEachRunIfItsCommandNamesTheSeedOrItAsksForThat) {
  for (const std::string more : {"pid {seed}", "one-run"}) {
    const LockstepProgram program(test::python("unruly.py", more));
    EXPECT_FALSE(test::run_of(program, test::row_of_tens({0}, 0.5)).outcome.crash);
    EXPECT_FALSE(test::run_of(program, test::row_of_tens({0}, 0.5)).outcome.crash);
  }
  const LockstepProgram program(test::python("unruly.py", "pid {seed}"));
  const auto one = test::logged(test::run_of(program, test::row_of_tens({0}, 0.5)));
  const auto other = test::logged(test::run_of(program, test::row_of_tens({0}, 0.5)));
  EXPECT_NE(one.front(), other.front());
  EXPECT_EQ(one.back(), other.back()) << "the seed of the same run";
  EXPECT_EQ(one.back().size(), 16U);
}

}  // namespace
}  // namespace fleetproof::unruly_lockstep_test
