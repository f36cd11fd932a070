#include "reports/sections/head_notes.hpp"

#include <gmock/gmock.h>

#include "reports/sections/verdict_sentences.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::head_notes_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

void stall(RunRecord& run, IncidentKind kind) {
  Incident incident;
  incident.kind = kind;
  incident.first = at_seconds(100.0);
  incident.last = at_seconds(160.0);
  file_incidents(run.outcome, {incident});
}

// Two agents of which "ours" is under test, inside the contract and beyond it: cells 0 to 3.
ReportInput stalling(EndPoint gated, const samples::Change& change, const std::vector<AuditedRun>& audits = {}) {
  GateRecord gate = samples::gate_of("ours", GateKind::Rate, Region::Contract, 0.1);
  gate.end_point = gated;
  return samples::report_of(samples::campaign_of("claim", 20), samples::grid({"ours", "theirs"}, {0.4, 0.8}, {1.0}),
                            {gate}, change, 0, 0, audits);
}

std::string texts(const std::vector<Remark>& remarks) {
  std::string all;
  for (const Remark& remark : remarks) all += remark.text + "\n";
  return all;
}

TEST(HeadNotes, TellTheStalledWorldsOfTheAgentUnderTestWithinTheContract) {
  const auto input = stalling(EndPoint::Violation, [](RunRecord& run) {
    if (run.replicate < 3) stall(run, IncidentKind::Deadlock);  // in every cell, of both agents
    if (run.replicate == 5 && run.cell == 0) stall(run, IncidentKind::Starvation);
    if (run.replicate == 6 && run.cell == 1) stall(run, IncidentKind::Livelock);  // beyond the contract
  });
  EXPECT_THAT(
      stall_notes(input),
      ElementsAre(AllOf(Field(&Remark::text, HasSubstr("ours stalled in 4 of 20 worlds of the contract region")),
                        Field(&Remark::command, EndsWith(" 0")))));
  EXPECT_THAT(texts(stall_notes(input)), HasSubstr("No gate judges that."));
}

TEST(HeadNotes, NameTheFirstRunThatStalledInTheFirstOfTheseWorlds) {
  const auto input = stalling(EndPoint::Violation, [](RunRecord& run) {
    if (run.replicate >= 5) stall(run, IncidentKind::Starvation);
    if (run.replicate == 2 && run.cell == 1) stall(run, IncidentKind::Livelock);  // beyond the contract
  });
  EXPECT_THAT(stall_notes(input), ElementsAre(Field(&Remark::command, EndsWith(" 20"))));
}

TEST(HeadNotes, ACampaignWithoutGatesTellsThemBesideThatItDemonstratesNothing) {
  const auto stalls = [](RunRecord& run) { stall(run, IncidentKind::Starvation); };
  const auto input = samples::report_of(samples::campaign_of("search", 20),
                                        samples::grid({"ours", "theirs"}, {0.4, 0.8}, {1.0}), {}, stalls);
  const std::vector<Headline> head = verdicts(input);
  ASSERT_EQ(head.size(), 1U);
  EXPECT_THAT(texts(head.front().details), HasSubstr("ours stalled in 20 of 20 worlds"));
}

TEST(HeadNotes, AGateOnProgressJudgesThem) {
  const auto input = stalling(EndPoint::Deadlock, [](RunRecord& run) { stall(run, IncidentKind::Deadlock); });
  EXPECT_THAT(texts(stall_notes(input)), HasSubstr("20 of 20"));
  EXPECT_THAT(texts(stall_notes(input)), Not(HasSubstr("No gate")));
}

TEST(HeadNotes, WhatAContactExplainsIsNoStall) {
  const auto input = stalling(EndPoint::Violation, [](RunRecord& run) {
    samples::violate(run, 0, true);
    stall(run, IncidentKind::Deadlock);
  });
  EXPECT_THAT(stall_notes(input), IsEmpty());
}

TEST(HeadNotes, NameAPlantOnWhichAgvsOnlyFollowEachOther) {
  const auto meeting = [](const std::vector<ProbeCount>& probes) {
    return meeting_notes(stalling(EndPoint::Violation, [&](RunRecord& run) {
      run.outcome.probes.clear();
      file_probes(run.outcome, probes);
    }));
  };
  const ProbeCount following{ProbeSource::World, "following", 9};
  EXPECT_THAT(meeting({following}),
              ElementsAre(Field(&Remark::text,
                                HasSubstr("ours only followed other AGVs: no run had drives of two AGVs that"))));
  for (const char* other : {"head-on", "crossing", "merging"})
    EXPECT_THAT(meeting({following, {ProbeSource::World, other, 1}}), IsEmpty()) << other;
  EXPECT_THAT(meeting({}), ElementsAre(Field(&Remark::text, HasSubstr("In 40 of 40 runs of ours no two AGVs met"))));
  EXPECT_THAT(meeting({following, {ProbeSource::Agent, "crossing", 1}}), Not(IsEmpty())) << "an agent declares it";
}

