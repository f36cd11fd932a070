#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "campaign/findings/finding.hpp"
#include "campaign/findings/ingredients.hpp"
#include "campaign/findings/refuted_needs.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::findings_test {
namespace {

using test::bad_night;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Bench = test::CaseBench;

// ---- ingredients

TEST(Ingredients, NothingIsLeftWhenAllAreTakenOut) {
  Scenario scenario = bad_night(1);
  scenario.agvs[0].battery = 0.4;
  scenario.agvs[1].sensing.clock_drift_ppm = 50.0;
  scenario.vehicle_types[0].loaded.extra_length_m = 0.3;
  scenario.radio.outages.mean_outage_s = 3.0;
  std::vector<std::string> names;
  Scenario bare = scenario;
  for (const Ingredient& ingredient : ingredients_of(scenario, {})) {
    names.push_back(ingredient.name);
    const auto before = scenario_digest(bare);
    ingredient.take_out(bare);
    EXPECT_NE(scenario_digest(bare), before) << ingredient.name;
  }
  EXPECT_THAT(names, ElementsAre("wrong clocks or positions", "doubled messages", "restart", "low batteries",
                                 "bodies that change with a load", "late messages", "lost messages"));
  EXPECT_TRUE(ingredients_of(bare, {}).empty());
  Bench bench("hull-lock");
  for (const MessageDelivery& message : bench.host(bare, Deliveries::Kept).deliveries)
    EXPECT_FALSE(message.is_adverse());
}

// ---- findings

KnownFailure failure(const std::string& agent, std::vector<std::string> needs, std::vector<std::string> doings = {},
                     std::uint64_t run = 0) {
  KnownFailure known;
  known.run = run;
  known.agent = agent;
  known.needs.end = "too close, two AGVs";
  known.needs.needs = std::move(needs);
  known.needs.doings = std::move(doings);
  return known;
}

std::vector<KnownFailure> times(std::size_t count, const KnownFailure& one) { return {count, one}; }
void add(std::vector<KnownFailure>& all, const std::vector<KnownFailure>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

TEST(Findings, WhoNeedsMoreJoinsWhoNeedsLess) {
  auto failures = times(10, failure("a", {"lost messages"}));
  add(failures, times(5, failure("a", {"restart", "lost messages"})));
  add(failures, times(4, failure("a", {"late messages"})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].members.size(), 15U);
  EXPECT_EQ(findings[0].mechanism.text(), "too close, two AGVs; needs lost messages");
  EXPECT_EQ(findings[1].members.size(), 4U);
}

// One such failure does without the late messages; another was tried too seldom to tell which message is late.
TEST(Findings, WhoSharesTheRarestNeedJoinsThoseOfWhichThereAreMany) {
  auto failures = times(30, failure("a", {"restart", "late messages", "STATE messages"}));
  auto rare = failure("a", {"restart", "low batteries", "late messages", "STATE messages", "GRANT messages"});
  rare.needs.is_rare = true;
  add(failures, {failure("a", {"restart"}), failure("a", {"breakdown", "restart"}), rare});
  EXPECT_EQ(findings_of(failures)[0].members.size(), 33U);
  add(failures, {failure("a", {"late messages", "STATE messages"})});
  EXPECT_EQ(findings_of(failures).size(), 2U) << "that one may need anything";
  add(failures, times(2, failure("a", {"breakdown", "restart"})));
  EXPECT_EQ(findings_of(failures).size(), 3U) << "three that need the same may have a fault of their own";
}

// Which kinds of messages are chance is not known of those that failed with one draw only. They join all the same.
TEST(Findings, WhatFailedWithOneDrawOnlyKeepsItsKindsOfMessages) {
  auto rare = failure("a", {"restart", "late messages", "STATE messages"});
  rare.needs.is_rare = true;
  auto failures = times(4, rare);
  add(failures, times(30, failure("a", {"late messages", "STATE messages"})));
  EXPECT_EQ(findings_of(failures).size(), 1U);
}

// Where most runs say a word, few failures can show that it tells. Of many that say it, more than chance do.
TEST(Findings, AWordIsThatOfAllIfItTellsMoreThanChance) {
  KnownFailure saying = failure("a", {"lost messages"});
  saying.needs.said = {"oops"};
  KnownFailure telling = saying;
  telling.needs.traits = {"says \"oops\""};
  auto failures = times(20, saying);
  add(failures, times(2, telling));
  add(failures, {saying});
  failures.back().needs.needs = {"restart"};
  EXPECT_EQ(findings_of(failures).size(), 2U);
  add(failures, times(6, telling));
  EXPECT_EQ(findings_of(failures).size(), 1U) << "one that says it came about in another way";
  EXPECT_EQ(findings_of(failures)[0].mechanism.text(), "too close, two AGVs; needs lost messages; says \"oops\"");
}

TEST(Findings, ARareSetOfNeedsTakesNobodyIn) {
  auto failures = times(2, failure("a", {}));
  add(failures, times(60, failure("a", {"lost messages"})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].members.size(), 60U);
  EXPECT_EQ(findings[1].mechanism.text(), "too close, two AGVs; needs nothing");
}

// A turn that sweeps too far needs nothing; who does not turn fails for another reason.
TEST(Findings, WhatTheBodiesDidTellsFindingsApart) {
  auto failures = times(10, failure("a", {}, {"one turns"}));
  add(failures, times(10, failure("a", {"lost messages"})));
  add(failures, times(3, failure("a", {"lost messages"}, {"one turns"})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].members.size(), 13U);
  EXPECT_EQ(findings[0].mechanism.doing, "one turns");
  EXPECT_EQ(findings[1].mechanism.doing, "");
}

TEST(Findings, TwoGeometricFaultsOfOneAgentAreTwoFindings) {
  auto failures = times(20, failure("a", {}, {"one turns"}));
  add(failures, times(10, failure("a", {}, {"one is on a bend"})));
  add(failures, times(1, failure("a", {})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].mechanism.text(), "too close, two AGVs; needs nothing; one turns");
  EXPECT_EQ(findings[1].mechanism.text(), "too close, two AGVs; needs nothing; one is on a bend");
  EXPECT_EQ(findings[0].members.size() + findings[1].members.size(), 31U);
  add(failures, times(4, failure("a", {})));
  EXPECT_EQ(findings_of(failures).size(), 1U) << "one in ten just drove on";
}

// Of twelve that did several things, none just drove on; of the next twelve, two may.
TEST(Findings, FewThatDidSeveralThingsAreNotParted) {
  auto few = times(10, failure("a", {}, {"one turns"}));
  add(few, times(2, failure("a", {}, {"one is on a bend"})));
  ASSERT_EQ(findings_of(few).size(), 1U);
  EXPECT_EQ(findings_of(few)[0].mechanism.doing, "");
  auto many = few;
  for (int i = 0; i < 3; ++i) add(many, few);
  EXPECT_EQ(findings_of(many).size(), 2U);
}

// Three failures of an agent: a bend is all that they share, and one of them shows that it is enough.
TEST(Findings, FewThatDidTheSameShareACore) {
  const std::vector<KnownFailure> failures = {failure("a", {}, {"one is on a bend", "one turns"}),
                                              failure("a", {"low batteries"}, {"one is on a bend"}),
                                              failure("a", {"breakdown", "low batteries"}, {"one is on a bend"})};
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].mechanism.text(), "too close, two AGVs; needs nothing; one is on a bend");
  auto apart = failures;
  apart[1].needs.doings.clear();
  EXPECT_GT(findings_of(apart).size(), 1U) << "one just drove on";
  apart = failures;
  apart[0].needs.needs = {"late messages"};
  EXPECT_GT(findings_of(apart).size(), 1U) << "that the bend is enough is not shown";
}

