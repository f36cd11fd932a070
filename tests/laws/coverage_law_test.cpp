#include "laws/coverage_law.hpp"

#include <gmock/gmock.h>

#include <map>

#include "core/engine/simulation.hpp"
#include "laws/encounter.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/laws/told.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::coverage_law_test {
namespace {

using Met = std::map<std::string, std::uint64_t>;

Met met(const LawResults& findings) {
  Met counts;
  for (const ProbeCount& probe : findings.met) {
    if (probe.count > 0) counts[probe.name] = probe.count;
  }
  return counts;
}

Met met(const Scene& scene) { return met(play(scene, "coverage")); }

TEST(Encounters, OneAgainstTheOtherIsHeadOn) {
  Scene scene(20.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(4.0);
  scene.agv(facing(9.0, 0.0, -1.0, 0.0)).wait_until(1.0).drive(3.0);
  EXPECT_EQ(met(scene), (Met{{"head-on", 1}}));
}

TEST(Encounters, ABodyAheadOfItsReferencePointMeetsWhatLiesBeforeTheEndOfTheTrack) {
  for (const double ahead_m : {0.0, 2.0}) {
    Scene scene(20.0);
    scene.agv(facing(0.0, 0.0, 1.0, 0.0), {1.2, 0.8, ahead_m}).drive(4.0);
    scene.agv(facing(6.0, -5.0, 0.0, 1.0)).drive(10.0);
    EXPECT_EQ(met(scene), ahead_m == 0.0 ? Met{} : (Met{{"crossing", 1}}));
  }
}

TEST(Encounters, WhoeverWaitsUntilTheOtherHasPassedHasStillMetIt) {
  Scene scene(40.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);  // until 8 s, past the crossing
  scene.agv(facing(5.0, -5.0, 0.0, 1.0)).wait_until(15.0).drive(10.0);
  EXPECT_EQ(met(scene), (Met{{"crossing", 1}}));
}

TEST(Encounters, TenSecondsLaterIsNoEncounter) {
  Scene scene(40.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(5.0, -5.0, 0.0, 1.0)).wait_until(18.1).drive(10.0);
  EXPECT_EQ(met(scene), (Met{}));
}

// A drive in parts is one drive: one AGV enters the place that the other leaves, and both stop now and then.
TEST(Encounters, StopsOnTheWayMakeNoFurtherDrives) {
  Scenario scenario = row_scenario(3, {0, 1}, 30.0);
  for (int i = 0; i < 6; ++i) {
    Fault stop;
    stop.kind = Fault::Kind::ProtectiveStop;
    stop.agv = AgvId{i < 4 ? 0U : 1U};
    stop.at = seconds(0.5 + 0.4 * i);
    stop.lasts = seconds(0.05);
    scenario.faults.push_back(stop);
  }
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(find_law("coverage")->make(scenario));
  const Handler one_station_on = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START) host.move(c, b.self);
  };
  current_handler = &one_station_on;
  simulate(scenario, handler_agent(), laws);
  current_handler = nullptr;
  EXPECT_EQ(met(laws[0]->findings()), (Met{{"fault: protective-stop", 6}, {"following", 1}}));
}

TEST(Encounters, OneBehindTheOtherIsFollowing) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(4.0);
  scene.agv(facing(5.0, 0.0, 1.0, 0.0)).drive(10.0);
  EXPECT_EQ(met(scene), (Met{{"following", 1}}));
}

TEST(Encounters, EnteringThePlaceThatAnotherLeavesIsFollowing) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(4.0).drive(5.0);
  scene.agv(facing(5.0, 0.0, 0.0, 1.0)).drive(5.0);
  EXPECT_EQ(met(scene), (Met{{"following", 1}}));
}

TEST(Encounters, TwoWaysToOnePlaceMerge) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(5.0);
  scene.agv(facing(5.0, -7.0, 0.0, 1.0))
      .wait_until(3.0)
      .drive(5.0);  // cut short of the other's place, but on the way to it
  EXPECT_EQ(met(scene), (Met{}));
  Scene at_right_angles(30.0);
  at_right_angles.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(5.0).drive(5.0);
  at_right_angles.agv(facing(5.0, -7.0, 0.0, 1.0)).wait_until(5.0).drive(7.0);
  EXPECT_EQ(met(at_right_angles), (Met{{"following", 1}, {"merging", 1}}))
      << "merging with the first drive, following the second";
}

TEST(Encounters, ASlipRoadMerges) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(20.0);
  const Curve slip = Curve::bezier({2.0, -6.0}, {8.0, -6.0}, {10.0, 0.0}, {16.0, 0.0});
  scene.agv(facing(2.0, -6.0, 1.0, 0.0)).wait_until(6.0).drive(slip);
  EXPECT_EQ(met(scene), (Met{{"merging", 1}}));
}

TEST(Encounters, TwoThatOnlyPartFromEachOtherDoNotMeet) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(5.0);
  scene.agv(facing(-2.0, 0.0, -1.0, 0.0)).drive(5.0);
  EXPECT_EQ(met(scene), (Met{}));
}

