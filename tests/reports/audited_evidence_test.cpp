// What audits change in a verdict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/formats/json_report.hpp"
#include "reports/formats/junit_report.hpp"
#include "reports/formats/text_report.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::audited_evidence_test {
namespace {

using samples::audit_of;
using samples::campaign_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;
using testing::Not;

GateRecord gate(GateKind kind = GateKind::Rate, GateUnit unit = GateUnit::World) {
  GateRecord gate;
  gate.name = "safe";
  gate.agent = "ours";
  gate.kind = kind;
  gate.unit = unit;
  gate.limit = 0.1;
  return gate;
}

CampaignRecord campaign(double audit_share = 0.0) {
  CampaignRecord record = campaign_of("claim", 100);
  record.plugin_agents = {"ours"};
  record.audit_share = audit_share;
  return record;
}

ReportInput judged(const GateRecord& gate, const std::vector<AuditedRun>& audits, const CampaignRecord& record,
                   const samples::Change& change = {}) {
  return report_of(record, grid({"ours"}, {0.0, 0.4}, {2.0}), {gate}, change, 0, 0, audits);
}

constexpr JudgedOutcome kViolated{bit_of(EndPoint::Violation), 0}, kUnknown{0, bit_of(EndPoint::Violation)};

TEST(AuditedEvidence, AnAuditThatFailsCountsAgainstTheClaimAndRefutesNoRate) {
  const auto input = judged(gate(), {audit_of(6, false, kViolated), audit_of(7, false, kViolated)}, campaign());
  EXPECT_EQ(input.gates[0].claim->failing, 1U) << "two runs of one world";
  EXPECT_EQ(input.gates[0].optimistic->failing, 0U);
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  std::vector<AuditedRun> all;
  for (std::uint64_t i = 0; i < 200; ++i) all.push_back(audit_of(i, false, kViolated));
  EXPECT_EQ(judged(gate(), all, campaign()).gates[0].verdict, Verdict::NotDemonstrated);
}

TEST(AuditedEvidence, AnAuditThatFailsRefutesAGateThatAllowsNone) {
  const auto input = judged(gate(GateKind::None), {audit_of(6, false, kViolated)}, campaign());
  EXPECT_EQ(input.gates[0].verdict, Verdict::Violated);
  EXPECT_THAT(input.gates[0].reason, HasSubstr("1 run failed when simulated once more, and this gate allows none"));
}

TEST(AuditedEvidence, AnAuditOfWhichNothingIsKnownCountsAgainstTheClaim) {
  const auto input = judged(gate(), {audit_of(6, false, kUnknown)}, campaign());
  EXPECT_EQ(input.gates[0].claim->failing, 1U);
  EXPECT_EQ(judged(gate(GateKind::None), {audit_of(6, false, kUnknown)}, campaign()).gates[0].verdict,
            Verdict::NotDemonstrated);
}

TEST(AuditedEvidence, OfEachCellCountInItsCell) {
  const auto input =
      judged(gate(GateKind::Rate, GateUnit::Run),
             {audit_of(6, false, kViolated), audit_of(7, false, kViolated), audit_of(9, false, kViolated)}, campaign());
  EXPECT_EQ(input.gates[0].claim->failing, 2U) << "cell 1";
}

// Another end point than that of the gate.
TEST(AuditedEvidence, AnotherJudgedOutcomeLeavesNoClaim) {
  const auto sound = judged(gate(), {audit_of(6, true), audit_of(8, true)}, campaign());
  EXPECT_EQ(sound.gates[0].verdict, Verdict::Demonstrated) << sound.gates[0].reason;
  const auto input =
      judged(gate(), {audit_of(6, false, {bit_of(EndPoint::Deadlock), 0}), audit_of(8, true)}, campaign());
  EXPECT_EQ(input.gates[0].claim->failing, 0U);
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(input.gates[0].reason, HasSubstr("1 of 2 audited runs were judged otherwise"));
  EXPECT_THAT(render_text(input), HasSubstr("1 of them was judged otherwise: another end point failed, or none did"));
  EXPECT_THAT(render_json(input), HasSubstr("\"weak\": true"));
  EXPECT_THAT(render_junit(input), HasSubstr("<failure type=\"audits\""));
  // Nor one that passed where the run failed.
  const auto better =
      judged(gate(), {audit_of(6, false)}, campaign(), [](RunRecord& run) { run.outcome.stuck = run.run_index == 6; });
  EXPECT_EQ(better.gates[0].verdict, Verdict::Demonstrated) << "standing still is no end point of its own";
  const auto lucky = judged(gate(), {audit_of(6, false)}, campaign(), [](RunRecord& run) {
    if (run.run_index == 6) samples::violate(run);
  });
  EXPECT_EQ(lucky.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_EQ(lucky.gates[0].claim->failing, 1U);
}

TEST(AuditedEvidence, AnotherTraceThatIsJudgedAlikeIsToldAndDecidesNothing) {
  const auto input = judged(gate(), {audit_of(6, false), audit_of(8, true)}, campaign());
  EXPECT_EQ(input.gates[0].verdict, Verdict::Demonstrated) << input.gates[0].reason;
  EXPECT_THAT(render_text(input), HasSubstr("50.0 % of the audited runs (1 of 2)"));
}

TEST(AuditedEvidence, AnyDifferenceLeavesNoClaimOfSoftwareThatPromisesToRepeat) {
  CampaignRecord record = campaign();
  record.deterministic_agents = {"ours"};
  const auto input = judged(gate(), {audit_of(6, false), audit_of(8, true)}, record);
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(input.gates[0].reason, HasSubstr("declares that it always does the same"));
}

// Of 200 runs, 20 are due first, and then the drawn ones.
TEST(AuditedEvidence, AnAuditThatIsDueAndWasNotDoneLeavesNoClaim) {
  const CampaignRecord record = campaign(0.02);
  const AuditShare share(record.seed, 0.02, grid({"ours"}, {0.0, 0.4}, {2.0}), {"ours"});
  std::vector<AuditedRun> due;
  for (std::uint64_t i = 0; i < 200; ++i) {
    if (share.contains(static_cast<std::uint32_t>(i % 2), i / 2)) due.push_back(audit_of(i, true));
  }
  ASSERT_GE(due.size(), kAuditsToPass);
  const auto done = judged(gate(), due, record);
  EXPECT_EQ(done.gates[0].verdict, Verdict::Demonstrated) << done.gates[0].reason;
  const AuditedRun missing = due.back();
  due.pop_back();
  const auto open = judged(gate(), due, record);
  EXPECT_EQ(open.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(open.gates[0].reason, HasSubstr("1 audit is due, and was not done"));
  EXPECT_THAT(render_text(open), HasSubstr("audits open | agent ours: 1 audit due and not done"));
  // A run that hung is not audited.
  const auto hung =
      judged(gate(), due, record, [&](RunRecord& run) { run.outcome.hang = run.run_index == missing.audit.run_index; });
  EXPECT_EQ(hung.gates[0].verdict, Verdict::Demonstrated) << hung.gates[0].reason;
}

// Files of earlier schemas do not say what a differing audit came to.
TEST(AuditedEvidence, ADifferenceOfWhichNothingIsKnownLeavesNoClaim) {
  AuditedRun audit = audit_of(6, false);
  audit.audit.outcome.reset();
  const auto input = judged(gate(), {audit}, campaign());
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_EQ(input.gates[0].claim->failing, 0U);
}

TEST(AuditedEvidence, OfThroughputTakesTheAuditsOwnWork) {
  GateRecord fast = gate();
  fast.end_point = EndPoint::Throughput;
  fast.min_transports_per_agv_hour = 9.0;  // the sample has 12
  AuditedRun slow = audit_of(6, false);
  slow.audit.outcome->transports_done = 1;  // of the world, 6.6
  EXPECT_EQ(judged(fast, {slow}, campaign()).gates[0].claim->failing, 1U);
  EXPECT_EQ(judged(fast, {slow}, campaign()).gates[0].optimistic->failing, 0U);
  slow.audit.outcome->transports_done = 9;  // 11.4
  EXPECT_EQ(judged(fast, {slow}, campaign()).gates[0].claim->failing, 0U);
  fast.unit = GateUnit::Run;
  slow.audit.outcome->transports_done = 7;
  EXPECT_EQ(judged(fast, {slow}, campaign()).gates[0].claim->failing, 1U);
}

}  // namespace
}  // namespace fleetproof::audited_evidence_test
