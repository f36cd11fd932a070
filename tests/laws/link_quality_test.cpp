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

// However much a sender says in between, and although it says the same to another receiver.
TEST(LinkQuality, NoDelayIsForgotten) {
  LinkQuality quality(kAgvs);
  const auto sends = [&](std::uint32_t receiver, std::uint64_t hash) {
    quality.note(trace_record(kStart, AgvId{0U}, traced::Sent{AgvId{receiver}, hash, 0}));
  };
  sends(1, 7);
  for (std::uint64_t i = 0; i < 10'000; ++i) sends(2, 1000 + i);
  quality.note(trace_record(kStart + std::chrono::seconds(4), AgvId{0U}, traced::Sent{AgvId{2U}, 7, 0}));
  const SimTime there = kStart + std::chrono::seconds(5);
  quality.note(trace_record(there, AgvId{1U}, traced::Reception{TraceKind::Received, AgvId{0U}, 7}));
  EXPECT_EQ(quality.link(0, 1, 5).longest, std::chrono::seconds(5));
  EXPECT_FALSE(quality.all_in_contract(1, 5));
}

}  // namespace
}  // namespace fleetproof::test
