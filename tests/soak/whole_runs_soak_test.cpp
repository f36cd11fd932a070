// Three hundred whole runs over all families of layouts against a global clock of 2.5 ms.
#include "tests/oracle/whole_runs.hpp"

namespace fleetproof::oracle::whole_runs_soak_test {
namespace {

TEST(WholeRunsSoak, TheGlobalClockSeesTheSamePairsInThreeHundredRuns) {
  EXPECT_EQ(compare_runs(1'000, 300, 180.0).runs, 300);
}

}  // namespace
}  // namespace fleetproof::oracle::whole_runs_soak_test
