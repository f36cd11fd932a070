#include "laws/fault_record_law.hpp"

#include <gmock/gmock.h>

#include "tests/laws/told.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::fault_record_law_test {
namespace {

using testing::ElementsAre;

Incident noted(IncidentKind kind, std::uint32_t body, double first_s, double last_s, std::int64_t value) {
  return {kind, EntityId{body}, {}, at_seconds(first_s), at_seconds(last_s), value};
}

TEST(FaultRecord, NotesEachFaultFromItsBeginningToItsEnd) {
  const Scenario scenario = row_scenario(2, {0, 1});
  Told told(scenario, "faults");
  told.strikes(1.0, 0, Fault::Kind::Restart)
      .record(3.5, 0, traced::FaultOver{Fault::Kind::Restart, 0})
      .strikes(4.0, 1, Fault::Kind::Breakdown);
  EXPECT_THAT(told.finish(10.0).incidents,
              ElementsAre(noted(IncidentKind::FaultInjected, 0, 1.0, 3.5, static_cast<int>(Fault::Kind::Restart)),
                          noted(IncidentKind::FaultInjected, 1, 4.0, 10.0, static_cast<int>(Fault::Kind::Breakdown))));
}

TEST(FaultRecord, TellsFaultsApartThatLastAtTheSameTime) {
  const Scenario scenario = row_scenario(2, {0, 1});
  Told told(scenario, "faults");
  told.record(1.0, 0, traced::FaultStrikes{Fault::Kind::Restart, 0})
      .record(2.0, 0, traced::FaultStrikes{Fault::Kind::Freeze, 1})
      .record(3.0, 1, traced::FaultStrikes{Fault::Kind::Restart, 0})
      .record(4.0, 0, traced::FaultOver{Fault::Kind::Restart, 0})
      .record(5.0, 1, traced::FaultOver{Fault::Kind::Restart, 0});
  EXPECT_THAT(told.finish(10.0).incidents,
              ElementsAre(noted(IncidentKind::FaultInjected, 0, 1.0, 4.0, static_cast<int>(Fault::Kind::Restart)),
                          noted(IncidentKind::FaultInjected, 0, 2.0, 10.0, static_cast<int>(Fault::Kind::Freeze)),
                          noted(IncidentKind::FaultInjected, 1, 3.0, 5.0, static_cast<int>(Fault::Kind::Restart))));
}

TEST(FaultRecord, NotesBodiesOnTheFloorAndNotAgvsThatAreSetDown) {
  Scenario scenario = row_scenario(2, {0, 1});
  scenario.obstacles.emplace_back();
  Told told(scenario, "faults");
  told.leaves(1.0, 0).appears(2.0, 0);  // an AGV in the hands of the operator
  told.appears(3.0, 2).leaves(5.0, 2).appears(6.0, 3);
  EXPECT_THAT(told.finish(10.0).incidents, ElementsAre(noted(IncidentKind::ForeignBody, 2, 3.0, 5.0, 0),
                                                       noted(IncidentKind::ForeignBody, 3, 6.0, 10.0, 1)));
}

TEST(FaultRecord, AccusesNobody) {
  EXPECT_FALSE(accuses(IncidentKind::FaultInjected));
  EXPECT_FALSE(accuses(IncidentKind::ForeignBody));
  EXPECT_TRUE(accuses(IncidentKind::ThroughputBelowFloor));
}

}  // namespace
}  // namespace fleetproof::test::fault_record_law_test
