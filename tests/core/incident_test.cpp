#include "core/outcome/incident.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "core/scenario/faults.hpp"

namespace fleetproof::incident_test {
namespace {

std::set<std::string> kinds_with(IncidentRole role) {
  std::set<std::string> names;
  for (const IncidentKindInfo& info : incident_kinds()) {
    if (info.role == role) names.insert(std::string(info.name));
  }
  return names;
}

TEST(Incidents, AccuseTheFleetUnlessTheyAreItsCondition) {
  EXPECT_EQ(kinds_with(IncidentRole::Condition), (std::set<std::string>{"fault-injected", "foreign-body"}));
  EXPECT_EQ(kinds_with(IncidentRole::Denied),
            (std::set<std::string>{"fault-without-effect", "load-did-not-fall", "obstacle-without-room",
                                   "call-not-made", "not-reached", "message-not-sent", "call-without-effect"}));
  EXPECT_EQ(kinds_with(IncidentRole::Link), (std::set<std::string>{"waits", "waits-inferred"}));
  for (const IncidentKindInfo& info : incident_kinds()) {
    const bool is_told = info.role == IncidentRole::Condition || info.role == IncidentRole::Denied;
    EXPECT_EQ(accuses(info.kind), !is_told) << info.name;
    EXPECT_EQ(is_condition(info.kind), info.role == IncidentRole::Condition) << info.name;
    EXPECT_EQ(is_link(info.kind), info.role == IncidentRole::Link) << info.name;
    if (info.end_point) {
      EXPECT_EQ(info.role, IncidentRole::Accusation) << info.name << " fails a run";
    }
  }
}

TEST(Incidents, FailTheEndPointsThatNothingElseDecides) {
  std::set<EndPoint> failed;
  for (const IncidentKindInfo& info : incident_kinds()) {
    if (info.end_point) failed.insert(*info.end_point);
  }
  std::set<EndPoint> expected{EndPoint::WrongLoad, EndPoint::EmptyBattery};
  for (const EndPointInfo& info : kEndPoints) {
    if (info.is_lack_of_progress) expected.insert(info.id);
    if (info.stall_weight > 0) {
      EXPECT_TRUE(info.is_lack_of_progress) << name_of(info.id);
    }
  }
  EXPECT_EQ(failed, expected);
}

TEST(Incidents, OfFaultsHaveTheWordsOfFaultsInTheirUnit) {
  std::string unit = "kind of the fault";
  for (const Fault::Kind kind : kValuesOf<Fault::Kind>) {
    std::string word = name_of(kind);
    std::ranges::replace(word, '-', ' ');
    unit += (unit.ends_with('t') && kind == kValuesOf<Fault::Kind>.front() ? ": " : ", ") +
            std::to_string(static_cast<int>(kind)) + " " + word;
  }
  EXPECT_EQ(info_of(IncidentKind::FaultInjected).unit, unit);
  EXPECT_EQ(info_of(IncidentKind::FaultWithoutEffect).unit, unit);
  EXPECT_TRUE(unit.starts_with("kind of the fault: 1 breakdown, 2 protective stop, ")) << unit;
}

TEST(Incidents, OfABodySayWhichBodyItIs) {
  Incident incident;
  incident.kind = IncidentKind::ForeignBody;
  incident.value = kFallenLoad;
  EXPECT_TRUE(is_fallen_load(incident));
  incident.value = kObstacle;
  EXPECT_FALSE(is_fallen_load(incident));
}

}  // namespace
}  // namespace fleetproof::incident_test
