#include "campaign/findings/retest.hpp"

#include <gmock/gmock.h>

#include "campaign/findings/finding_record.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof {
namespace {

using testing::HasSubstr;
using Bench = test::CaseBench;

struct Known {
  KeptFailure kept;
  NeighbourCounts before;
};

Known known_failure(Bench& bench) {
  const auto needs = needs_of(bench.host, bench.failing(125));
  Finding finding;
  finding.mechanism = {needs->end, needs->needs, {}, {}};
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

}  // namespace
}  // namespace fleetproof
