#include "laws/link_quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "core/outcome/trace_records.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/trace_parts.hpp"

namespace fleetproof::test::link_quality_test {
namespace {

constexpr std::size_t kAgvs = 4;

struct Heard {
  std::int64_t second;
  std::size_t sender, receiver;
  bool lost;
};

void note(LinkQuality& quality, const TraceRecord& record) { quality.note(part_of(record)); }

// Counted anew from all that was ever heard.
LinkQuality::Link counted(const std::vector<Heard>& all, std::size_t sender, std::size_t receiver, std::int64_t last) {
  LinkQuality::Link link;
  for (const Heard& one : all) {
    if (one.sender != sender || one.receiver != receiver || one.second > last || one.second < last - 9) continue;
    ++link.receptions;
    link.lost += one.lost ? 1 : 0;
  }
  return link;
}

// A fleet receives in bursts, with silences that are shorter and longer than the window. What arrives at the very end
// of a second belongs to the next one, and is noted before the second is looked at.
TEST(LinkQuality, TheLinksOfTheLastTenSeconds) {
  std::mt19937 random(7);
  LinkQuality quality(kAgvs), late(kAgvs);  // the second one ends its seconds in batches
  std::vector<Heard> all;
  const auto hear = [&](std::int64_t second, Duration later) {
    const auto sender = static_cast<std::uint32_t>(random() % kAgvs),
               receiver = static_cast<std::uint32_t>(random() % kAgvs);
    const bool lost = random() % 10 < 8;
    all.push_back({second, sender, receiver, lost});
    const TraceRecord record =
        trace_record(kStart + std::chrono::seconds(second) + later, AgvId{receiver},
                     traced::Reception{lost ? TraceKind::Lost : TraceKind::Received, AgvId{sender}, 0});
    note(quality, record);
    note(late, record);
  };
  int broken = 0, kept = 0;
  std::int64_t late_second = 0;
  for (std::int64_t second = 0; second < 1000; ++second) {
    const bool burst = second / 17 % 3 == 0;
    for (int i = 0; burst && i < 60; ++i) hear(second, Duration{i});
    if (random() % 2 == 0) hear(second + 1, {});
    std::erase_if(all, [&](const Heard& one) { return one.second < second - 20; });
    quality.end_second(second);
    for (; second % 37 == 0 && late_second <= second; ++late_second) late.end_second(late_second);
    for (std::size_t receiver = 0; receiver < kAgvs; ++receiver) {
      bool each = true;
      for (std::size_t sender = 0; sender < kAgvs; ++sender) {
        const auto expected = counted(all, sender, receiver, second), link = quality.link(sender, receiver);
        ASSERT_EQ(link.receptions, expected.receptions) << second;
        if (second % 37 == 0) {
          ASSERT_EQ(late.link(sender, receiver).lost, link.lost) << second;
        }
        ASSERT_EQ(link.lost, expected.lost) << second;
        each = each && expected.in_contract();
      }
      EXPECT_EQ(quality.all_in_contract(receiver), each) << second;
      ++(each ? kept : broken);
    }
  }
  EXPECT_GT(broken, 100);
  EXPECT_GT(kept, 100);
}

// Of ten seconds of delays of 1 s, 2 s, ... the longest leaves the window when its second does.
TEST(LinkQuality, TheLongestDelayOfTheWindow) {
  LinkQuality quality(kAgvs);
  for (std::int64_t second = 0; second < 60; ++second) {
    const std::int64_t delay_s = 1 + second * 7 % 13;
    const SimTime there = kStart + std::chrono::seconds(second) + std::chrono::milliseconds(500);
    note(quality, trace_record(there - std::chrono::seconds(delay_s), AgvId{0U},
                               traced::Sent{AgvId{1U}, static_cast<std::uint64_t>(second), 0}));
    note(quality, trace_record(there, AgvId{1U},
                               traced::Reception{TraceKind::Received, AgvId{0U}, static_cast<std::uint64_t>(second)}));
    quality.end_second(second);
    std::int64_t longest_s = 0;
    for (std::int64_t i = std::max<std::int64_t>(0, second - 9); i <= second; ++i)
      longest_s = std::max(longest_s, 1 + i * 7 % 13);
    EXPECT_EQ(quality.link(0, 1).longest, std::chrono::seconds(longest_s)) << second;
  }
}

// Seconds are skipped now and then; delays from before are known all the same.
TEST(LinkQuality, IsTheSameTenSecondsAfterOthersWereSkipped) {
  std::mt19937 random(11);
  LinkQuality always(kAgvs), skips(kAgvs);
  std::int64_t next = 0;
  int compared = 0, late = 0;
  for (std::int64_t second = 0; second < 600; ++second) {
    const SimTime begin = kStart + std::chrono::seconds(second);
    for (std::int64_t i = 0; i < 20; ++i) {
      const auto sender = static_cast<std::uint32_t>(random() % kAgvs),
                 receiver = static_cast<std::uint32_t>(random() % kAgvs);
      const auto hash = static_cast<std::uint64_t>(random() % 400);
      const TraceRecord record =
          i % 2 == 0 ? trace_record(begin + Duration{i}, AgvId{sender}, traced::Sent{AgvId{receiver}, hash, 0})
                     : trace_record(
                           begin + Duration{i}, AgvId{receiver},
                           traced::Reception{i % 3 == 0 ? TraceKind::Lost : TraceKind::Received, AgvId{sender}, hash});
      note(always, record);
      note(skips, record);
    }
    always.end_second(second);
    if (second % 97 == 50) skips.skip_to(next = second - 3);
    if (second % 97 == 60) skips.skip_to(next = second + 1);
    if (second % 97 >= 20 && second % 97 <= 60) continue;  // nobody asks
    for (; next <= second; ++next) skips.end_second(next);
    if (second % 97 > 60 && second % 97 < 71) continue;
    ++compared;
    for (std::size_t receiver = 0; receiver < kAgvs; ++receiver) {
      for (std::size_t sender = 0; sender < kAgvs; ++sender) {
        const auto one = always.link(sender, receiver), other = skips.link(sender, receiver);
        ASSERT_EQ(std::tuple(one.receptions, one.lost, one.longest),
                  std::tuple(other.receptions, other.lost, other.longest))
            << second;
        late += one.longest > std::chrono::seconds(30) ? 1 : 0;
      }
      ASSERT_EQ(always.all_in_contract(receiver), skips.all_in_contract(receiver)) << second;
    }
  }
  EXPECT_GT(compared, 200);
  EXPECT_GT(late, 200);
}

// Of 100 messages 65 are lost, and all others arrive twice.
TEST(LinkQuality, SecondCopiesDoNotHideLosses) {
  LinkQuality quality(kAgvs);
  for (int i = 0; i < 100; ++i) {
    const TraceKind delivery = i < 65 ? TraceKind::Lost : TraceKind::Received;
    const TraceRecord record = trace_record(kStart, AgvId{1U}, traced::Reception{delivery, AgvId{0U}, 1});
    quality.note(part_of(record));
    if (i >= 65) quality.note(part_of(record, true));
  }
  quality.end_second(0);
  EXPECT_EQ(quality.link(0, 1).receptions, 100U);
  EXPECT_EQ(quality.link(0, 1).lost, 65U);
  EXPECT_FALSE(quality.all_in_contract(1));
}

// However much a sender says in between, and although it says the same to another receiver.
TEST(LinkQuality, NoDelayIsForgotten) {
  LinkQuality quality(kAgvs);
  const auto sends = [&](std::uint32_t receiver, std::uint64_t hash) {
    note(quality, trace_record(kStart, AgvId{0U}, traced::Sent{AgvId{receiver}, hash, 0}));
  };
  sends(1, 7);
  for (std::uint64_t i = 0; i < 10'000; ++i) sends(2, 1000 + i);
  note(quality, trace_record(kStart + std::chrono::seconds(4), AgvId{0U}, traced::Sent{AgvId{2U}, 7, 0}));
  for (std::int64_t second = 0; second < 5; ++second) quality.end_second(second);
  const SimTime there = kStart + std::chrono::seconds(5);
  note(quality, trace_record(there, AgvId{1U}, traced::Reception{TraceKind::Received, AgvId{0U}, 7}));
  quality.end_second(5);
  EXPECT_EQ(quality.link(0, 1).longest, std::chrono::seconds(5));
  EXPECT_FALSE(quality.all_in_contract(1));
}

TEST(SentMessages, KnowsNothingBeforeTheFirst) { EXPECT_EQ(SentMessages().last_sent(7, AgvId{}), SimTime::min()); }

// Hashes with equal low bits stand in one place of the table.
TEST(SentMessages, AgreesWithAMapHoweverTheHashesFall) {
  for (const std::uint64_t step : {std::uint64_t{1}, std::uint64_t{1} << 40, std::uint64_t{0x9e3779b97f4a7c15}}) {
    SentMessages sent;
    std::map<std::pair<std::uint64_t, AgvId>, SimTime> expected;
    std::mt19937 draw(5);
    for (int i = 0; i < 4000; ++i) {
      const std::uint64_t hash = draw() % 1500 * step;
      const AgvId receiver = draw() % 2 == 0 ? AgvId{} : AgvId{draw() % 3};
      sent.note(hash, receiver, at_seconds(i));
      expected[{hash, receiver}] = at_seconds(i);
    }
    for (std::uint64_t number = 0; number < 1600; ++number) {
      for (const AgvId receiver : {AgvId{}, AgvId{0U}, AgvId{1U}, AgvId{2U}, AgvId{3U}}) {
        const auto known = expected.find({number * step, receiver});
        EXPECT_EQ(sent.last_sent(number * step, receiver), known == expected.end() ? SimTime::min() : known->second);
      }
    }
  }
}

}  // namespace
}  // namespace fleetproof::test::link_quality_test
