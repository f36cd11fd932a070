// What agents note is printed with a trace, and changes nothing else.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "tests/support/program.hpp"

namespace fleetproof::noted_trace_test {
namespace {

using test::source;
using testing::HasSubstr;
using NotedTrace = test::ProgramTest;

TEST_F(NotedTrace, IsPrintedForHullLock) {
  const std::string words = "simulate '" + source("tests/scenarios/figure4.json") + "' --agent hull-lock";
  const auto traced = run(words + " --trace"), untraced = run(words);
  EXPECT_THAT(traced.err,
              testing::ContainsRegex("sent           #[0-9]+ STATE: holds [^ ]+ \\([0-9]+ bytes\\) to all"));
  EXPECT_THAT(traced.err,
              testing::ContainsRegex(
                  "received       #[0-9]+ STATE: holds [^(]* \\([0-9]+ bytes\\) from B, sent [0-9.]+, 2.000 s old"));
  EXPECT_THAT(traced.err, HasSubstr("state          idle"));
  EXPECT_THAT(traced.err, testing::ContainsRegex("believes       [A-D] was at \\(-?[0-9]+\\.[0-9][0-9], "));
  EXPECT_EQ(traced.out, untraced.out) << "with the digest";
  EXPECT_EQ(untraced.err, "");
}

// Plug-ins are loaded at run time, and their notes are the same.
TEST_F(NotedTrace, IsTheSameForAPlugin) {
  const std::string words = "simulate '" + source("tests/scenarios/figure4.json") + "' --trace --agent ";
  const auto built_in = run(words + "hull-lock");
  const auto loaded = run(words + "hull-lock-plugin --plugin '" FLEETPROOF_PLUGIN "'");
  EXPECT_THAT(loaded.err,
              testing::ContainsRegex("sent           #[0-9]+ STATE: holds [^ ]+ \\([0-9]+ bytes\\) to all"));
  EXPECT_EQ(built_in.err, loaded.err);
}

}  // namespace
}  // namespace fleetproof::noted_trace_test
