// Standard streams that are full, closed or left: no result is lost in silence, and talk stops no campaign.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::streams_test {
namespace {

using testing::HasSubstr;

class Streams : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml",
          "horizon_s = 20\nreplicates = 3\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes "
          "= [3]\n");
    expected_ = run("run a.toml --db expected.db");
    ASSERT_THAT(expected_.exit_code, testing::AnyOf(1, 4)) << expected_.err;
  }
  void expect_same_archive(const std::string& name) const {
    EXPECT_TRUE(read(path(name)) == read(path("expected.db"))) << name;
    EXPECT_TRUE(read(path("expected.db")).starts_with("SQLite format 3"));
  }
  test::Finished expected_;
};

TEST_F(Streams, TalkThatCannotBeWrittenStopsNoCampaign) {
  for (const std::string to : {"2>/dev/full", "2>&-", "2> >(exec true)"}) {
    const auto finished = shell("\"$FLEETPROOF\" run a.toml --db a.db --overwrite " + to);
    EXPECT_EQ(finished.exit_code, expected_.exit_code) << to;
    EXPECT_THAT(finished.out, HasSubstr("fleetproof report:")) << to;
    expect_same_archive("a.db");
  }
}

// A reader that reads nothing: the pipe is full before the first word.
TEST_F(Streams, TalkThatNobodyReadsStopsNoCampaign) {
  const auto finished = shell(
      "mkfifo full; exec 3<>full; dd if=/dev/zero of=full oflag=nonblock bs=4096 count=64 2>/dev/null\n"
      "timeout 30 \"$FLEETPROOF\" run a.toml --db a.db 2>&3");
  EXPECT_EQ(finished.exit_code, expected_.exit_code);
  expect_same_archive("a.db");
}

TEST_F(Streams, ClosedStreamsAreNotTakenForFiles) {
  for (const std::string closed : {"<&-", "2>&-", "<&- 2>&-"}) {
    EXPECT_EQ(shell("\"$FLEETPROOF\" run a.toml --db a.db --overwrite " + closed).exit_code, expected_.exit_code)
        << closed;
    expect_same_archive("a.db");
  }
  for (const std::string closed : {">&-", "<&- >&-", "<&- >&- 2>&-"}) {
    EXPECT_EQ(shell("\"$FLEETPROOF\" run a.toml --db a.db --overwrite " + closed).exit_code, 3) << closed;
    expect_same_archive("a.db");  // the results are there, only the report was lost
  }
}

TEST_F(Streams, DataThatCannotBeWrittenIsExit3) {
  ASSERT_EQ(run("replay expected.db 0 --scenario s.json").exit_code, 0);
  ASSERT_EQ(run("run a.toml --shard 1/1 --out shards").exit_code, 0);
  const std::vector<std::string> verbs = {"run a.toml --shard 1/1 --out shards",
                                          "merge shards --db b.db --overwrite",
                                          "merge shards --db b.db --overwrite --json",
                                          "missing shards",
                                          "missing shards --array",
                                          "missing shards --json",
                                          "run a.toml --db b.db --overwrite",
                                          "run a.toml --db b.db --overwrite --json",
                                          "report expected.db",
                                          "report expected.db --format json",
                                          "report expected.db --digest",
                                          "report expected.db --digest --json",
                                          "verify expected.db",
                                          "verify expected.db --json",
                                          "plan a.toml",
                                          "plan a.toml --json",
                                          "sensitivity a.toml --runs 1 --agent wraps-at-256",
                                          "sensitivity a.toml --runs 1 --agent wraps-at-256 --json",
                                          "new campaign",
                                          "replay expected.db 0",
                                          "replay expected.db 0 --json",
                                          "replay expected.db 0 --html h.html",
                                          "replay expected.db 0 --at 2.5 --svg h.svg",
                                          "simulate s.json --agent reckless",
                                          "simulate s.json --json",
                                          "simulate s.json --html h.html",
                                          "simulate s.json --at 2.5 --svg h.svg --json",
                                          "generate fishbone",
                                          "import opentcs '" + test::source("tests/layouts/crossdock.xml") + "'",
                                          "import s.json --svg h.svg",
                                          "check a.toml",
                                          "check s.json",
                                          "evidence",
                                          "evidence clopper-pearson --failing 3 --units 1000",
                                          "evidence clopper-pearson --failing 3 --units 1000 --json",
                                          "list agents",
                                          "list laws --json",
                                          "--help",
                                          "run --help",
                                          "--version"};
  for (const auto& words : verbs) {
    const auto full = shell("\"$FLEETPROOF\" " + words + " >/dev/full");
    EXPECT_EQ(full.exit_code, 3) << words;
    EXPECT_THAT(full.err, HasSubstr("standard output: cannot be written to its end (No space left on device)"))
        << words;
    EXPECT_EQ(shell("\"$FLEETPROOF\" " + words + " >&-").exit_code, 3) << words;
  }
  expect_same_archive("b.db");
  // Nothing to write: nothing is lost.
  EXPECT_EQ(shell("\"$FLEETPROOF\" generate fishbone -o f.json >/dev/full").exit_code, 0);
}

