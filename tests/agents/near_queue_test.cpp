#include "core/agents/near_queue.hpp"

#include <gtest/gtest.h>

#include <random>

namespace fleetproof::agents::near_queue_test {
namespace {

// Some lie so far out that no bucket holds them.
TEST(NearQueue, GivesTheNearestFirstToWithinAWidth) {
  std::mt19937_64 random(3);
  const auto any = [&](double up_to) { return up_to * static_cast<double>(random() >> 11) * 0x1p-53; };
  NearQueue queue;
  for (const double width : {0.01, 0.5, 2000.0}) {
    queue.begin(10.0, width);
    std::vector<double> distances;
    const auto push = [&](double distance) {
      queue.push(distance, static_cast<std::uint32_t>(distances.size()));
      distances.push_back(distance);
    };
    for (int i = 0; i < 300; ++i) push(10.0 + any(100.0));
    double farthest = 0.0;
    std::size_t taken = 0;
    for (; queue.find_next(); ++taken) {
      const double distance = distances[queue.pop()];
      EXPECT_GT(distance, farthest - width - 1e-9);
      farthest = std::max(farthest, distance);
      if (taken < 200) push(distance + any(50.0));
    }
    EXPECT_EQ(taken, distances.size());
  }
}

TEST(NearQueue, BeginsAnew) {
  NearQueue queue;
  queue.begin(0.0, 1.0);
  queue.push(3.0, 1), queue.push(7.0, 2), queue.push(1e9, 3);
  ASSERT_TRUE(queue.find_next());
  EXPECT_EQ(queue.pop(), 1U);
  queue.begin(5.0, 1.0);
  EXPECT_FALSE(queue.find_next());
  queue.push(6.0, 4);
  ASSERT_TRUE(queue.find_next());
  EXPECT_EQ(queue.pop(), 4U);
  EXPECT_FALSE(queue.find_next());
}

TEST(NearQueue, OfPlacesWithinOneWidthTheLastComesFirst) {
  NearQueue queue;
  queue.begin(0.0, 1.0);
  queue.push(0.9, 7), queue.push(0.1, 8), queue.push(0.5, 9);
  for (const std::uint32_t place : {9U, 8U, 7U}) {
    ASSERT_TRUE(queue.find_next());
    EXPECT_EQ(queue.pop(), place);
  }
}

}  // namespace
}  // namespace fleetproof::agents::near_queue_test
