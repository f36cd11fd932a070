#include "campaign/batch/stop_rules.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fleetproof::run_ledger_test {
namespace {

TEST(RunLedger, CountsTheGapFreePrefixInAnyOrder) {
  RunLedger ledger;
  for (const std::uint64_t index : {3, 0, 1, 5}) ledger.add(index, false);
  EXPECT_EQ(ledger.prefix_length(), 2U);
  EXPECT_EQ(ledger.ahead(), (std::set<std::uint64_t>{3, 5}));
  ledger.add(2, false);
  EXPECT_EQ(ledger.prefix_length(), 4U);
  EXPECT_EQ(ledger.ahead(), (std::set<std::uint64_t>{5}));
}

TEST(RunLedger, StopsAtTheSameRunWhateverFinishedFirst) {
  RunLedger ledger;
  ledger.add(7, true);  // a quick failure far ahead
  ledger.add(0, false);
  EXPECT_FALSE(ledger.length_with_failures(1));
  ledger.add(2, true);
  ledger.add(1, false);
  EXPECT_EQ(ledger.length_with_failures(1), 3U);
  EXPECT_FALSE(ledger.length_with_failures(2));
  for (const std::uint64_t index : {6, 5, 4, 3}) ledger.add(index, false);
  EXPECT_EQ(ledger.length_with_failures(1), 3U);
  EXPECT_EQ(ledger.length_with_failures(2), 8U);
}

TEST(RunLedger, ARunFinishesOnce) {
  RunLedger ledger;
  ledger.add(0, false);
  ledger.add(5, false);
  EXPECT_THROW(ledger.add(0, false), InvariantViolation);
  EXPECT_THROW(ledger.add(5, false), InvariantViolation);
}

}  // namespace
}  // namespace fleetproof::run_ledger_test
