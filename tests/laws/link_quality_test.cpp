#include "laws/link_quality.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/outcome/trace_records.hpp"

namespace fleetproof::test {
namespace {

constexpr std::size_t kAgvs = 4;

// A fleet receives in bursts, with silences that are shorter and longer than the window.
TEST(LinkQuality, AllLinksKeepTheContractExactlyIfEachLinkDoes) {
  std::mt19937 random(7);
  LinkQuality quality(kAgvs);
  int broken = 0;
  for (std::int64_t second = 0; second < 2000; ++second) {
    const bool burst = second / 17 % 3 == 0;
    for (int i = 0; burst && i < 60; ++i) {
      const std::uint32_t sender = random() % kAgvs, receiver = random() % kAgvs;
      const TraceKind fate = random() % 10 < 8 ? TraceKind::Lost : TraceKind::Received;
      quality.note(trace_record(kStart + std::chrono::seconds(second), AgvId{receiver},
                                traced::Reception{fate, AgvId{sender}, 0}));
    }
    for (std::size_t receiver = 0; receiver < kAgvs; ++receiver) {
      bool each = true;
      for (std::size_t sender = 0; sender < kAgvs; ++sender)
        each = each && (sender == receiver || quality.link(sender, receiver, second).in_contract());
      EXPECT_EQ(quality.all_in_contract(receiver, second), each) << second;
      broken += each ? 0 : 1;
    }
  }
  EXPECT_GT(broken, 100);
}

}  // namespace
}  // namespace fleetproof::test