TEST(Findings, WordsTellFindingsApartButGiveNoName) {
  auto failures = times(10, failure("a", {}));
  const std::string id = findings_of(failures)[0].id();
  for (KnownFailure& known : failures) known.needs.traits = {"says \"oops\""};
  add(failures, times(5, failure("a", {"restart"})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U) << "who did not say it is no such failure";
  EXPECT_EQ(findings[0].id(), id);
  EXPECT_EQ(findings[0].mechanism.text(), "too close, two AGVs; needs nothing; says \"oops\"");
}

TEST(Findings, WhatFailedWithOneDrawOnlyJoinsOrIsNotKnown) {
  auto rare = failure("a", {"restart", "lost messages"});
  rare.needs.is_rare = true;
  auto failures = times(4, rare);
  rare.needs.needs = {"late messages"};
  add(failures, times(2, rare));
  const auto alone = findings_of(failures);
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone[0].mechanism.text(), "too close, two AGVs; needs not known: it failed with this luck only");
  EXPECT_EQ(alone[0].id(), "F-a041090e") << "users keep it in their files";
  add(failures, times(3, failure("a", {"lost messages"})));
  const auto joined = findings_of(failures);
  ASSERT_EQ(joined.size(), 2U);
  EXPECT_EQ(joined[0].members.size(), 7U);
}

