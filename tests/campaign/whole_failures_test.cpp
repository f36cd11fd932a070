#include "campaign/findings/whole_failures.hpp"

#include <gmock/gmock.h>

#include "campaign/findings/ingredients.hpp"
#include "campaign/findings/retest.hpp"
#include "campaign/shrink/adverse_deliveries.hpp"
#include "tests/support/known_failure.hpp"

namespace fleetproof::whole_failures_test {
namespace {

using testing::HasSubstr;
using Bench = test::CaseBench;
using test::Known;
using test::known_failure;

constexpr std::uint32_t kSome = 200;

// A finding of timeout-grant whose case and worlds show nothing any more, but whose runs are whole.
Known with_mended_worlds(Bench& bench) {
  Known known = known_failure(bench);
  known.kept.other_worlds.clear();
  for (Scenario* mended : {&known.kept.smallest, &known.kept.world}) {
    *mended = with_deliveries_only(*mended, {});
    mended->horizon = std::chrono::seconds(1);
  }
  known.kept.runs = {bench.failing(125)};
  known.before.driven_m = 0;
  return known;
}

// Reduced worlds have nothing left with which another fault shows.
TEST(WholeRuns, ShowWhatIsBrokenInstead) {
  Bench bench("timeout-grant");
  const Known known = with_mended_worlds(bench);
  const Retest left = retest(bench.host, known.kept, known.before, kSome);
  EXPECT_EQ(left.verdict, RetestVerdict::StillThere);
  EXPECT_EQ(left.now.alike, 0U);
  EXPECT_GT(left.whole_runs.alike, 0U);

  Bench sound("hull-lock");
  const Retest fixed = retest(sound.host, known.kept, known.before, kSome);
  EXPECT_EQ(fixed.verdict, RetestVerdict::Fixed);
  EXPECT_EQ(fixed.whole_runs.of, kSome);

  Bench other("reckless");
  const Retest broken = retest(other.host, known.kept, known.before, kSome);
  EXPECT_EQ(broken.now.alike, 0U);
  EXPECT_EQ(broken.verdict, RetestVerdict::NewKind);
  EXPECT_THAT(broken.new_kind, HasSubstr("needs nothing"));
  const KnownRuns of_two_faults{{}, {{{.end = known.kept.end, .ways = {{}}}}}};
  EXPECT_EQ(retest(other.host, known.kept, known.before, kSome, of_two_faults).verdict, RetestVerdict::Fixed)
      << "the software failed so before, too";
  KnownRuns of_rare_ones = of_two_faults;
  of_rare_ones.counts.of = kSome;
  of_rare_ones.counts.alike = 5;
  EXPECT_EQ(retest(other.host, known.kept, known.before, kSome, of_rare_ones).verdict, RetestVerdict::NewKind)
      << "that explains only so many";
}

// One or two failures of neighbours do not say of what kind they are: the whole runs do.
TEST(WholeRuns, AreAskedWhereHardlyAnyNeighbourFails) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  known.kept.smallest = with_deliveries_only(known.kept.smallest, {});
  const auto lose = [&](double share) {
    known.kept.world.radio.loss = share;
    for (Scenario& world : known.kept.other_worlds) world.radio.loss = share;
    return retest(bench.host, known.kept, known.before, kSome);
  };
  double share = 0.1;
  Retest few = lose(share);
  while (few.now.alike > 2) few = lose(share *= 0.8);
  ASSERT_GT(few.now.alike, 0U);
  EXPECT_EQ(few.verdict, RetestVerdict::StillThere);
  known.kept.runs = {bench.failing(125)};
  EXPECT_EQ(lose(share).verdict, RetestVerdict::StillThere);
  known.kept.ways = {{"obstacles"}};
  const Retest other = lose(share);
  EXPECT_EQ(other.whole_runs.of, kSome);
  EXPECT_EQ(other.verdict, RetestVerdict::NewKind);
}

// Half a mend may change nothing in the worlds.
TEST(WholeRuns, ThatFailMoreSeldomAreNoDodge) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  known.kept.runs = {bench.failing(125)};
  AgentPrograms programs;
  const std::string name = programs.know(FLEETPROOF_RETOUCHED_AGENT);
  CaseHost retouched({name, "timeout-grant"}, programs, 2);
  KnownRuns runs{try_whole_runs(bench.host, known.kept, kSome), {}};
  const Retest dodged = retest(retouched, known.kept, known.before, kSome, runs);
  EXPECT_EQ(dodged.verdict, RetestVerdict::Dodged);
  NeighbourCounts more = runs.counts;
  more.alike = more.of;
  EXPECT_EQ(retest(retouched, known.kept, known.before, kSome, {more, {}}).verdict, RetestVerdict::StillThere);

