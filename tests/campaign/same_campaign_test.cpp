#include "campaign/batch/same_campaign.hpp"

#include <gmock/gmock.h>

#include "campaign/plan/plan_text.hpp"
#include "core/base/error.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"

namespace fleetproof::same_campaign_test {
namespace {

using testing::HasSubstr;

CampaignRecord record_of(const CampaignPlan& plan) {
  CampaignRecord record;
  record.name = plan.name;
  record.replicates = plan.replicates;
  record.plan_json = plan_text(plan);
  if (plan.is_drawn()) record.sampling = name_of(plan.sampling);
  record.engine = {"1.0", "aaaa", "GNU", "-O2", "TBB 1"};
  return record;
}

std::string refusal(const CampaignRecord& stored, CampaignRecord now, bool allow_drift = false) {
  try {
    require_same_campaign("night.db", stored, now, allow_drift);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SameCampaign, MayGoOnAndMayGrow) {
  CampaignPlan plan = test::small_plan();
  const CampaignRecord stored = record_of(plan);
  EXPECT_EQ(refusal(stored, stored), "");
  plan.replicates += 5;
  EXPECT_EQ(refusal(stored, record_of(plan)), "");
  EXPECT_THAT(refusal(record_of(plan), stored), HasSubstr("never shrinks"));
}

TEST(SameCampaign, AKeyThatAnOlderVersionDidNotKnowHasItsDefault) {
  CampaignPlan plan = test::small_plan();
  CampaignRecord stored = record_of(plan);
  const auto limits = stored.plan_json.find(" \"limits\": {");
  ASSERT_NE(limits, std::string::npos);
  stored.plan_json.erase(limits, stored.plan_json.find("},", limits) + 2 - limits);
  EXPECT_EQ(refusal(stored, record_of(plan)), "");
  plan.limits.cpu_s = 20.0;
  EXPECT_THAT(refusal(stored, record_of(plan)), HasSubstr("plan/limits/cpu_s: stored 5.0, now 20.0"));
}

TEST(SameCampaign, EveryOtherDifferenceIsNamed) {
  CampaignPlan plan = test::small_plan();
  const CampaignRecord stored = record_of(plan);
  plan.seed = 78;
  plan.law.safety_distance_m = 0.2;
  const std::string refused = refusal(stored, record_of(plan), true);
  EXPECT_THAT(refused, HasSubstr("night.db: this file holds runs of another campaign"));
  EXPECT_THAT(refused, HasSubstr("plan/seed: stored 77, now 78"));
  EXPECT_THAT(refused, HasSubstr("plan/law/safety_distance_m: stored 0.1, now 0.2"));
  plan = test::small_plan();
  plan.agents.pop_back();
  EXPECT_THAT(refusal(stored, record_of(plan)), HasSubstr("plan/factors/agents/2: stored \"reckless\", now nothing"));
}

// Its bounds hold for the number that was planned before run 0.
TEST(SameCampaign, WithAFixedGateItCannotGrow) {
  CampaignPlan plan = test::small_plan();
  GateRecord gate;
  gate.name = "safe";
  gate.agent = plan.agents.front().name;
  gate.method = GateMethod::Fixed;
  plan.gates = {gate};
  const CampaignRecord stored = record_of(plan);
  EXPECT_EQ(refusal(stored, stored), "");
  plan.replicates += 5;
  EXPECT_THAT(refusal(stored, record_of(plan)), HasSubstr("a gate of the method \"fixed\" cannot grow"));
  plan.gates[0].method = GateMethod::AnyTime;
  const CampaignRecord longer = record_of(plan);
  plan.replicates -= 5;
  EXPECT_EQ(refusal(record_of(plan), longer), "");
}

TEST(SameCampaign, ALatinHypercubeCannotGrow) {
  CampaignPlan plan = test::small_plan();
  plan.factors[Factor::Loss] = {FactorSpan(0.0, 0.4)};
  plan.sampling = Sampling::LatinHypercube;
  const CampaignRecord stored = record_of(plan);
  EXPECT_EQ(refusal(stored, stored), "");
  ++plan.replicates;
  EXPECT_THAT(refusal(stored, record_of(plan)), HasSubstr("latin-hypercube"));
}

TEST(SameCampaign, AnotherEngineIsRefusedOrRecorded) {
  const CampaignRecord stored = record_of(test::small_plan());
  CampaignRecord now = stored;
  now.engine.program_sha256 = "bbbb";
  now.engine.libraries = "TBB 2, plug-in x sha256 1";
  EXPECT_THAT(refusal(stored, now),
              HasSubstr("program sha256: stored aaaa, now bbbb; libraries and plug-ins: stored TBB 1"));
  CampaignRecord drifted = now;
  require_same_campaign("night.db", stored, drifted, true);
  EXPECT_EQ(drifted.engine.libraries, "TBB 2, plug-in x sha256 1; begun by fleetproof 1.0 sha256 aaaa (GNU; TBB 1)");
  // Another session of the second engine: nothing has changed since.
  CampaignRecord again = now;
  require_same_campaign("night.db", drifted, again, false);
  EXPECT_EQ(again.engine, drifted.engine);
  CampaignRecord third = stored;
  third.engine.program_sha256 = "cccc";
  require_same_campaign("night.db", drifted, third, true);
  EXPECT_THAT(third.engine.libraries, HasSubstr("begun by fleetproof 1.0 sha256 bbbb"));
  EXPECT_THAT(third.engine.libraries, HasSubstr("begun by fleetproof 1.0 sha256 aaaa"));
}

TEST(SameCampaign, AnotherBuildOfThePluginIsNoOtherEngine) {
  CampaignRecord stored = record_of(test::small_plan());
  stored.engine.libraries = "TBB 1, plug-in x sha256 1";
  CampaignRecord now = stored;
  now.engine.libraries = "TBB 1, plug-in x sha256 2, plug-in y sha256 3";
  EXPECT_THAT(refusal(stored, now), HasSubstr("another build of the control software wrote this file"));
  EXPECT_THAT(refusal(stored, now), HasSubstr("--overwrite begins again"));
  now.engine.libraries = "TBB 2, plug-in x sha256 1";
  EXPECT_THAT(refusal(stored, now), HasSubstr("another engine wrote this file"));
}

}  // namespace
}  // namespace fleetproof::same_campaign_test
