#include "campaign/shrink/delivery_passes.hpp"

#include <gtest/gtest.h>

#include "campaign/shrink/failure_pattern.hpp"
#include "campaign/shrink/shrinker.hpp"
#include "campaign/shrink/trials.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::delivery_passes_test {
namespace {

// A smaller case takes the place of the best one while its messages are gone through.
TEST(DeliveryPasses, AMessageThatIsLateAndDoubledIsWeakened) {
  test::CaseBench bench("stale-grant");
  const FailingCase failing = bench.failing_by_radio(2);
  const OnSmaller nobody = [](const FailingCase&, std::string_view) {};
  TrialCache cache;
  Trials trials(bench.host, cache, pattern_of(bench.host, failing), {});
  Shrinker shrinker(trials, failing, nobody);
  write_deliveries_down(shrinker);
  while (take_out_deliveries(shrinker)) {
  }
  const std::vector<GivenDelivery> least = shrinker.best().scenario.deliveries;
  Scenario worse = shrinker.best().scenario;
  for (GivenDelivery& delivery : worse.deliveries) {
    if (delivery.lost) continue;
    delivery.copied = true;
    delivery.delay += std::chrono::milliseconds(150);
    delivery.copy_delay = delivery.delay;
  }
  ASSERT_NE(worse.deliveries, least) << "a message is late";
  const auto again = trials.first_failing({1, [&](std::size_t) { return std::optional(worse); }});
  ASSERT_TRUE(again);
  Shrinker once_more(trials, again->is, nobody);
  while (take_out_deliveries(once_more)) {
  }
  EXPECT_EQ(once_more.best().scenario.deliveries, least);
}

}  // namespace
}  // namespace fleetproof::delivery_passes_test
