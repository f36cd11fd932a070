// The worlds and campaigns whose pages say that every fault happens in them.
#include <gtest/gtest.h>

#include <set>

#include "campaign/plan/campaign_file.hpp"
#include "generators/worlds/world_fields.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::every_fault_test {
namespace {

// Of the fields that make something go wrong. The others say for how long. Clocks that agree are no fault.
std::set<std::string> faults_left_out(const FaultRates& faults) {
  std::set<std::string> left_out;
  visit_fields(faults, [&](const Field& field, double value) {
    const std::string key(field.key);
    const bool is_fault = key.ends_with("_per_agv_hour") || key.ends_with("_per_transport") ||
                          key.ends_with("s_per_hour") || key.starts_with("clock_") || key.starts_with("position_") ||
                          key == "low_battery_share";
    if (is_fault && value <= 0.0) left_out.insert(key);
  });
  return left_out;
}

const std::set<std::string> kOnTheFloor = {"load_drops_per_transport", "obstacles_per_hour"};
// The sound agent keeps nothing: to it the loss of a disk is a restart.
const std::string kOfDisks = "disk_losses_per_agv_hour";

TEST(EveryFault, HappensInTheHardWorld) { EXPECT_EQ(faults_left_out(test::hard_world(60.0).faults), kOnTheFloor); }

TEST(EveryFault, HappensInTheHostilePlan) {
  EXPECT_EQ(faults_left_out(test::hostile_plan().faults), std::set<std::string>());
}

TEST(EveryFault, HappensInTheCampaignOfFaults) {
  const auto file = read_campaign_file(test::source("tests/campaigns/faults.toml"));
  std::set<std::string> left_out = kOnTheFloor;
  left_out.insert(kOfDisks);
  EXPECT_EQ(faults_left_out(file.plan.faults), left_out);
}

TEST(EveryFault, IsMissedIfItsRateIsZero) {
  const std::set<std::string> missed = faults_left_out(FaultRates{});
  for (const char* key : {"breakdowns_per_transport", "obstacles_per_hour", "clock_drift_ppm", "position_error_m"})
    EXPECT_TRUE(missed.contains(key)) << key;
  EXPECT_GE(missed.size(), kRecurringFaults.size() + 8);
}

TEST(EveryFault, IsDrawnWithATopicOfItsOwn) {
  std::set<FaultTopic> topics;
  std::set<Fault::Kind> kinds{Fault::Kind::LoadDrop, Fault::Kind::Named};  // of transports, and of computers
  for (const RecurringFault& fault : kRecurringFaults) {
    topics.insert(fault.topic);
    kinds.insert(fault.kind);
    EXPECT_EQ(fault.most_s != nullptr, fault.lasting == RecurringFault::Lasting::Uniform) << name_of(fault.kind);
  }
  EXPECT_EQ(topics.size(), kRecurringFaults.size());
  EXPECT_EQ(kinds.size(), kValuesOf<Fault::Kind>.size()) << "campaigns draw each kind";
}

}  // namespace
}  // namespace fleetproof::every_fault_test