TEST(HeadNotes, TellInHowManyRunsNobodyWasMet) {
  const auto meeting = [](std::uint64_t from) {
    return texts(meeting_notes(stalling(EndPoint::Violation, [&](RunRecord& run) {
      run.outcome.probes.clear();
      if (run.replicate >= from) file_probes(run.outcome, {{ProbeSource::World, "crossing", 1}});
    })));
  };
  EXPECT_EQ(meeting(11), "In 22 of 40 runs of ours no two AGVs met.\n");
  EXPECT_EQ(meeting(10), "") << "they did in half of the runs";
}

TEST(HeadNotes, SayThatTheSimulatorWasChecked) {
  const auto with = [](const std::vector<AuditedRun>& audits) { return stalling(EndPoint::Violation, {}, audits); };
  EXPECT_THAT(texts(soundness_notes(with({}))), HasSubstr("No run was simulated once more"));
  const AuditedRun first = samples::audit_of(0, true), second = samples::audit_of(3, true);
  EXPECT_THAT(texts(soundness_notes(with({first, second}))),
              HasSubstr("No run ended in an error of the simulator. 2 runs were simulated once more"));
  EXPECT_THAT(soundness_notes(with({first, second, samples::audit_of(5, false)})), IsEmpty()) << "a headline says more";
}

TEST(HeadNotes, NameFleetsThatSendNoMessages) {
  const auto silent = [](std::uint64_t below, std::uint32_t agvs = 5) {
    return texts(silence_notes(stalling(EndPoint::Violation, [&](RunRecord& run) {
      if (run.replicate < below) run.outcome.counters.messages_sent = 0;
      run.outcome.agv_count = agvs;
    })));
  };
  EXPECT_THAT(silent(20), HasSubstr("The AGVs of ours sent no message in 40 of 40 runs with two or more of them"));
  EXPECT_THAT(silent(2), HasSubstr("in 4 of 40 runs"));
  EXPECT_THAT(silent(2), Not(HasSubstr("theirs")));
  EXPECT_EQ(silent(1), "") << "fewer than one in ten";
  EXPECT_EQ(silent(20, 1), "") << "one AGV has nobody to talk to";
}

TEST(HeadNotes, SayHowManyRunsMayComeOutOtherwise) {
  const auto of = [](const std::vector<AuditedRun>& audits, const std::string& plugin = "ours") {
    CampaignRecord campaign = samples::campaign_of("claim", 20);
    campaign.plugin_agents = {plugin};
    return texts(repeat_notes(samples::report_of(campaign, samples::grid({"ours", "theirs"}, {0.4, 0.8}, {1.0}),
                                                 {samples::gate_of("ours", GateKind::Rate, Region::Contract, 0.1)}, {},
                                                 0, 0, audits)));
  };
  EXPECT_EQ(of({}), "");
  EXPECT_EQ(of({samples::audit_of(0, true), samples::audit_of(1, true), samples::audit_of(2, true)}),
            "With 95 % confidence, at most 77.7 % of the runs of ours would come out otherwise if they were simulated "
            "once more: 2 were, and none did.\n")
      << "1 - 0.05^(1/2); the third is theirs";
  EXPECT_EQ(of({samples::audit_of(0, true), samples::audit_of(1, false)}), "") << "a headline says more";
  EXPECT_EQ(of({samples::audit_of(0, true)}, "theirs"), "") << "reference agents always do the same";
}

TEST(HeadNotes, SayThatNobodyTriedPlantedFaults) {
  auto input = stalling(EndPoint::Violation, {});
  EXPECT_THAT(texts(sensitivity_notes(input)), HasSubstr("planted faults these worlds detect was not measured"));
  input.sensitivity.trouble = "c.sensitivity.json: is a folder";
  EXPECT_EQ(texts(sensitivity_notes(input)), "c.sensitivity.json: is a folder\n");
}

TEST(HeadNotes, AreSilentAboutSoundnessBesideAnEngineError) {
  const auto input = stalling(EndPoint::Violation, [](RunRecord& run) {
    if (run.run_index == 7) run.outcome.engine_error = true;
  });
  EXPECT_THAT(soundness_notes(input), IsEmpty());
}

}  // namespace
}  // namespace fleetproof::head_notes_test
