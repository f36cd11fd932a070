// Sentences that claim too much, or hide what a reader needs. No format may contain one.
#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "tests/support/program.hpp"
#include "tests/support/synthetic_archive.hpp"

namespace fleetproof::wording_traps_test {
namespace {

// A trap, as a pattern, and a sentence that falls into it.
struct Trap {
  const char *pattern, *bad;
};
const std::vector<Trap> kTraps = {
    {R"(\bpro(ve[dns]?|of)\b)", "hull-lock is proved safe"},
    {R"(\bno collisions?\b|\bcollision[- ]free\b|\bcannot collide\b)", "no collisions possible"},
    {R"(\bcollision-free\b)", "the fleet is collision-free"},
    // The lower end of an interval is no claim.
    {R"((fail|violat|broke|collid|crash)\w*[^.|;]{0,60}[^.0-9[]0 %)", "failing worlds: 0 %"},
    {R"([^.0-9]0 % of (the )?(runs|worlds|replicates))", "it failed in 0 % of the runs"},
    {R"([0-9.]+ ?% (safe|secure|reliable)\b)", "the release is 99.99 % safe"},
    {R"(\b(sure|certain|confident) (that|the)\b)", "we are 95 % sure the release is safe"},
    {R"(probability that (the|this) (release|software|agent) is)", "the probability that the release is safe is 95 %"},
    {R"(\b(SIL|PL) ?[0-9a-e]\b|\bmeets (PL|SIL)\b)", "it meets PL d / SIL 2"},
    {R"(\bsignifican(t|tly|ce)\b)", "the difference is significant"},
    {R"(\bworst[- ]case (was )?tested\b|\btested the worst case\b)", "worst case tested"},
    {R"(\baverage (over|of) (the |all )?(cells|conditions|layouts)\b)", "the average over cells is 0.1"},
    {R"(\bpooled (over|across) (versions|releases|seeds)\b)", "pooled over versions"},
    {R"(\bp ?[=<] ?0?\.[0-9]|\bp-values?\b)", "p = 0.03"},
    {R"(\bestimated (rate|probability)\b)", "the estimated probability is 1e-9"},
    {R"(\b(run|try|look) (it )?(again|on) until\b)", "run again until it passes"},
    {R"(\bfirst attempt\b)", "this is the first attempt"},
    {R"(\bguarantees? (safety|that no)\b|\brisk[- ]free\b|\bperfectly safe\b)", "this guarantees safety"},
};

// The pieces between bars, each once: pages say most of it again and again. A bar stands before each, as on the page.
std::set<std::string> pieces_of(const std::string& page) {
  std::set<std::string> pieces;
  for (std::size_t begin = 0; begin < page.size();) {
    const std::size_t end = std::min(page.find('|', begin), page.size());
    pieces.insert("|" + page.substr(begin, end - begin));
    begin = end + 1;
  }
  return pieces;
}

std::vector<std::string> traps_in(const std::set<std::string>& pieces) {
  std::vector<std::string> found;
  for (const Trap& trap : kTraps) {
    const std::regex pattern(trap.pattern, std::regex::icase);
    for (const std::string& piece : pieces) {
      if (std::regex_search(piece, pattern)) found.push_back(std::string(trap.pattern) + " in: " + piece);
    }
  }
  return found;
}

// Without markup, without the style sheet, and without the section that names what the page does not say.
std::string words_of(std::string page) {
  const auto cut = [&](const std::string& from, const std::string& to) {
    const auto begin = page.find(from);
    if (begin == std::string::npos) return;
    page.erase(begin, page.find(to, begin) - begin);
  };
  cut("<style>", "</style>");
  cut("<script>", "</script>");
  cut("<h2>What this page does not say</h2>", "</section>");
  page = std::regex_replace(page, std::regex("</?[a-zA-Z][^>]*>"), "|");
  page = std::regex_replace(page, std::regex("\u00a0"), " ");
  page = std::regex_replace(page, std::regex("\n {4,}(?=[^ ])"), " ");  // the next line of a sentence
  return std::regex_replace(page, std::regex("\n|  +"), "|");           // cells of a table
}

class WordingTraps : public test::ProgramTest {
 protected:
  void TearDown() override {
    ::unsetenv("GITHUB_STEP_SUMMARY");
    ::unsetenv("GITHUB_ACTIONS");
    ProgramTest::TearDown();
  }
  // Every format of an archive, with the step summary and the annotations.
  std::vector<std::string> pages(const std::string& archive, const std::string& more = "") const {
    ::setenv("GITHUB_STEP_SUMMARY", path("summary.md").c_str(), 1);
    ::setenv("GITHUB_ACTIONS", "true", 1);
    std::vector<std::string> all;
    for (const char* format : {"text", "markdown", "summary", "junit", "json"}) {
      const bool people = std::string(format) == "text" || std::string(format) == "markdown";
      const auto finished = run("report " + archive + " --format " + format + (people ? more : ""));
      EXPECT_NE(finished.out, "") << format << finished.err;
      all.push_back(words_of(finished.out));
      all.push_back(words_of(finished.err));
    }
    run("report " + archive + more + " --html page.html");
    all.push_back(words_of(read(path("page.html"))));
    all.push_back(words_of(read(path("summary.md"))));
    EXPECT_NE(all.back(), "");
    return all;
  }
  void expect_no_trap(const std::string& archive, const std::string& more = "") const {
    std::set<std::string> pieces;
    for (const std::string& page : pages(archive, more)) pieces.merge(pieces_of(page));
    EXPECT_THAT(traps_in(pieces), testing::IsEmpty()) << archive;
  }
};

TEST_F(WordingTraps, EachFiresOnABadSentence) {
  for (const Trap& trap : kTraps) {
    const std::string page = "<p>A sentence.</p><p>" + std::string(trap.bad) + "</p>";
    EXPECT_THAT(traps_in(pieces_of(words_of(page))), testing::Contains(testing::HasSubstr(trap.pattern))) << trap.bad;
  }
}

TEST_F(WordingTraps, AreNotOnAnyPage) {
  const auto cells = samples::grid({"sound", "odd"}, {0.0, 0.4, 0.6}, {1.0, 2.0}, {"ring", "cross"});
  const auto gates = samples::gates_of_every_kind("sound", "ring");
  struct Case {
    const char *name, *kind;
    std::uint64_t runs;
    double trouble;
  };
  for (const Case& each : {Case{"clean.db", "claim", 24 * 200, 0.0}, Case{"bad.db", "claim", 24 * 200, 0.2},
                           Case{"empty.db", "claim", 0, 0.0}, Case{"part.db", "claim", 700, 0.01},
                           Case{"search.db", "search", 700, 0.1}}) {
    samples::write_archive(path(each.name), samples::campaign_of(each.kind, 200), cells, gates, each.runs,
                           each.trouble);
    expect_no_trap(each.name);
  }
  expect_no_trap("bad.db", " --baseline clean.db");
}

TEST_F(WordingTraps, AreNotOnThePageOfACampaignThatWasRun) {
  write("a.toml",
        "replicates = 12\nhorizon_s = 120\n[factors]\nagents = [{ agent = \"hull-lock\", role = \"candidate\" }, "
        "\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = [0.0, 0.4]\ndelay_s = [0, 2]\n");
  run("run a.toml --db a.db");
  expect_no_trap("a.db");
}

// What must stand beside a figure.
TEST_F(WordingTraps, AFigureHasWhatAReaderNeeds) {
  samples::write_archive(path("a.db"), samples::campaign_of("claim", 50),
                         samples::grid({"sound"}, {0.0, 0.4}, {1.0, 2.0}, {"ring", "cross"}),
                         samples::gates_of_every_kind("sound", "ring"), 400, 0.1);
  run("report a.db --html page.html");
  for (const std::string& page : {words_of(run("report a.db").out), words_of(read(path("page.html"))),
                                  words_of(run("report a.db --format markdown").out)}) {
    EXPECT_THAT(page, testing::ContainsRegex("[0-9] s a run")) << "a rate per run has the length of a run";
    EXPECT_THAT(page, testing::HasSubstr("per AGV-h")) << "and a rate per hour beside it";
    EXPECT_THAT(page, testing::HasSubstr("the loss is the configured one, each loss independent of the others"));
    EXPECT_THAT(page, testing::HasSubstr("not adjusted for")) << "intervals of many rows";
    EXPECT_THAT(page, testing::HasSubstr("It says nothing about other conditions"));
  }
}

}  // namespace
}  // namespace fleetproof::wording_traps_test