TEST(Findings, WhoNeedsNothingInParticularSharesACore) {
  std::vector<KnownFailure> failures = {
      failure("a", {"restart", "late messages", "GRANT messages"}), failure("a", {"restart", "lost messages"}),
      failure("a", {"obstacles", "restart", "late messages"}), failure("a", {"low batteries"})};
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].mechanism.text(), "too close, two AGVs; needs restart");
  EXPECT_EQ(findings[0].members.size(), 3U);
}

// With few failures, each shows what the others that say the same do without.
TEST(Findings, FewThatSayTheSameShareACore) {
  std::vector<KnownFailure> failures = {failure("a", {"restart", "late messages", "GRANT messages"}),
                                        failure("a", {"restart", "late messages", "lost messages"})};
  for (KnownFailure& known : failures) known.needs.traits = {"says \"oops\""};
  const auto apart = findings_of(times(1, failures[0]));
  EXPECT_EQ(apart[0].mechanism.needs.size(), 2U) << "one does not tell which kinds of messages are chance";
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].mechanism.text(), "too close, two AGVs; needs restart, late messages; says \"oops\"");
  // One failure in four says something of its own: that is no word of the mechanism.
  add(failures, {failure("a", {"obstacles"}), failure("a", {"low batteries"}), failure("a", {"breakdown"})});
  EXPECT_EQ(findings_of(failures).size(), 5U);
}

// A short campaign and a long one give the same name.
TEST(Findings, FewAndManyThatSayTheSameHaveOneName) {
  KnownFailure saying = failure("a", {"lost messages", "STATE messages"});
  saying.needs.traits = {"says \"oops\""};
  const auto few = findings_of(times(4, saying)), many = findings_of(times(40, saying));
  ASSERT_EQ(few.size(), 1U);
  ASSERT_EQ(many.size(), 1U);
  EXPECT_EQ(few[0].id(), many[0].id());
}

// What came about otherwise once, in one campaign, does not change the name.
TEST(Findings, WhatMostOfTheFewNeedGivesTheName) {
  std::vector<KnownFailure> failures = {failure("a", {"restart", "late messages", "GRANT messages"}),
                                        failure("a", {"restart", "late messages", "lost messages"}),
                                        failure("a", {"doubled messages", "restart", "late messages"})};
  for (KnownFailure& known : failures) known.needs.traits = {"says \"oops\""};
  const std::string id = findings_of(failures)[0].id();
  add(failures, {failure("a", {"restart"})});
  failures.back().needs.traits = {"says \"oops\""};
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].id(), id);
  EXPECT_EQ(findings[0].mechanism.text(), "too close, two AGVs; needs restart, late messages; says \"oops\"");
}

// The same holds for many, if no set of needs is that of half of them.
TEST(Findings, ManyWithoutARuleShareACore) {
  std::vector<KnownFailure> failures;
  for (const char* kind : {"GRANT messages", "REQUEST messages", "STATE messages", "DEFER messages"})
    add(failures, times(4, failure("a", {"restart", "late messages", kind})));
  for (KnownFailure& known : failures) known.needs.traits = {"says \"oops\""};
  ASSERT_EQ(findings_of(failures).size(), 1U);
  EXPECT_EQ(findings_of(failures)[0].mechanism.needs, (std::vector<std::string>{"restart", "late messages"}));
}

// Too few runs to compare with, so its word was not seen to tell.
TEST(Findings, WhoHadSaidTheWordJoinsThem) {
  KnownFailure saying = failure("a", {});
  saying.needs.traits = {"says \"oops\""};
  KnownFailure other = failure("a", {"late messages"});
  other.needs.said = {"driving", "oops"};
  auto failures = times(20, saying);
  add(failures, times(1, other));
  EXPECT_EQ(findings_of(failures).size(), 1U);
  failures.back().needs.said = {"driving"};
  EXPECT_EQ(findings_of(failures).size(), 2U);
}

// Two of thirty do not say what the others say.
TEST(Findings, LoseNoFailure) {
  KnownFailure saying = failure("a", {"breakdown"});
  saying.needs.traits = {"says \"gone\""};
  auto failures = times(28, saying);
  add(failures, times(2, failure("a", {"breakdown"})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].members.size(), 30U);
}

