#include "core/engine/event_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

#include "tests/support/at_seconds.hpp"

namespace fleetproof::event_queue_test {
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

// Arrivals that are equally late stand in the lane; others, and those of an instant that has begun, cannot.
TEST(EventQueue, ArrivalsComeInTheSameOrderAsASortedList) {
  for (const bool equally_late : {true, false}) {
    std::mt19937 random(6);
    EventQueue queue;
    std::vector<std::tuple<std::int64_t, std::uint32_t, std::uint64_t, std::uint64_t>> sorted;
    std::uint64_t pushed = 0;
    std::int64_t now = 0;
    for (int round = 0; round < 20'000; ++round) {
      if (random() % 3 == 0) {
        const std::int64_t at = now + (equally_late && random() % 20 != 0 ? 30 : random() % 40);
        std::vector<EntityId> entities;
        for (std::uint32_t entity = 0; entity < 6; ++entity) {
          if (random() % 3 == 0) entities.emplace_back(entity);
        }
        queue.push_arrivals(at_ns(at), entities, static_cast<std::uint32_t>(round));
        for (const EntityId entity : entities) sorted.emplace_back(at, entity.value, pushed++, round);
      } else if (random() % 4 == 0) {
        const std::int64_t at = now + random() % 40;
        queue.push(at_ns(at), EntityId{3U}, Event::Kind::TimerGoesOff, static_cast<std::uint64_t>(round));
        sorted.emplace_back(at, 3, pushed++, round);
      }
      std::ranges::sort(sorted);
      Event event;
      for (int taken = 0; taken < 2 && !sorted.empty(); ++taken) {
        const auto [at, entity, sequence, payload] = sorted.front();
        EXPECT_FALSE(queue.pop_until(at_ns(at - 1), event));
        ASSERT_TRUE(queue.pop_until(at_ns(at), event));
        ASSERT_EQ(std::tuple(to_ns(event.at), event.entity.value, event.sequence, event.payload), sorted.front());
        now = at;
        sorted.erase(sorted.begin());
      }
      ASSERT_EQ(queue.empty(), sorted.empty());
    }
    EXPECT_GT(pushed, 10'000U);
  }
}

// The two steps of a run's loop, against events taken whole: arrivals, timers and others at few instants.
TEST(EventQueue, ArrivalsAndTimersComeByTheirOwnWaysInTheSameOrder) {
  using Taken = std::tuple<Event::Kind, std::int64_t, std::uint32_t, std::uint64_t, std::uint64_t>;
  std::mt19937 random(11);
  EventQueue whole, parted;
  std::int64_t now = 0;
  std::size_t in_row = 0;
  for (int round = 0; round < 20'000; ++round) {
    const SimTime at = at_ns(now + static_cast<std::int64_t>(random() % 6));
    const AgvId agv{static_cast<std::uint32_t>(random() % 4)};
    const auto what = random() % 3;
    const auto number = static_cast<std::uint32_t>(round);
    for (EventQueue* queue : {&whole, &parted}) {
      if (what == 0) queue->push_arrivals(at, {&agv, 1}, number);
      if (what == 1) queue->push_timer(at, agv, number, 2 * number);
      if (what == 2) queue->push(at, agv, Event::Kind::Contact, number, 5);
    }
    if (random() % 8 == 0) continue;
    const Event event = whole.pop();
    const Taken expected{event.kind, to_ns(event.at), event.entity.value, event.payload, event.stamp};
    now = to_ns(event.at);
    if (parted.arrival_comes_first()) {
      const EventQueue::Arrival first = parted.first_arrival();
      ASSERT_EQ(Taken(Event::Kind::MessageArrives, to_ns(first.at), first.receiver().value, first.payload, 0),
                expected);
      parted.drop_arrival();
    } else if (parted.timer_comes_first()) {
      const EventQueue::Timer first = parted.first_timer();
      ASSERT_EQ(Taken(Event::Kind::TimerGoesOff, to_ns(first.at), first.agv.value, first.number, first.stamp),
                expected);
      parted.drop_timer();
      ++in_row;
    } else {
      Event other;
      ASSERT_TRUE(parted.pop_filed_until(event.at, other));
      ASSERT_EQ(Taken(other.kind, to_ns(other.at), other.entity.value, other.payload, other.stamp), expected);
    }
  }
  EXPECT_GT(in_row, 100U);
}

// Broadcasts to a large fleet that arrive together, few or many at a time.
TEST(EventQueue, ManyArrivalsOfOneInstantComeInOrder) {
  std::mt19937 random(7);
  EventQueue queue;
  for (std::int64_t instant = 1; instant <= 200; ++instant) {
    const std::size_t broadcasts = 2 + random() % 8, one_in = 1 + random() % 40;
    std::vector<std::tuple<std::uint32_t, std::uint64_t>> expected;  // receiver, broadcast
    for (std::uint64_t broadcast = 0; broadcast < broadcasts; ++broadcast) {
      std::vector<EntityId> receivers;
      for (std::uint32_t receiver = 0; receiver < 60; ++receiver) {
        if (random() % one_in == 0) receivers.emplace_back(receiver);
      }
      queue.push_arrivals(at_ns(instant), receivers, static_cast<std::uint32_t>(broadcast));
      for (const EntityId receiver : receivers) expected.emplace_back(receiver.value, broadcast);
    }
    std::ranges::sort(expected);
    Event event;
    for (const auto& [receiver, broadcast] : expected) {
      ASSERT_TRUE(queue.pop_until(at_ns(instant), event));
      ASSERT_EQ(std::tuple(event.entity.value, event.payload), std::tuple(receiver, broadcast)) << instant;
    }
    ASSERT_TRUE(queue.empty());
  }
}

// Timers stand in a row while they are pushed in order; they, the heap and the lane take turns.
TEST(EventQueue, TimersComeBetweenOtherEventsInOrder) {
  std::mt19937 random(8);
  EventQueue queue;
  std::vector<std::tuple<std::int64_t, std::uint32_t, std::uint64_t>> sorted;
  std::uint64_t pushed = 0;
  std::int64_t now = 0;
  for (int round = 0; round < 20'000; ++round) {
    const auto kind = random() % 3 == 0 ? Event::Kind::ActivityEnds : Event::Kind::TimerGoesOff;
    const auto entity = static_cast<std::uint32_t>(random() % 5);
    const std::int64_t at = now + (random() % 4 == 0 ? random() % 40 : 20);
    queue.push(at_ns(at), EntityId{entity}, kind, pushed);
    sorted.emplace_back(at, entity, pushed++);
    if (random() % 3 == 0) {
      const EntityId receiver{entity};
      queue.push_arrivals(at_ns(now + 10), {&receiver, 1}, static_cast<std::uint32_t>(pushed));
      sorted.emplace_back(now + 10, entity, pushed++);
    }
    std::ranges::sort(sorted);
    while (sorted.size() > 12) {
      const Event event = queue.pop();
      ASSERT_EQ(std::tuple(to_ns(event.at), event.entity.value, event.payload), sorted.front());
      now = to_ns(event.at);
      sorted.erase(sorted.begin());
    }
  }
}

}  // namespace
}  // namespace fleetproof::event_queue_test
