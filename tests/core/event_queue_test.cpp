#include "core/engine/event_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

#include "tests/support/at_seconds.hpp"

namespace fleetproof {
namespace {

TEST(EventQueue, OrdersByTimeThenEntityThenSequence) {
  EventQueue queue;
  const auto push = [&](double at_s, std::uint32_t entity, std::uint64_t payload) {
    queue.push(at_seconds(at_s), EntityId{entity}, Event::Kind::TimerGoesOff, payload, 7);
  };
  push(2.0, 0, 6);
  push(1.0, 5, 4);
  push(1.0, 3, 2);
  push(1.0, 5, 5);
  push(1.0, 3, 3);
  push(0.5, 9, 1);
  EXPECT_EQ(queue.next_at(), at_seconds(0.5));
  for (std::uint64_t expected = 1; expected <= 6; ++expected) {
    ASSERT_FALSE(queue.empty());
    const Event event = queue.pop();
    EXPECT_EQ(event.payload, expected);
    EXPECT_EQ(event.stamp, 7U);
    EXPECT_EQ(event.kind, Event::Kind::TimerGoesOff);
  }
  EXPECT_TRUE(queue.empty());
}

// Against a sorted list: many events at few instants, pushed and taken in turns.
TEST(EventQueue, TakesEventsInTheSameOrderAsASortedList) {
  std::mt19937 random(5);
  EventQueue queue;
  std::vector<std::tuple<std::int64_t, std::uint32_t, std::uint64_t>> sorted;  // the sequence is the payload, too
  std::uint64_t pushed = 0;
  for (int round = 0; round < 20'000; ++round) {
    if (random() % 5 < (round < 10'000 ? 3U : 2U)) {
      const auto at = static_cast<std::int64_t>(random() % 50);
      const auto entity = static_cast<std::uint32_t>(random() % 4 == 3 ? EntityId{}.value : random() % 4);
      queue.push(at_ns(at), EntityId{entity}, Event::Kind::TimerGoesOff, pushed, 3 * pushed);
      sorted.emplace_back(at, entity, pushed++);
      std::ranges::sort(sorted);
    } else if (!sorted.empty()) {
      const Event event = queue.pop();
      EXPECT_EQ(std::tuple(to_ns(event.at), event.entity.value, event.payload), sorted.front());
      EXPECT_EQ(event.sequence, event.payload);
      EXPECT_EQ(event.stamp, 3 * event.payload);
      sorted.erase(sorted.begin());
    }
    ASSERT_EQ(queue.empty(), sorted.empty());
  }
  EXPECT_GT(pushed, 8'000U);
}

}  // namespace
}  // namespace fleetproof
