#include "campaign/shrink/fate_passes.hpp"

#include <gtest/gtest.h>

#include "campaign/shrink/failure_pattern.hpp"
#include "campaign/shrink/shrinker.hpp"
#include "campaign/shrink/trials.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::fate_passes_test {
namespace {

// A smaller case takes the place of the best one while its messages are gone through.
TEST(FatePasses, AMessageThatIsLateAndDoubledIsWeakened) {
  test::CaseBench bench("stale-grant");
  const FailingCase failing = bench.failing_by_radio(2);
  const OnSmaller nobody = [](const FailingCase&, std::string_view) {};
  TrialCache cache;
  Trials trials(bench.host, cache, pattern_of(bench.host, failing), {});
  Shrinker shrinker(trials, failing, nobody);
  write_fates_down(shrinker);
  while (take_out_fates(shrinker)) {
  }
  const std::vector<GivenFate> least = shrinker.best().scenario.fates;
  Scenario worse = shrinker.best().scenario;
  for (GivenFate& fate : worse.fates) {
    if (fate.lost) continue;
    fate.copied = true;
    fate.delay += std::chrono::milliseconds(150);
    fate.copy_delay = fate.delay;
  }
  ASSERT_NE(worse.fates, least) << "a message is late";
  const auto again = trials.first_failing({1, [&](std::size_t) { return std::optional(worse); }});
  ASSERT_TRUE(again);
  Shrinker once_more(trials, again->is, nobody);
  while (take_out_fates(once_more)) {
  }
  EXPECT_EQ(once_more.best().scenario.fates, least);
}

}  // namespace
}  // namespace fleetproof::fate_passes_test
