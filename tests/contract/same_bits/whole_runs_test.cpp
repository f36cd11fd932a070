// Thirty whole runs over all families of layouts against a global clock of 2.5 ms. Three hundred are in soak/.
#include "tests/oracle/whole_runs.hpp"

namespace fleetproof::oracle::whole_runs_test {
namespace {

TEST(WholeRuns, TheGlobalClockSeesTheSamePairs) { EXPECT_EQ(compare_runs(0, 36, 60.0).runs, 36); }

}  // namespace
}  // namespace fleetproof::oracle::whole_runs_test
