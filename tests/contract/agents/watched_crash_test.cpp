// Traces, pages and files of runs whose agent crashes or hangs, without a recording: it ends its run, not the program.
#include <gmock/gmock.h>

#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::watched_crash_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class WatchedCrash : public test::AuditedCampaign {
 protected:
  // The scenario of the first run, whose agent fails at its third event.
  void write_case(const std::string& kind) const {
    write_campaign(test::failing(kind + " 1"), 1, 0.0, "[limits]\ncpu_s = 0.1\n");
    EXPECT_TRUE(test::has_verdict(run("run c.toml --db " + kind + ".db")));
    EXPECT_EQ(run("replay " + kind + ".db 0 --scenario " + kind + ".json").exit_code, 0);
  }
  static constexpr const char* kFiles =
      " --html page.html --chrome-trace chrome.json --pieces pieces.json --trace-output trace.txt";
};

TEST_F(WatchedCrash, OfAScenarioIsShown) {
  write_case("segfault");
  const auto plain = run("simulate segfault.json --plugin failing.so");
  EXPECT_EQ(plain.exit_code, 1) << "another AGV breaks the distance" << plain.err;
  EXPECT_THAT(plain.out, AllOf(HasSubstr("segmentation fault (SIGSEGV) in event"), HasSubstr("of AGV 0")));
  const auto watched = run("simulate segfault.json --plugin failing.so" + std::string(kFiles));
  EXPECT_EQ(watched.out, plain.out);
  EXPECT_THAT(read(path("trace.txt")), HasSubstr("AGV 0  agent crashed"));
  EXPECT_THAT(read(path("page.html")), AllOf(HasSubstr("SIGSEGV"), HasSubstr("</html>")));
  for (const char* file : {"chrome.json", "pieces.json"})
    EXPECT_FALSE(nlohmann::json::parse(read(path(file))).empty()) << file;
}

TEST_F(WatchedCrash, InADebuggerItIsReal) {
  write_case("segfault");
  for (const char* words : {"simulate segfault.json --plugin failing.so", "replay segfault.db 0"})
    EXPECT_THAT(run(words + std::string(" --in-process")).exit_code, testing::AnyOf(139, -1)) << words;
}

// Its agents passed all audits, so the file has no recording of what they did.
TEST_F(WatchedCrash, OfACampaignIsShown) {
  for (const std::string kind : {"segfault", "loop"}) {
    write_case(kind);
    const auto plain = run("replay " + kind + ".db 0 --plugin failing.so");
    const auto watched = run("replay " + kind + ".db 0 --plugin failing.so" + kFiles);
    EXPECT_EQ(watched.exit_code, 0) << watched.err;
    EXPECT_THAT(watched.out, HasSubstr("REPRODUCED"));
    EXPECT_EQ(watched.out, plain.out);
    EXPECT_THAT(read(path("trace.txt")), HasSubstr("AGV 1  ends"));
    EXPECT_THAT(read(path("page.html")), HasSubstr("</html>"));
  }
}

TEST_F(WatchedCrash, ThatComesAnywhereIsRefused) {
  write_case("segfault");
  const auto refused =
      shell("export FLEETPROOF_TEST_LOADING=crash; \"$FLEETPROOF\" simulate segfault.json --plugin failing.so");
  EXPECT_EQ(refused.exit_code, 2) << refused.out << refused.err;
  EXPECT_THAT(refused.err, Not(HasSubstr("internal")));
}

}  // namespace
}  // namespace fleetproof::watched_crash_test
