#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "campaign/findings/finding.hpp"
#include "campaign/findings/findings_file.hpp"
#include "campaign/findings/ingredients.hpp"
#include "campaign/findings/keeper.hpp"
#include "campaign/findings/retest.hpp"
#include "core/base/error.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// A warehouse at the contract's worst radio, with restarts.
Scenario bad_night(std::uint64_t seed) {
  WorldSpec spec;
  spec.fleet_size = 5;
  spec.horizon = std::chrono::seconds(60);
  spec.demand.transports_per_agv_hour = 60.0;
  RejectionCounts ignored;
  Scenario scenario = generate_world(spec, seed, ignored);
  scenario.radio.loss = 0.4;
  scenario.radio.delay_s = 2.0;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  scenario.radio.duplicates = 0.1;
  for (std::uint32_t agv = 0; agv < 5; ++agv)
    scenario.faults.push_back({.kind = Fault::Kind::Restart,
                               .agv = AgvId{agv},
                               .at = seconds(7.0 * agv),
                               .transport = {},
                               .lasts = seconds(0.5)});
  return scenario;
}

struct Bench {
  explicit Bench(const std::string& agent, int workers = 2) : host({agent, ""}, programs, workers) {}
  Scenario failing(std::uint64_t seed) {
    for (;; ++seed) {
      Scenario scenario = bad_night(seed);
      if (failure_of(host(scenario))) return scenario;
    }
  }

  AgentPrograms programs;
  CaseHost host;
};

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
  for (const MessageFate& message : bench.host(bare, Fates::Kept).fates) EXPECT_FALSE(message.is_adverse());
}

// ---- what a failure needs

TEST(FailureNeeds, SilenceTakenForConsentNeedsLostMessagesAndNoFault) {
  Bench bench("timeout-grant");
  std::size_t right = 0;
  for (std::uint64_t seed = 100; seed < 800; seed += 100) {
    const auto found = needs_of(bench.host, bench.failing(seed));
    ASSERT_TRUE(found);
    EXPECT_LE(found->replays, kReplaysPerFailure);
    EXPECT_EQ(found->end, "too close, two AGVs");
    right += std::ranges::count(found->needs, std::string(kLostMessages)) == 1 &&
             std::ranges::count(found->needs, std::string("restart")) == 0;
    const auto again = failure_of(bench.host(found->reduced.scenario));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->at, found->reduced.failure.at);
  }
  EXPECT_GE(right, 6U) << "of 7";
}

TEST(FailureNeeds, AForgottenLaneNeedsARestart) {
  Bench bench("restart-forgets-lane");
  const auto found = needs_of(bench.host, bench.failing(1));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->needs, Contains("restart"));
  EXPECT_THAT(found->needs, Not(Contains(kCopiedMessages)));
}

TEST(FailureNeeds, OfARunWithoutAFailureThereAreNone) {
  Bench bench("hull-lock");
  EXPECT_FALSE(needs_of(bench.host, bad_night(1)));
}

// ---- findings

KnownFailure failure(const std::string& agent, std::vector<std::string> needs, std::vector<std::string> traits = {},
                     std::uint64_t run = 0) {
  KnownFailure known;
  known.run = run;
  known.agent = agent;
  known.needs.end = "too close, two AGVs";
  known.needs.needs = std::move(needs);
  known.needs.traits = std::move(traits);
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
  EXPECT_THAT(findings[0].mechanism.traits, ElementsAre("one turns"));
  EXPECT_TRUE(findings[1].mechanism.traits.empty());
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

// ---- findings file

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
  static KeptFinding odd() {
    KeptFinding finding;
    finding.id = "F-00000001";
    finding.mechanism = "too close; says \"a\\b\"";
    finding.end = "too close";
    finding.ways = {{"lost messages", "the \"x\" messages"}, {}};
    finding.found_in = "a\tb";
    finding.smallest = "c.json";
    finding.world = "w.json";
    finding.neighbours = {1000, 17, {{"no progress", 3}, {"a \"b\"", 4}}, {}};
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
  const KeptFinding* read = file.find("F-00000001");
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(toml_of(*read), toml_of(odd()));
  EXPECT_EQ(read->ways, odd().ways);
  EXPECT_EQ(read->neighbours.otherwise, odd().neighbours.otherwise);
  EXPECT_EQ(file.find("F-00000002"), nullptr);
  EXPECT_TRUE(FindingsFile((folder_ / "none.toml").string()).findings().empty());
}

TEST_F(FindingsFiles, ErrorsNameTheLineAndTheRemedy) {
  const std::string good = toml_of(odd());
  EXPECT_EQ(error_of(good), "");
  EXPECT_THAT(error_of(good + good), HasSubstr("twice"));
  EXPECT_THAT(error_of("[[finding]]\nid = \"F-1\"\n"), HasSubstr("mechanism"));
  EXPECT_THAT(error_of(good + "stats = 3\n"), HasSubstr("stats"));
  auto waived = odd();
  waived.status = FindingStatus::Waived;
  EXPECT_THAT(error_of(toml_of(waived)), HasSubstr("until"));
  EXPECT_THAT(error_of(toml_of(waived)), HasSubstr("findings.toml:5"));
}

TEST_F(FindingsFiles, AWaiverEnds) {
  KeptFinding kept = odd();
  EXPECT_EQ(standing_of(nullptr, "2026-11-23"), "new");
  EXPECT_EQ(standing_of(&kept, "2026-11-23"), "known");
  EXPECT_FALSE(needs_attention(&kept, "2026-11-23"));
  kept.status = FindingStatus::Waived;
  kept.until = "2026-11-23";
  EXPECT_FALSE(needs_attention(&kept, "2026-11-23"));
  EXPECT_TRUE(needs_attention(&kept, "2026-11-24"));
  EXPECT_EQ(standing_of(&kept, "2026-11-24"), "known (waived until 2026-11-23)");
  kept.status = FindingStatus::Fixed;
  EXPECT_EQ(standing_of(&kept, "2026-11-23"), "back");
  EXPECT_TRUE(needs_attention(&kept, "2026-11-23"));
}

// ---- retest

struct Known {
  KeptFailure kept;
  NeighbourCounts before;
};

Known known_failure(Bench& bench) {
  const auto needs = needs_of(bench.host, bench.failing(100));
  Finding finding;
  finding.mechanism = {needs->end, needs->needs, needs->traits};
  const FindingRecord record = record_of(bench.host, finding, *needs, 4000);
  return {record.kept, record.neighbours};
}

constexpr std::uint32_t kSome = 200;

TEST(Retest, TellsAFixFromALuckyEscape) {
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

TEST(Retest, ANewFaultInPlaceOfTheOldOneIsANewKind) {
  Bench bench("timeout-grant");
  const Known known = known_failure(bench);
  Bench other("reckless");
  const Retest result = retest(other.host, known.kept, known.before, kSome);
  EXPECT_EQ(result.verdict, RetestVerdict::NewKind);
  EXPECT_GT(result.now.alike, 0U);
  EXPECT_THAT(result.new_kind, HasSubstr("needs"));
}

TEST(Retest, IsTheSameForAnyNumberOfWorkers) {
  Bench one("timeout-grant", 1), seven("timeout-grant", 7);
  const Known known = known_failure(one), again = known_failure(seven);
  EXPECT_EQ(to_text(known.kept.smallest), to_text(again.kept.smallest));
  EXPECT_EQ(to_text(known.kept.world), to_text(again.kept.world));
  EXPECT_EQ(known.before.alike, again.before.alike);
  EXPECT_EQ(known.before.otherwise, again.before.otherwise);
}

}  // namespace
}  // namespace fleetproof
