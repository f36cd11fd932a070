#include "campaign/findings/retest.hpp"

#include <gmock/gmock.h>

#include <utility>

#include "campaign/findings/elsewhere.hpp"
#include "campaign/findings/failure_analysis.hpp"
#include "campaign/findings/ingredients.hpp"
#include "campaign/findings/whole_failures.hpp"
#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/fitness.hpp"
#include "tests/support/known_failure.hpp"

namespace fleetproof::retest_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Bench = test::CaseBench;
using test::Known;
using test::known_failure;

constexpr std::uint32_t kSome = 200;

TEST(Retest, TellsAFixFromAnEscapeByChance) {
  Bench bench("timeout-grant");
  const Known known = known_failure(bench);
  EXPECT_GE(known.before.alike, 100U) << "of 1000";
  const Retest same = retest(bench.host, known.kept, known.before, kSome);
  EXPECT_EQ(same.verdict, RetestVerdict::StillThere);

  Bench sound("hull-lock");
  const Retest fixed = retest(sound.host, known.kept, known.before, kSome);
  EXPECT_EQ(fixed.verdict, RetestVerdict::Fixed) << fixed.new_kind;
  EXPECT_EQ(fixed.now.alike, 0U);
  EXPECT_NEAR(fixed.upper_bound, 0.0149, 0.0001) << "1 - 0.05^(1/200)";

  AgentPrograms programs;
  const std::string name = programs.know(FLEETPROOF_RETOUCHED_AGENT);
  CaseHost retouched({name, "timeout-grant"}, programs, 2);
  const Retest dodged = retest(retouched, known.kept, known.before, kSome);
  EXPECT_EQ(dodged.verdict, RetestVerdict::Dodged) << dodged.new_kind;
  EXPECT_GT(dodged.now.alike, 0U);
}

TEST(Retest, SaysWhetherTheNeighboursCouldTell) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  known.before.alike = 3;
  Bench sound("hull-lock");
  EXPECT_EQ(retest(sound.host, known.kept, known.before, kSome).verdict, RetestVerdict::NotKnown);
}

// On a better radio the same software fails in fewer worlds, as one does in which a part of the fault was mended.
TEST(Retest, ComparesTheWorldsThatStillDraw) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  EXPECT_EQ(known.before.of_world, 3 * known.before.of / 4);
  EXPECT_LE(known.before.alike_of_world, known.before.alike);
  EXPECT_GT(known.before.driven_m, 0U);
  AgentPrograms programs;
  const std::string name = programs.know(FLEETPROOF_RETOUCHED_AGENT);
  CaseHost retouched({name, "timeout-grant"}, programs, 2);
  EXPECT_EQ(retest(retouched, known.kept, known.before, kSome).verdict, RetestVerdict::Dodged);
  known.kept.world.radio.loss = 0.1;
  for (Scenario& world : known.kept.other_worlds) world.radio.loss = 0.1;
  known.before.alike = known.before.of / 10;  // neighbours of the case tell nothing
  EXPECT_EQ(retest(retouched, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere);
}

// A fleet may stand beside a failure because it has to. If it stands elsewhere, too, it just stands.
TEST(Retest, AFleetThatStandsEverywhereShowsNothing) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  Bench sound("hull-lock");
  EXPECT_EQ(retest(sound.host, known.kept, known.before, kSome).standing, "");
  EXPECT_GT(known.before.driven_elsewhere_m, 1000U);
  known.before.driven_m *= 100;
  const Retest waits = retest(sound.host, known.kept, known.before, kSome);
  EXPECT_EQ(waits.verdict, RetestVerdict::Fixed);
  EXPECT_THAT(waits.standing, HasSubstr("in each neighbour"));
  EXPECT_THAT(waits.standing, HasSubstr("from other stations"));
  known.before.driven_elsewhere_m *= 100;
  EXPECT_EQ(retest(sound.host, known.kept, known.before, kSome).verdict, RetestVerdict::NotKnown);
  known.before.driven_elsewhere_m = 0;
  const Retest not_asked = retest(sound.host, known.kept, known.before, kSome);
  EXPECT_EQ(not_asked.verdict, RetestVerdict::NotKnown);
  EXPECT_THAT(not_asked.standing, Not(HasSubstr("from other stations"))) << "a file that does not say it";
}

