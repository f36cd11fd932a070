#include "core/engine/event_queue.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace fleetproof