// A failure may need that one of several messages is lost: which of them is chance.
TEST(Findings, KindsOfMessagesThatAreChanceDoNotPart) {
  std::vector<KnownFailure> failures;
  for (const char* kind : {"GRANT messages", "REQUEST messages", "DEFER messages"})
    add(failures, times(5, failure("a", {"lost messages", kind})));
  ASSERT_EQ(findings_of(failures).size(), 1U);
  EXPECT_EQ(findings_of(failures)[0].mechanism.text(), "too close, two AGVs; needs lost messages");
  add(failures, times(40, failure("a", {"lost messages", "GRANT messages"})));
  EXPECT_EQ(findings_of(failures)[0].mechanism.text(), "too close, two AGVs; needs lost messages, GRANT messages");
  EXPECT_EQ(findings_of(failures)[0].members.size(), 55U) << "the others may do without it by chance";
}

// One fault of five needs nothing. The other failures would need nothing either if it were theirs, too.
TEST(Findings, AFaultThatNeedsLittleDoesNotTakeThoseOfManyOthers) {
  auto failures = times(11, failure("a", {}));
  for (const char* need : {"doubled messages", "restart", "late messages", "lost messages"})
    add(failures, times(12, failure("a", {need})));
  EXPECT_EQ(findings_of(failures).size(), 5U);
  add(failures, times(12, failure("a", {})));
  EXPECT_EQ(findings_of(failures).size(), 1U) << "so many need nothing that the others may need theirs by chance";
}

// Without the restart, no draw failed; with it, some of them did without lost messages.
TEST(Findings, WhatWasTriedFirstAndIsNeededDecides) {
  auto failures = times(20, failure("a", {"lost messages"}));
  add(failures, times(10, failure("a", {"restart"})));
  add(failures, times(2, failure("a", {"restart", "lost messages"})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[1].mechanism.text(), "too close, two AGVs; needs restart");
  EXPECT_EQ(findings[1].members.size(), 12U);
}

// Two faults of one agent need lost messages. A word that tells nearly always, where it is said, is that of one of
// them.
TEST(Findings, AWordThatTellsWhereverItIsSaidPartsAndNames) {
  KnownFailure saying = failure("a", {"lost messages"});
  saying.needs.said = {"driving", "oops"};
  KnownFailure telling = saying;
  telling.needs.traits = {"says \"oops\""};
  KnownFailure silent = failure("a", {"lost messages"});
  silent.needs.said = {"driving"};
  auto failures = times(9, telling);
  add(failures, times(1, saying));
  const std::string alone = findings_of(failures)[0].id();
  EXPECT_EQ(alone, findings_of(times(5, silent))[0].id()) << "of few, the word is not known";
  add(failures, times(10, silent));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].members.size(), 10U);
  EXPECT_EQ(findings[1].members.size(), 10U);
  EXPECT_NE(findings[0].id(), findings[1].id());
  add(failures, times(5, saying));
  EXPECT_EQ(findings_of(failures).size(), 1U) << "the word is said where it does not tell";
}

// ---- needs that are none

TEST(Findings, TellNoNeedThatIsRefuted) {
  Finding finding;
  finding.agent = "a";
  finding.mechanism = {"too close, two AGVs", {"restart", "lost messages"}, "one turns", {}, {kThirdAgvTrait}};
  finding.members = {0, 1};
  const std::string id = finding.id();
  EXPECT_EQ(finding.text(), finding.mechanism.text());
  finding.refuted = {"restart", kThirdAgvTrait};
  EXPECT_EQ(finding.text(),
            "too close, two AGVs; needs lost messages; one turns (fails without restart, a third AGV, too)");
  EXPECT_EQ(finding.id(), id) << "it is the same finding";
  finding.is_searched = false;
  EXPECT_EQ(finding.text(), "too close, two AGVs; whether it needs what these failures needed is not known; one turns");
  finding.members = {0};
  EXPECT_EQ(finding.text(), "too close, two AGVs; one failure does not tell what it needs; one turns");
}