TEST(Elsewhere, IsAFairStartAtOtherStations) {
  const Scenario world = test::bad_night(125);
  std::size_t moved = 0;
  for (std::uint32_t number = 0; number < 20; ++number) {
    const auto there = elsewhere(world, number);
    ASSERT_TRUE(there) << number;
    EXPECT_TRUE(is_fair(*there));
    EXPECT_EQ(there->faults.size(), world.faults.size());
    for (std::size_t agv = 0; agv < world.agvs.size(); ++agv)
      moved += there->agvs[agv].start != world.agvs[agv].start ? 1 : 0;
  }
  EXPECT_GT(moved, 80U) << "of 100";
}

// A finding with one failure gets worlds in which its fleet stands elsewhere and fails so.
TEST(Elsewhere, TheSameFailureIsFoundThere) {
  Bench bench("timeout-grant");
  const Known known = known_failure(bench);
  ASSERT_FALSE(known.kept.other_worlds.empty());
  EXPECT_LE(known.kept.other_worlds.size(), kOtherWorlds);
  for (const Scenario& world : known.kept.other_worlds) {
    const auto needs = needs_of(bench.host, world);
    ASSERT_TRUE(needs);
    EXPECT_EQ(needs->end, known.kept.end);
    EXPECT_TRUE(is_one_of(known.kept, *needs));
  }
}

// What was mended where the failure was found may be left elsewhere.
TEST(Retest, AFaultThatIsLeftInAnotherWorldIsFound) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  ASSERT_FALSE(known.kept.other_worlds.empty());
  for (Scenario* mended : {&known.kept.smallest, &known.kept.world}) {
    *mended = with_deliveries_only(*mended, {});
    mended->horizon = std::chrono::seconds(1);
  }
  const Retest left = retest(bench.host, known.kept, known.before, kSome);
  EXPECT_GT(left.now.alike, 0U);
  EXPECT_NE(left.verdict, RetestVerdict::Fixed);
  known.kept.other_worlds.clear();
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).now.alike, 0U);
}

TEST(Retest, OtherWorldsAreThoseOfMembersThatAreNotRare) {
  std::vector<KnownFailure> failures(12);
  Finding finding;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    failures[i].needs.reduced.scenario.seed = i;
    failures[i].needs.is_rare = i == 5;
    if (i > 1) finding.members.push_back(i);
  }
  finding.representative = 2;
  std::vector<std::uint64_t> seeds;
  for (const FailingCase& other : others_of(finding, failures)) seeds.push_back(other.scenario.seed);
  EXPECT_THAT(seeds, testing::ElementsAre(4U, 7U, 9U, 11U));
  finding.members = {2, 5, 6};
  EXPECT_EQ(others_of(finding, failures).size(), 1U);
  finding.members = {2};
  EXPECT_TRUE(others_of(finding, failures).empty());
}

// The same end and the same needs, but it never says what the kept failure always says.
TEST(Retest, AFailureWithoutItsWordsIsANewKind) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  EXPECT_THAT(known.before.said.always, testing::Contains("silence-taken-for-consent"));
  known.kept.says = {"never-heard-of"};
  const Retest result = retest(bench.host, known.kept, known.before, kSome);
  EXPECT_EQ(result.verdict, RetestVerdict::NewKind);
  EXPECT_THAT(result.new_kind, HasSubstr("never says \"never-heard-of\""));
  known.kept.says.clear();
  known.kept.doings = {"one flies"};
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::NewKind);
}

