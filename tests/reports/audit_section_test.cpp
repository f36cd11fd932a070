#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/sections/audit_section.hpp"
#include "reports/sections/report_input.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "storage/checksum.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::audit_section_test {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

CellRecord cell(std::uint32_t index, const std::string& agent) {
  CellRecord record;
  record.index = index;
  record.agent = agent;
  record.layout = "ring";
  record.fleet_size = 2;
  return record;
}

// Two agents in turn; run 1 and then every second one is of the plug-in "candidate".
struct Campaign {
  CampaignRecord record;
  std::vector<CellRecord> cells{cell(0, "hull-lock"), cell(1, "candidate")};
  Campaign() {
    record.name = "night";
    record.kind = "claim";
    record.replicates = 10;
    record.plugin_agents = {"candidate"};
  }
};

ReportInput report_with(const std::vector<std::pair<std::uint64_t, bool>>& audits) {
  const Campaign campaign;
  std::vector<AuditedRun> audited;
  for (const auto& [run_index, same] : audits) audited.push_back(samples::audit_of(run_index, same));
  return samples::report_of(campaign.record, campaign.cells, {}, {}, 0, 0, audited);
}

TEST(AuditSection, CountsTheAuditsOfEachAgent) {
  const ReportInput input = report_with({{0, true}, {1, true}, {3, false}, {5, true}, {7, false}});
  ASSERT_THAT(input.evidence.audits().agents(), SizeIs(2));
  const AgentAudit& candidate = input.evidence.audits().agents()[1];
  EXPECT_EQ(candidate.agent, "candidate");
  EXPECT_EQ(candidate.audited, 4U);
  EXPECT_EQ(candidate.differing, 2U);
  EXPECT_EQ(candidate.first_differing, 3U);
  EXPECT_FALSE(input.evidence.audits().engine_at_fault()) << "a plug-in may do something else each time";
  EXPECT_THAT(audit_headlines(input),
              ElementsAre(Field(&Headline::text, HasSubstr("agent candidate: this software is not deterministic in "
                                                           "50.0 % of the audited runs (2 of 4), first in run 3."))));
  EXPECT_THAT(audit_section(input).remarks[1].text, HasSubstr("hull-lock: 1 run was audited, and it came out"));
}

TEST(AuditSection, SoftwareThatDependsOnEarlierRunsIsCalledThat) {
  ReportInput input = report_with({{1, true}, {3, false}});
  input.attempts.dependent_agents = {"candidate"};
  const auto headlines = audit_headlines(input);
  ASSERT_THAT(headlines, SizeIs(1));
  EXPECT_EQ(headlines[0].word, "depends on earlier runs");
  EXPECT_THAT(headlines[0].text, HasSubstr("agent candidate: this software depends on earlier runs of the same process "
                                           "in 50.0 % of the audited runs (1 of 2), first in run 3."));
  EXPECT_THAT(headlines[0].text, HasSubstr("its hello says \"runs\": \"one\""));
  EXPECT_THAT(audit_section(input).remarks[2].text,
              HasSubstr("candidate: depends on earlier runs of the same process"));
  input.attempts.log_is_foreign = true;
  EXPECT_EQ(audit_headlines(input)[0].word, "not deterministic");
}

TEST(AuditSection, AReferenceAgentThatComesOutDifferentlyIsAnErrorOfTheEngine) {
  const ReportInput input = report_with({{0, true}, {2, false}});
  EXPECT_TRUE(input.evidence.audits().engine_at_fault());
  const auto headlines = audit_headlines(input);
  ASSERT_THAT(headlines, SizeIs(1));
  EXPECT_EQ(headlines[0].word, "engine error");
  EXPECT_THAT(headlines[0].details[0].command, HasSubstr("replay night.fp 2"));
}

TEST(AuditSection, SaysThatNothingWasAudited) {
  const ReportInput input = report_with({});
  EXPECT_THAT(audit_headlines(input), IsEmpty());
  EXPECT_THAT(audit_section(input).remarks[2].text, HasSubstr("candidate: no run was audited"));
}

// From the file to the exit code.
TEST(AuditSection, AnErrorOfTheEngineConcludesTheReport) {
  for (const bool same : {true, false}) {
    const samples::TemporaryFolder folder;
    const std::string path = folder / "night.fp";
    const Campaign campaign;
    ArchiveWriter writer(path, {campaign.record, campaign.cells, {}});
    for (std::uint64_t i = 0; i < 20; ++i) {
      const RunRecord run = samples::clean_run(i, 2);
      writer.add(run);
      if (i == 4) writer.add(AuditRecord{i, row_checksum(run) ^ (same ? 0U : 1U)});
    }
    writer.publish(20);
    EXPECT_EQ(conclusion_of(read_report_input(ArchiveReader(path), path)),
              same ? Conclusion::NotDemonstrated : Conclusion::EngineFault);
  }
}

}  // namespace
}  // namespace fleetproof::audit_section_test