// A mechanism that was kept before a need of it was refuted.
TEST(Findings, AKeptMechanismIsToldWithoutWhatIsRefuted) {
  const std::string third = kThirdAgvTrait;
  const auto told = [](const std::string& kept, std::vector<std::string> refuted) {
    return without_refuted(kept, refuted);
  };
  EXPECT_EQ(told("e; needs a, b; one turns", {}), "e; needs a, b; one turns");
  EXPECT_EQ(told("e; needs a, b; one turns", {"b"}), "e; needs a; one turns (fails without b, too)");
  EXPECT_EQ(told("e; needs a; " + third, {"a", third}), "e; needs nothing (fails without a, a third AGV, too)");
  EXPECT_EQ(told("e; needs a (fails without b, too)", {"b", "a"}), "e; needs nothing (fails without b, a, too)");
  EXPECT_EQ(told("my own words", {"a"}), "my own words (fails without a, too)");
}

// Two AGVs that drive as they like touch without any third AGV, lost message or restart.
TEST(Refutation, ARunWithoutItRefutesANeed) {
  Bench reckless("reckless"), timeout("timeout-grant");
  const auto refuted = [](Bench& bench, std::vector<std::string> needs, std::vector<std::string> traits,
                          std::uint64_t trials, std::vector<Scenario> smaller = {}) {
    KnownFailure failure;
    const Scenario run = bench.failing(125);
    failure.needs = *needs_of(bench.host, run);
    failure.needs.needs = needs;  // as if it had needed these
    Finding finding;
    finding.mechanism = {failure.needs.end, needs, "", {}, traits};
    finding.members = {0};
    failure.needs.reduced = {run, *failure_of(bench.host(run)), 0};
    std::vector<std::string> found;
    add_refuted_needs(bench.host, finding, {&failure, 1}, {smaller, {&run, 1}, trials}, found);
    return found;
  };
  EXPECT_THAT(refuted(reckless, {"restart", kLostMessages}, {kThirdAgvTrait}, 100),
              ElementsAre("restart", kLostMessages, kThirdAgvTrait));
  EXPECT_THAT(refuted(reckless, {"restart"}, {}, 0), testing::IsEmpty()) << "nothing was tried";
  EXPECT_THAT(refuted(reckless, {"restart"}, {}, 0, {reckless.failing(125)}), ElementsAre("restart"))
      << "a smaller case is enough";
  // Silence that is taken for consent takes lost or late messages.
  EXPECT_THAT(refuted(timeout, {"restart", kLostMessages}, {}, 300), Contains("restart"));
}

TEST(Refutation, IsTheSameForAnyNumberOfWorkers) {
  std::vector<std::vector<std::string>> found;
  for (const int workers : {1, 4}) {
    Bench bench("timeout-grant", workers);
    const Scenario run = bench.failing(125);
    KnownFailure failure;
    failure.needs = *needs_of(bench.host, run);
    Finding finding;
    finding.mechanism = {failure.needs.end, failure.needs.needs, "", {}, failure.needs.traits};
    finding.members = {0};
    add_refuted_needs(bench.host, finding, {&failure, 1}, {{}, {&run, 1}, 200}, found.emplace_back());
  }
  EXPECT_EQ(found[0], found[1]);
}

// A need of which one failure of the finding did without is none, whatever was tried.
TEST(Refutation, AFailureThatDidWithoutRefutes) {
  Bench bench("reckless");
  std::vector<KnownFailure> failures{failure("reckless", {"restart"}), failure("reckless", {})};
  Finding finding;
  finding.mechanism = {"too close, two AGVs", {"restart"}, "", {}, {}};
  finding.members = {0, 1};
  std::vector<std::string> found;
  add_refuted_needs(bench.host, finding, failures, {{}, {}, 0}, found);
  EXPECT_THAT(found, ElementsAre("restart"));
  failures[1].needs.is_rare = true;
  found.clear();
  failures[0].needs.reduced.scenario = bad_night(1);
  add_refuted_needs(bench.host, finding, failures, {{}, {}, 0}, found);
  EXPECT_THAT(found, testing::IsEmpty()) << "what a rare one needs is not known";
}

TEST(Findings, EachAgentHasItsOwn) {
  auto failures = times(4, failure("a", {}));
  add(failures, times(4, failure("b", {})));
  const auto findings = findings_of(failures);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_NE(findings[0].id(), findings[1].id());
  EXPECT_EQ(findings[0].id(), findings_of(times(7, failure("a", {})))[0].id()) << "another campaign, the same name";
  EXPECT_THAT(findings[0].id(), testing::MatchesRegex("F-[0-9a-f]{8}"));
}

}  // namespace
}  // namespace fleetproof::findings_test