// Where three had to meet before, two alone fail for another reason.
TEST(Retest, AFailureOfTwoAgvsAloneIsNotThatOfThree) {
  Bench bench("counts-messages");
  std::uint64_t seed = 100;
  std::optional<FailureNeeds> needs;
  while (!needs || !names_all(needs->traits, {kThirdAgvTrait})) needs = needs_of(bench.host, bench.failing(++seed));
  Finding finding;
  finding.mechanism = {.end = needs->end, .needs = needs->needs, .doing = {}, .traits = {kThirdAgvTrait}};
  const FailureAnalysis record = analysis_of(bench.host, finding, *needs, 1000);
  EXPECT_THAT(record.kept.doings, testing::ElementsAre(kThirdAgvTrait));
  EXPECT_EQ(retest(bench.host, record.kept, record.neighbours, kSome).verdict, RetestVerdict::StillThere);
  Bench other("reckless");
  const Retest result = retest(other.host, record.kept, record.neighbours, kSome);
  EXPECT_EQ(result.verdict, RetestVerdict::NewKind);
  EXPECT_THAT(result.new_kind, HasSubstr("needs no third AGV"));
}

// A word that each failure had said, and that no fleet says any more, names what the software no longer does.
TEST(Retest, AWordThatIsGoneShowsANewKind) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  EXPECT_THAT(known.before.said.always, testing::Contains("silence-taken-for-consent"));
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere);
  known.before.said.always.push_back("now-mended");
  const Retest gone = retest(bench.host, known.kept, known.before, kSome);
  EXPECT_EQ(gone.verdict, RetestVerdict::NewKind);
  EXPECT_THAT(gone.new_kind, HasSubstr("never says \"now-mended\""));
  known.before.said.always = {"ahoi", "belay"};
  known.before.said.usually.clear();
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere)
      << "software that names nothing as before";
}

// The same end, needs and words; but the failures come about otherwise.
TEST(Retest, OtherCircumstancesShowANewKind) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  ASSERT_GE(known.before.circumstances.size(), 1U);
  ASSERT_EQ(known.before.circumstances[0].count("other: stood (s)"), 1U);
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere);
  for (Circumstances& world : known.before.circumstances)
    world["other: stood (s)"] = std::vector<double>(kCircumstanceValues, 5000.0);
  const Retest result = retest(bench.host, known.kept, known.before, kSome);
  EXPECT_EQ(result.verdict, RetestVerdict::NewKind);
  EXPECT_THAT(result.new_kind, HasSubstr("\"other: stood (s)\" is "));
  EXPECT_THAT(result.new_kind, HasSubstr("and was 5000.0"));
}

// Another timing may be enough for AGVs not to say what they usually say. What only failing ones said is missing for a
// reason.
TEST(Retest, AUsualWordMayGo) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  EXPECT_THAT(known.before.said.usually, testing::Contains("driving"));
  EXPECT_THAT(known.before.said.always, Not(testing::Contains("driving")));
  known.before.said.usually.push_back("now-mended");
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere);
}

TEST(Retest, AWordThatNobodySaidBeforeShowsANewKind) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  EXPECT_THAT(known.before.said.ever, testing::IsSupersetOf({"driving", "silence-taken-for-consent"}));
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere);
  std::erase(known.before.said.ever, "driving");
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere)
      << "all say it, whether they fail or not";
  std::erase(known.before.said.ever, "silence-taken-for-consent");
  const Retest result = retest(bench.host, known.kept, known.before, kSome);
  EXPECT_EQ(result.verdict, RetestVerdict::NewKind);
  EXPECT_THAT(result.new_kind, HasSubstr("it says \"silence-taken-for-consent\""));
  known.before.said.ever.clear();
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::StillThere) << "not known";
}

