#include "campaign/findings/findings_file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "campaign/findings/failure_analysis.hpp"
#include "core/base/error.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::findings_file_test {
namespace {

using testing::HasSubstr;
using Bench = test::CaseBench;

class FindingsFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("fleetproof-findings-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string written(const std::string& text) const {
    const auto path = folder_ / "findings.toml";
    std::ofstream(path) << text;
    return path.string();
  }
  static KnownIssue odd() {
    KnownIssue finding;
    finding.id = "F-00000001";
    finding.mechanism = "too close; says \"a\\b\"";
    finding.end = "too close";
    finding.choice = {bit_of(EndPoint::Contact) | bit_of(EndPoint::Deadlock)};
    finding.refuted = {"restart", "the \"x\" messages"};
    finding.ways = {{"lost messages", "the \"x\" messages"}, {}};
    finding.found_in = "a\tb";
    finding.laws_left_out = {"progress"};
    finding.limits = {512, 2.5};
    finding.smallest = "c.json";
    finding.world = "w.json";
    finding.other_worlds = {"v.json", "u.json"};
    finding.doings = {"one turns"};
    finding.says = {"oops", "a \"b\""};
    finding.neighbours = {1000, 17, {{"no progress", 3}, {"a \"b\"", 4}}, {}, {}, 750, 9, 12345, 678};
    finding.neighbours.said.always = {"a", "b \"c\""};
    finding.neighbours.circumstances = {
        {{"came (s)", {0, 1, 2, 7.125, kNever_s}}}, {}, {{"a", {0, 0, 0, 0, 1}}, {"b", {0, 0, 0, 0, 2}}}};
    finding.neighbours.said.usually = {"u", "v"};
    finding.neighbours.said.ever = {"w \"x\"", "y"};
    finding.whole.files = {"r.json", "s.json"};
    finding.whole.counts = {250, 130, {{"a \"d\"", 5}}, {}};
    finding.whole.counts.said.always = {"c", "d"};
    finding.whole.counts.said.usually = {"e"};
    finding.whole.counts.said.ever = {"f", "g"};
    finding.whole.counts.circumstances = {{{"other: \"x\"", {9, 1, 2, 3, 4}}}};
    finding.whole.others_need = {{"restart"}, {}};
    return finding;
  }
  std::string error_of(const std::string& text) const {
    try {
      FindingsFile file(written(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(FindingsFiles, WhatIsWrittenIsRead) {
  const FindingsFile file(written(toml_of(odd())));
  const KnownIssue* read = file.find("F-00000001");
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(toml_of(*read), toml_of(odd()));
  EXPECT_EQ(read->ways, odd().ways);
  EXPECT_EQ(read->refuted, odd().refuted);
  EXPECT_EQ(read->choice, odd().choice);
  EXPECT_EQ(std::pair(read->doings, read->says), std::pair(odd().doings, odd().says));
  EXPECT_EQ(read->other_worlds, odd().other_worlds);
  EXPECT_EQ(read->laws_left_out, odd().laws_left_out);
  EXPECT_EQ(read->limits, odd().limits);
  EXPECT_EQ(std::pair(read->neighbours.of_world, read->neighbours.alike_of_world), std::pair(750UL, 9UL));
  EXPECT_EQ(std::pair(read->neighbours.driven_m, read->neighbours.driven_elsewhere_m), std::pair(12345UL, 678UL));
  EXPECT_EQ(read->neighbours.said.always, odd().neighbours.said.always);
  EXPECT_EQ(read->neighbours.said.usually, odd().neighbours.said.usually);
  EXPECT_EQ(read->neighbours.said.ever, odd().neighbours.said.ever);
  EXPECT_EQ(read->whole.counts.said.usually, odd().whole.counts.said.usually);
  EXPECT_EQ(read->whole.counts.said.ever, odd().whole.counts.said.ever);
  EXPECT_EQ(read->neighbours.otherwise, odd().neighbours.otherwise);
  EXPECT_EQ(read->whole.files, odd().whole.files);
  EXPECT_EQ(std::pair(read->whole.counts.of, read->whole.counts.alike), std::pair(250UL, 130UL));
  EXPECT_EQ(read->whole.counts.otherwise, odd().whole.counts.otherwise);
  EXPECT_EQ(read->whole.others_need, odd().whole.others_need);
  EXPECT_EQ(read->neighbours.circumstances, odd().neighbours.circumstances);
  EXPECT_EQ(read->whole.counts.circumstances, odd().whole.counts.circumstances);
  EXPECT_EQ(file.find("F-00000002"), nullptr);
  EXPECT_TRUE(FindingsFile((folder_ / "none.toml").string()).findings().empty());
}

// What a user has written into the file stays.
TEST_F(FindingsFiles, ARefutedNeedIsStruckInItsPlace) {
  KnownIssue first = odd(), second = odd();
  first.refuted.clear();
  second.id = "F-00000002";
  second.refuted = {"restart"};
  const std::string text = "# mine\n" + toml_of(first) + "# yours\n" + toml_of(second);
  std::string changed = with_refuted(text, first, {"late messages"}).value();
  changed = with_refuted(changed, second, {"restart", "lost messages"}).value();
  const FindingsFile file(written(changed));
  EXPECT_EQ(file.find(first.id)->refuted, std::vector<std::string>{"late messages"});
  EXPECT_EQ(file.find(second.id)->refuted, (std::vector<std::string>{"restart", "lost messages"}));
  EXPECT_EQ(file.find(first.id)->ways, first.ways) << "all else is as it was";
  EXPECT_THAT(changed, HasSubstr("# mine\n"));
  EXPECT_THAT(changed, HasSubstr("# yours\n"));
  EXPECT_EQ(with_refuted(changed, second, {"restart"}), with_refuted(text, first, {"late messages"}));
  // As a user may write it.
  std::string own = "# see \"F-00000002\"\n" + text;
  own.replace(own.find("refuted = [\"restart\"]"), 21, "  refuted=[ # mine\n  \"restart\",\n]");
  const FindingsFile own_file(written(with_refuted(own, second, {"late messages"}).value()));
  EXPECT_EQ(own_file.find(second.id)->refuted, std::vector<std::string>{"late messages"});
  EXPECT_TRUE(own_file.find(first.id)->refuted.empty());
}

// What looks like a finding, an id or the end of a list, and is none.
TEST_F(FindingsFiles, ARefutedNeedIsStruckInTextsOfAnyShape) {
  KnownIssue first = odd(), second = odd();
  first.refuted = {"the \"é]b\" messages"};
  second.id = "F-00000002";
  second.refuted.clear();
  const std::string plain = toml_of(first) + toml_of(second);
  const auto with = [&](std::string_view what, std::string_view instead) {
    std::string text = plain;
    const std::size_t at = text.find(what);
    EXPECT_NE(at, text.npos) << what;
    return text.replace(at, what.size(), instead);
  };
  const std::vector<std::string> texts = {
      plain,
      with("status = \"known\"",
           "status = \"known\"\nreason = \"\"\"see\n[[finding]]\nrefuted = []\nid = \"F-00000002\"\n\"\"\""),
      with("[[finding]]\nid", "# [[finding]] id = \"F-00000001\"\n[[ finding ]]\n\"id\""),
      with("id = \"F-00000001\"", "id = 'F-00000001' # \"F-00000002\""),
      with("refuted = [\"the \\\"é]b\\\" messages\"]",
           "refuted = [ # ]\n \"the \\\"é]b\\\" messages\", # ] é\n] # mine"),
  };
  for (const std::string& text : texts) {
    const std::vector<std::string> needs{"late messages", "the \"c]\" messages"};
    for (const KnownIssue& struck : {first, second}) {
      const auto changed = with_refuted(text, struck, needs);
      ASSERT_TRUE(changed.has_value()) << text;
      const FindingsFile file(written(*changed));
      ASSERT_EQ(file.findings().size(), 2U) << *changed;
      for (const KnownIssue& one : file.findings()) {
        const auto& before = one.id == first.id ? first : second;
        EXPECT_EQ(one.refuted, one.id == struck.id ? needs : before.refuted) << *changed;
        EXPECT_EQ(one.ways, before.ways);
      }
    }
  }
}

TEST_F(FindingsFiles, WhatCannotBeStruckIsSaidAndStays) {
  const KnownIssue issue = odd();
  KnownIssue missing = issue;
  missing.id = "F-00000003";
  EXPECT_EQ(with_refuted(toml_of(issue), missing, {"restart"}), std::nullopt);
  const std::string in_one_line =
      "finding = [{id = \"F-00000001\", mechanism = \"m\", end = \"too close\", ways = [], found_in = \"a\", "
      "case = \"c.json\", world = \"w.json\"}]\n";
  EXPECT_EQ(FindingsFile(written(in_one_line)).findings().size(), 1U);
  EXPECT_EQ(with_refuted(in_one_line, issue, {"restart"}), std::nullopt);
}

TEST_F(FindingsFiles, ErrorsNameTheLineAndTheRemedy) {
  const std::string good = toml_of(odd());
  EXPECT_EQ(error_of(good), "");
  EXPECT_THAT(error_of(good + good), HasSubstr("twice"));
  EXPECT_THAT(error_of("[[finding]]\nid = \"F-1\"\n"), HasSubstr("mechanism"));
  EXPECT_THAT(error_of(good + "stats = 3\n"), HasSubstr("stats"));
  auto many = odd();
  many.whole.counts.alike = 251;
  EXPECT_THAT(error_of(toml_of(many)), HasSubstr("more runs failed"));
  auto few = odd();
  few.neighbours.circumstances[0]["came (s)"].pop_back();
  EXPECT_THAT(error_of(toml_of(few)), HasSubstr("expected 5 numbers"));
  few.neighbours.circumstances[0]["came (s)"].push_back(-1.0);
  EXPECT_THAT(error_of(toml_of(few)), HasSubstr("-1"));
  auto waived = odd();
  waived.status = IssueStatus::Waived;
  EXPECT_THAT(error_of(toml_of(waived)), HasSubstr("until"));
  EXPECT_THAT(error_of(toml_of(waived)), HasSubstr("findings.toml:5"));
  for (const char* day : {"2026-13-99", "2027-02-29", "2026-00-10", "2026-1-010", "2026-11-2x"})
    EXPECT_THAT(error_of(toml_of(waived) + "reason = \"x\"\nuntil = \"" + day + "\"\n"), HasSubstr("until")) << day;
  EXPECT_EQ(error_of(toml_of(waived) + "reason = \"x\"\nuntil = \"2028-02-29\"\n"), "");
  EXPECT_THAT(error_of(good + "looked_for = [\"contacts\"]\n"), HasSubstr("looked_for"));
  auto leading = odd();
  leading.choice = {};
  EXPECT_THAT(error_of(toml_of(leading) + "looked_for = [\"contact\", \"nap\"]\n"),
              HasSubstr("\"nap\" is no failure of a run"));
  auto other = odd();
  other.laws_left_out = {"gravity"};
  EXPECT_THAT(error_of(toml_of(other)), HasSubstr("laws_left_out names \"gravity\", which no campaign runs"));
}

// What the whole runs of a finding showed, and the other findings of the same software.
TEST_F(FindingsFiles, SaysHowElseTheSoftwareFailed) {
  KnownIssue other = odd(), elsewhere = odd();
  other.id = "F-00000002";
  other.ways = {{"breakdown"}};
  elsewhere.id = "F-00000003";
  elsewhere.found_in = "another agent";
  const FindingsFile file(written(toml_of(odd()) + toml_of(other) + toml_of(elsewhere)));
  const KnownRuns known = file.known_runs(*file.find("F-00000001"));
  EXPECT_EQ(known.counts.of, 250U);
  ASSERT_EQ(known.others.size(), 2U);
  EXPECT_EQ(known.others[0].failure.ways, odd().whole.others_need);
  EXPECT_TRUE(known.others[0].failure.says.empty());
  EXPECT_EQ(known.others[0].always_said, odd().whole.counts.said.always);
  EXPECT_EQ(known.others[1].failure.ways, other.ways);
  EXPECT_EQ(known.others[1].failure.says, other.says);
  EXPECT_EQ(known.others[1].always_said, other.neighbours.said.always);
  EXPECT_EQ(known.others[1].usually_said, other.neighbours.said.usually);
  EXPECT_EQ(known.others[1].circumstances, other.whole.counts.circumstances);
}

TEST_F(FindingsFiles, AWaiverEnds) {
  KnownIssue kept = odd();
  EXPECT_EQ(standing_of(nullptr, "2026-11-23"), "new");
  EXPECT_EQ(standing_of(&kept, "2026-11-23"), "known");
  EXPECT_FALSE(needs_attention(&kept, "2026-11-23"));
  kept.status = IssueStatus::Waived;
  kept.until = "2026-11-23";
  EXPECT_FALSE(needs_attention(&kept, "2026-11-23"));
  EXPECT_TRUE(needs_attention(&kept, "2026-11-24"));
  EXPECT_EQ(standing_of(&kept, "2026-11-24"), "known (waived until 2026-11-23)");
  kept.status = IssueStatus::Fixed;
  EXPECT_EQ(standing_of(&kept, "2026-11-23"), "back");
  EXPECT_TRUE(needs_attention(&kept, "2026-11-23"));
}

// ---- record

FailureAnalysis recorded(Bench& bench, std::uint64_t seed = 100) {
  const auto needs = needs_of(bench.host, bench.failing(seed));
  Finding finding;
  finding.mechanism = {needs->end, needs->needs, {}, {}};
  return analysis_of(bench.host, finding, *needs, 400);
}

TEST(FindingRecords, AreTheSameForAnyNumberOfWorkers) {
  Bench one("timeout-grant", 1), seven("timeout-grant", 7);
  const FailureAnalysis record = recorded(one), again = recorded(seven);
  EXPECT_EQ(to_text(record.kept.smallest), to_text(again.kept.smallest));
  EXPECT_EQ(to_text(record.kept.world), to_text(again.kept.world));
  EXPECT_EQ(record.kept.ways, again.kept.ways);
  EXPECT_EQ(record.neighbours.alike, again.neighbours.alike);
  EXPECT_EQ(record.neighbours.otherwise, again.neighbours.otherwise);
}

// Where most failing neighbours are of the smallest case, the first few of all are, too.
TEST(FindingRecords, KnowWhatNeighboursOfTheWorldsNeed) {
  Bench bench("stale-grant");
  const FailureAnalysis record = recorded(bench, 122);
  const Neighbourhood neighbourhood(bench.host, record.kept);
  const auto& of_worlds = record.neighbours.first_alike_of_world;
  ASSERT_EQ(of_worlds.size(), 5U);
  EXPECT_TRUE(std::ranges::none_of(of_worlds, [&](std::uint32_t number) { return neighbourhood.is_of_case(number); }));
  EXPECT_GT(of_worlds.back(), record.neighbours.first_alike.back()) << "else it tells nothing";
  for (const FailureNeeds& found : needs_of_neighbours(bench.host, neighbourhood, of_worlds))
    EXPECT_EQ(std::ranges::count(record.kept.ways, found.needs), 1) << found.needs.size();
}

// Whatever it is about to do then: shrinking, explaining, trying neighbours.
TEST(FindingRecords, AreGivenUpWhenTheirHostIsToldTo) {
  Bench bench("timeout-grant");
  const auto needs = needs_of(bench.host, bench.failing(100));
  Finding finding;
  finding.mechanism = {needs->end, needs->needs, {}, {}};
  for (const std::uint64_t most : {0U, 100U, 1000U, 2000U}) {
    const std::uint64_t before = bench.host.simulated();
    const TimeLimit limit({}, [&] { return bench.host.simulated() >= before + most; });
    CaseHost host = bench.host.within(limit);
    EXPECT_THROW(analysis_of(host, finding, *needs, 400), GivenUp) << most;
    EXPECT_TRUE(limit.is_over());
  }
}

}  // namespace
}  // namespace fleetproof::findings_file_test
