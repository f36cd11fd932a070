// What counts as work, as progress and as throughput.
#include "core/outcome/work_and_progress.hpp"

#include <gtest/gtest.h>

namespace fleetproof::work_and_progress_test {
namespace {

TEST(Work, IsWhatServesATransport) {
  using enum ActivityKind;
  for (const ActivityKind kind : {Drive, Turn, Settle, Pick, Drop}) EXPECT_TRUE(is_work(kind)) << name_of(kind);
  for (const ActivityKind kind : {Park, Charge, Transmit}) EXPECT_FALSE(is_work(kind)) << name_of(kind);
}

TEST(Work, KeepsAnAgvBusyAndSoDoesACharge) {
  using enum ActivityKind;
  for (const ActivityKind kind : {Drive, Turn, Settle, Pick, Drop, Charge})
    EXPECT_TRUE(keeps_busy(kind)) << name_of(kind);
  for (const ActivityKind kind : {Park, Transmit}) EXPECT_FALSE(keeps_busy(kind)) << name_of(kind);
}

TEST(Progress, IsMadeByTakingALoadUpAndByLosingIt) {
  EXPECT_TRUE(advances_transport({Holder::Kind::Agv, 0}));
  EXPECT_TRUE(advances_transport({Holder::Kind::ClearedAway, 0}));
  EXPECT_FALSE(advances_transport({Holder::Kind::Station, 0})) << "a delivery has a record of its own";
  EXPECT_FALSE(advances_transport({Holder::Kind::Floor, 0}));
  EXPECT_FALSE(advances_transport({Holder::Kind::Withdrawn, 0})) << "nobody has done that";
}

TEST(Progress, IsMadeByAChargeToTheEndOrALongOneAndByNoMovement) {
  using enum ActivityKind;
  const Duration long_enough = seconds(120.0), short_time = seconds(119.0);
  EXPECT_TRUE(is_progress(Charge, true, short_time, long_enough));
  EXPECT_TRUE(is_progress(Charge, false, long_enough, long_enough));
  EXPECT_FALSE(is_progress(Charge, false, short_time, long_enough)) << "cut short";
  for (const ActivityKind kind : {Drive, Turn, Settle, Pick, Drop, Park, Transmit})
    EXPECT_FALSE(is_progress(kind, true, long_enough, long_enough)) << name_of(kind);
}

TEST(OpenTransports, AreThoseNeitherDoneNorImpossible) {
  Counters counters;
  counters.transports_released = 5;
  counters.transports_done = 2;
  counters.loads_cleared = 1;
  EXPECT_EQ(open_transports(counters), 2U);
  counters.transports_withdrawn = 1;
  EXPECT_EQ(open_transports(counters), 1U);
  counters.loads_cleared = 4;
  EXPECT_EQ(open_transports(counters), 0U) << "a load may be cleared away after its delivery";
}

TEST(Throughput, CountsFinishedTransports) { EXPECT_DOUBLE_EQ(transports_per_agv_hour(30, 2.0), 15.0); }

}  // namespace
}  // namespace fleetproof::work_and_progress_test