// What the software was known for beside the finding is nothing new in its neighbours.
TEST(Retest, AKnownFailureOfTheSameSoftwareIsNotNew) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  known.kept.smallest = with_deliveries_only(known.kept.smallest, {});  // the case passes
  const auto ways = std::exchange(known.kept.ways, {{"obstacles"}});
  EXPECT_EQ(retest(bench.host, known.kept, known.before, kSome).verdict, RetestVerdict::NewKind);
  const KnownRuns also{{}, {{{.end = known.kept.end, .ways = ways}}}};
  EXPECT_NE(retest(bench.host, known.kept, known.before, kSome, also).verdict, RetestVerdict::NewKind);
}

// What the smallest case needs is one of the ways, even where that is less than the finding needs. No neighbour fails
// with this end, so none of them adds it.
TEST(Retest, KnowsWhatTheSmallestCaseNeeds) {
  Bench bench("timeout-grant");
  const auto needs = needs_of(bench.host, bench.failing(125));
  Finding finding;
  finding.mechanism = {"no such end", {"obstacles"}, {}, {}};
  const FailureAnalysis record = analysis_of(bench.host, finding, *needs, 400);
  EXPECT_THAT(record.kept.ways,
              testing::ElementsAre(finding.mechanism.needs, needs_of(bench.host, record.kept.smallest)->needs));
}

TEST(Retest, KeepsNoWordThatFailingNeighboursDoWithout) {
  KeptFailure kept;
  kept.says = {"retreat", "silence-taken-for-consent"};
  NeighbourCounts counts;
  keep_words_of_all(kept, counts);
  EXPECT_EQ(kept.says.size(), 2U) << "none failed: nothing is known";
  counts.alike = 5;
  counts.said.always = {"driving", "silence-taken-for-consent"};
  keep_words_of_all(kept, counts);
  EXPECT_THAT(kept.says, testing::ElementsAre("silence-taken-for-consent"));
}

TEST(Neighbours, AreMoreWhereHardlyAnyFails) {
  Bench bench("timeout-grant");
  const Scenario failing = bench.failing(125);
  KeptFailure kept{failing, failing, "no such end", {}};
  kept.smallest.horizon = kept.world.horizon = std::chrono::seconds(1);
  const Neighbourhood neighbourhood(bench.host, kept);
  EXPECT_EQ(try_enough_neighbours(bench.host, kept, neighbourhood).of, kMostKept);
}

TEST(Retest, ANewFaultInPlaceOfTheOldOneIsANewKind) {
  Bench bench("timeout-grant");
  const Known known = known_failure(bench);
  Bench other("reckless");
  const Retest result = retest(other.host, known.kept, known.before, kSome);
  EXPECT_EQ(result.verdict, RetestVerdict::NewKind);
  EXPECT_GT(result.now.alike, 0U);
  EXPECT_THAT(result.new_kind, HasSubstr("needs"));
}

// The case passes, so the first failing neighbours decide: what all of them need, and what none of them does.
TEST(Retest, TheFirstNeighboursSayOfWhatKindTheyAre) {
  Bench bench("timeout-grant");
  Known known = known_failure(bench);
  known.kept.smallest.horizon = std::chrono::seconds(1);
  ASSERT_FALSE(failure_of(bench.host(known.kept.smallest)).has_value());
  known.kept.doings.clear();
  known.kept.says.clear();
  known.before.said.always.clear();
  const auto verdict = [&](std::vector<std::string> way) {
    known.kept.ways = {std::move(way)};
    return retest(bench.host, known.kept, known.before, kSome);
  };
  const Retest kept = verdict({"lost messages"}), other = verdict({"lost messages", "restart"});
  EXPECT_NE(kept.verdict, RetestVerdict::NewKind);
  EXPECT_EQ(other.verdict, RetestVerdict::NewKind);
  // Both facts: how many fail as before, and how many do not.
  EXPECT_GT(kept.known_kept, kept.known_other);
  EXPECT_EQ(other.known_kept, 0U);
  EXPECT_EQ(other.looked_at, kept.looked_at);
  EXPECT_GT(other.looked_at, 0U);
}

}  // namespace
}  // namespace fleetproof::retest_test