TEST(Encounters, LanesBesideEachOtherDoNotMeet) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(20.0);
  scene.agv(facing(20.0, 1.5, -1.0, 0.0)).drive(20.0);
  EXPECT_EQ(met(scene), (Met{}));
}

TEST(Encounters, ObstaclesAreNoEncounters) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(20.0);
  scene.obstacle(facing(10.0, 1.05, 1.0, 0.0));
  EXPECT_EQ(met(scene), (Met{}));
}

TEST(NearMisses, BelowThirtyCentimetresWithoutAViolation) {
  const auto passing_at = [](double y_m) {
    Scene scene(30.0);
    scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(20.0);
    scene.agv(facing(10.0, 1.0 + y_m, 1.0, 0.0));  // parked
    return met(scene);
  };
  EXPECT_EQ(passing_at(0.31), (Met{}));
  EXPECT_EQ(passing_at(0.29), (Met{{"near-miss", 1}}));
  EXPECT_EQ(passing_at(0.11), (Met{{"near-miss", 1}}));
  EXPECT_EQ(passing_at(0.09), (Met{})) << "a violation";
}

TEST(NearMisses, TwoThatStandCloseAreNoNearMissUntilOneMoves) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.agv(facing(0.0, 1.2, 1.0, 0.0));
  EXPECT_EQ(met(scene), (Met{}));
}

TEST(NearMisses, SeamsDoNotCountTwiceButComingBackDoes) {
  Scene scene(60.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(5.0).drive(5.0).wait_until(20.0).turn(kPi).drive(10.0);
  scene.agv(facing(5.0, 1.2, 1.0, 0.0));
  EXPECT_EQ(met(scene)["near-miss"], 2U);
}

TEST(NearMisses, AViolationStaysOneUntilTheyHavePartedForASecond) {
  Scene scene(60.0);
  scene.agv(facing(5.0, 1.05, 1.0, 0.0));
  Timeline& other = scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  other.drive(6.8).drive(3.2);  // the second drive begins 0.2 m ahead of the body that it has passed at 0.05 m
  EXPECT_EQ(met(scene)["near-miss"], 0U);
  other.wait_until(20.0).turn(-kPi / 2).drive(0.15).turn(-kPi / 2).drive(10.0);
  EXPECT_EQ(met(scene)["near-miss"], 1U) << "back at 0.2 m";
}

TEST(Faults, AreCountedByKind) {
  const Scenario scenario = row_scenario(2, {0, 1});
  Told told(scenario, "coverage");
  told.strikes(1.0, 0, Fault::Kind::ProtectiveStop)
      .strikes(2.0, 0, Fault::Kind::ProtectiveStop)
      .strikes(3.0, 1, Fault::Kind::Freeze);
  EXPECT_EQ(met(told.finish(10.0)), (Met{{"fault: freeze", 1}, {"fault: protective-stop", 2}}));
}

TEST(Faults, NamedOnesAreCountedByWord) {
  Scenario scenario = row_scenario(2, {0, 1});
  for (const char* word : {"cut", "scrape", "cut"}) {
    scenario.faults.emplace_back().kind = Fault::Kind::Named;
    scenario.faults.back().word = word;
  }
  Told told(scenario, "coverage");
  for (const std::uint64_t number : {0U, 1U, 2U}) told.strikes(1.0, 0, Fault::Kind::Named, number);
  EXPECT_EQ(met(told.finish(10.0)), (Met{{"fault: named cut", 2}, {"fault: named scrape", 1}}));
}

TEST(Probes, EverythingThatTheLawCountsBearsANameOfTheWorld) {
  Scenario scenario = row_scenario(2, {0, 1});
  scenario.faults.emplace_back().word = "cut";
  Told told(scenario, "coverage");
  for (const Fault::Kind fault : kValuesOf<Fault::Kind>) told.strikes(1.0, 0, fault);
  const auto findings = told.finish(10.0);
  EXPECT_EQ(findings.met.size(), kEncounterKinds + 1 + kValuesOf<Fault::Kind>.size());
  for (const ProbeCount& probe : findings.met) EXPECT_TRUE(is_world_probe(probe.name)) << probe.name;
  EXPECT_EQ(world_probes().size(), findings.met.size() - 1 + 2 + kSceneKinds)
      << "without a named fault, and those that the evidence derives, and scenes";
}

TEST(Probes, WhatAnAgentDeclaresIsSummedByName) {
  const Outcome outcome = simulate_with(
      row_scenario(4, {0, 3}), [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        if (event.kind != FP_EVENT_START) return;
        host.sometimes(c, "negotiation");
        if (b.self == 1) host.sometimes(c, "deferred");
        host.log(c, "a log is no probe");
      });
  EXPECT_EQ(outcome.probes,
            (std::vector<ProbeCount>{{ProbeSource::Agent, "deferred", 1}, {ProbeSource::Agent, "negotiation", 2}}));
}

}  // namespace
}  // namespace fleetproof::test::coverage_law_test