  ASSERT_EQ(runs.counts.circumstances.size(), 1U) << "of one run";
  runs.counts.circumstances[0]["came (s)"] = std::vector<double>(kCircumstanceValues, 5000.0);
  EXPECT_EQ(retest(retouched, known.kept, known.before, kSome, runs).verdict, RetestVerdict::NewKind)
      << "they come about otherwise";
  runs.others.push_back({known.kept, {}, {}, runs.counts.circumstances});
  EXPECT_EQ(retest(retouched, known.kept, known.before, kSome, runs).verdict, RetestVerdict::NewKind)
      << "nor are they another finding";
  runs.others.back().circumstances = dodged.whole_runs.circumstances;
  EXPECT_EQ(retest(retouched, known.kept, known.before, kSome, runs).verdict, RetestVerdict::Dodged)
      << "unless some of them were of another finding";
}

// A mend may help some AGVs of a fleet, and not the others.
TEST(WholeRuns, NumberTheFleetFromEachAgv) {
  KeptFailure kept;
  kept.runs = {test::bad_night(1), test::bad_night(2)};
  const Neighbourhood runs = Neighbourhood::of_runs(kept);
  const auto start = [&](std::uint32_t number, std::size_t agv) { return runs.at(number).agvs[agv].start; };
  const auto own = [&](std::size_t run, std::size_t agv) { return kept.runs[run].agvs[agv].start; };
  for (std::size_t agv = 0; agv < 5; ++agv) {
    EXPECT_EQ(start(0, agv), own(0, agv));
    EXPECT_EQ(start(2, agv), own(1, agv));
    EXPECT_EQ(start(4, agv), own(0, (agv + 1) % 5));
    EXPECT_EQ(start(7, agv), own(1, (agv + 1) % 5));
    EXPECT_EQ(start(19, agv), own(1, (agv + 4) % 5));
    EXPECT_EQ(start(20, agv), own(0, agv));
  }
  EXPECT_NE(own(0, 0), own(0, 1)) << "else it tells nothing";
}

TEST(Neighbours, NumberTheFleetOfEveryThirdWorldOtherwise) {
  Bench bench("reckless");
  const Scenario world = test::bad_night(1), other_world = test::bad_night(2);
  const KeptFailure kept{.smallest = world, .world = world, .other_worlds = {other_world}};
  const Neighbourhood neighbourhood(bench.host, kept);
  const auto is_first = [&](std::uint32_t number, const Scenario& of, std::size_t agv) {
    return neighbourhood.at(number).agvs[0].start == of.agvs[agv].start;
  };
  for (const std::uint32_t of_world : {9U, 10U, 11U, 17U}) EXPECT_TRUE(is_first(of_world, world, 0)) << of_world;
  for (const std::uint32_t of_other : {13U, 14U, 21U}) EXPECT_TRUE(is_first(of_other, other_world, 0)) << of_other;
  EXPECT_TRUE(is_first(1, world, 1) && is_first(5, other_world, 1));
  EXPECT_TRUE(is_first(25, world, 2) && is_first(29, other_world, 2) && is_first(73, world, 4) &&
              is_first(97, world, 1));
  EXPECT_TRUE(is_first(0, world, 0)) << "the case names its messages by their senders";
}

TEST(WholeRuns, MayBeTheKeptFailureOrNot) {
  const KeptFailure kept{.end = "too close", .ways = {{"restart", kLostMessages, "GRANT messages"}}};
  FailureNeeds found;
  found.end = "too close";
  found.needs = {"restart", kLostMessages, "DEFER messages"};
  EXPECT_TRUE(may_be(kept, found)) << "which kinds are lost is chance";
  found.needs = {"restart"};
  EXPECT_FALSE(may_be(kept, found));
  EXPECT_FALSE(may_be({.end = "too close", .ways = {{}}}, found)) << "that one needs nothing";
  EXPECT_TRUE(may_be({.end = "too close", .ways = {{}, {"restart"}}}, found));
  EXPECT_FALSE(may_be({.end = "no progress", .ways = {{"restart"}}}, found));
  EXPECT_FALSE(may_be({.end = "too close", .ways = {{"restart"}}, .says = {"oops"}}, found));
  EXPECT_FALSE(may_be({.end = "too close", .ways = {{"restart"}}, .doings = {kThirdAgvTrait}}, found));
  EXPECT_TRUE(may_be({.end = "too close", .ways = {{"restart"}}, .doings = {"one turns"}}, found));
}

// With the software in which it was found, they fail as it did.
TEST(WholeRuns, AreKeptWithTheFinding) {
  Bench bench("timeout-grant");
  const auto needs = needs_of(bench.host, bench.failing(125));
  Finding finding;
  finding.mechanism = {needs->end, needs->needs, {}, {}};
  const FailureAnalysis record = analysis_of(bench.host, finding, *needs, 400, {{}, {bench.failing(125)}});
  EXPECT_EQ(record.whole_runs.of, kWholeRuns);
  EXPECT_GT(record.whole_runs.alike, kWholeRuns / 4);
  EXPECT_TRUE(record.others_need.empty());
  KeptFailure strange = record.kept;
  strange.ways = {{"obstacles"}};
  EXPECT_FALSE(needs_of_others(bench.host, strange, record.whole_runs).empty());
}

}  // namespace
}  // namespace fleetproof::whole_failures_test