// The page is a file: streams that are full or closed take nothing from it.
TEST_F(Streams, APageIsWrittenWhateverTheStreamsAre) {
  const int exit_code = run("report expected.db").exit_code;
  for (const std::string to : {">/dev/full", ">&-", "2>/dev/full", "2>&-", "<&- >&- 2>&-"}) {
    const auto finished = shell("rm -f p.html; \"$FLEETPROOF\" report expected.db --html p.html " + to);
    EXPECT_EQ(finished.exit_code, exit_code) << to << finished.err;
    EXPECT_TRUE(read(path("p.html")).ends_with("</html>\n")) << to;
  }
  const auto cut = shell("rm -f p.html; ulimit -f 4; \"$FLEETPROOF\" report expected.db --html p.html");
  EXPECT_EQ(cut.exit_code, 3) << cut.err;
  EXPECT_THAT(cut.err, HasSubstr("p.html: cannot be written (File too large)"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "p.html"));
}

// Page and picture of one run: the same bytes as with open streams, whole or not at all.
TEST_F(Streams, PageAndPictureOfARunAreWrittenWhateverTheStreamsAre) {
  for (const std::string verb : {"replay expected.db 0", "simulate s.json"}) {
    ASSERT_TRUE(test::has_verdict(run("replay expected.db 0 --scenario s.json")));
    const std::string words = "\"$FLEETPROOF\" " + verb + " --html h.html --at 2.5 --svg h.svg ";
    const int exit_code = shell(words).exit_code;
    const std::string page = read(path("h.html")), picture = read(path("h.svg"));
    ASSERT_TRUE(page.ends_with("</html>\n") && picture.ends_with("</svg>\n")) << verb;
    for (const auto& [to, expected] : {std::pair(">/dev/full", 3),
                                       {">&-", 3},
                                       {"2>/dev/full", exit_code},
                                       {"2>&-", exit_code},
                                       {"<&- >&- 2>&-", 3},
                                       {"| true; exit ${PIPESTATUS[0]}", 3}}) {
      const auto finished = shell("rm -f h.html h.svg; " + words + to);
      EXPECT_EQ(finished.exit_code, expected) << verb << to << finished.err;
      EXPECT_TRUE(read(path("h.html")) == page && read(path("h.svg")) == picture) << verb << to;
    }
    for (const auto& [option, file] : {std::pair("--html h.html", "h.html"), {"--at 2.5 --svg h.svg", "h.svg"}}) {
      const auto cut = shell("rm -f h.html h.svg; ulimit -f 4; \"$FLEETPROOF\" " + verb + " " + option);
      EXPECT_EQ(cut.exit_code, 3) << cut.err;
      EXPECT_THAT(cut.err, HasSubstr(std::string(file) + ": cannot be written (File too large)"));
      EXPECT_FALSE(std::filesystem::exists(folder_ / file));
    }
  }
}

TEST_F(Streams, AReaderThatLeavesEndsTheVerbQuietly) {
  const auto finished =  // the reader is gone before the first word, on a busy machine, too
      shell("{ sleep 0.5; \"$FLEETPROOF\" report expected.db; echo $? >code; } | true; cat code");
  EXPECT_EQ(finished.out, "3\n");
  EXPECT_EQ(finished.err, "");
}

TEST_F(Streams, AFileSizeLimitIsAnErrorAndNoSignal) {
  const auto finished = shell("ulimit -f 4; \"$FLEETPROOF\" generate fishbone -o f.json");
  EXPECT_EQ(finished.exit_code, 3) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("f.json: cannot be written (File too large)"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.json"));
  EXPECT_EQ(std::ranges::count_if(
                std::filesystem::directory_iterator(folder_),
                [](const auto& entry) { return entry.path().filename().string().starts_with(".fleetproof"); }),
            0);
}

TEST_F(Streams, AClosedTerminalInterruptsAsAnySignal) {
  write("long.toml",
        "horizon_s = 600\nreplicates = 100000\n[factors]\nagents = [\"hull-lock\"]\nlayouts = "
        "[\"aisle-grid\"]\nfleet_sizes = [5]\n");
  const auto finished = shell("\"$FLEETPROOF\" run long.toml --db long.db & sleep 1; kill -HUP $!; wait $!");
  EXPECT_EQ(finished.exit_code, 129) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("INCOMPLETE"));
}

}  // namespace
}  // namespace fleetproof::streams_test
