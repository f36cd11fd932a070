// The queue of the search for quickest ways, against the one of the standard library.
#include "generators/map/calendar_queue.hpp"

#include <gtest/gtest.h>

#include <map>
#include <queue>
#include <set>

#include "core/base/random.hpp"

namespace fleetproof::calendar_queue_test {
namespace {

using Costs = std::priority_queue<std::int64_t, std::vector<std::int64_t>, std::greater<>>;

// Pushes what a search may push, now and then as far ahead as it may, and pops until nothing is open. Which stations
// are open is kept by cost.
void expect_like_the_oracle(CalendarQueue& queue, std::int64_t longest_ns, Draws& draws) {
  Costs costs;
  std::map<std::int64_t, std::multiset<std::uint32_t>> stations;
  std::uint32_t pushed = 0;
  const auto push = [&](std::int64_t cost_ns) {
    queue.push({cost_ns, pushed});
    costs.push(cost_ns);
    stations[cost_ns].insert(pushed++);
  };
  push(0);
  while (!costs.empty()) {
    ASSERT_FALSE(queue.empty());
    const auto found = queue.pop();
    ASSERT_EQ(found.cost_ns, costs.top()) << "longest hop " << longest_ns << ", push " << pushed;
    costs.pop();
    auto& open = stations[found.cost_ns];
    ASSERT_TRUE(open.contains(found.station)) << "one of those that cost as much, and each once";
    open.erase(open.find(found.station));
    if (pushed > 300) continue;
    for (std::uint32_t n = draws.below(4); n > 0; --n) {
      const auto hop = static_cast<std::int64_t>(draws.uniform() * static_cast<double>(longest_ns));
      const std::int64_t ahead[] = {hop, hop, hop / 16, 0, longest_ns};  // near ones, ties, and the farthest
      push(found.cost_ns + ahead[draws.below(5)]);
    }
  }
  EXPECT_TRUE(queue.empty());
}

TEST(CalendarQueue, PopsWhatAHeapPopsWhateverTheLongestHop) {
  for (std::uint64_t seed = 0; seed < 2'000; ++seed) {
    Draws draws(seed);
    // Every power of two, and the numbers beside it and beside fifteen times it, where slots become longer.
    const std::int64_t power = std::int64_t{1} << draws.below(44);
    const std::int64_t longest_ns = (draws.below(2) == 0 ? power : 15 * power) + draws.below(3) - 1;
    CalendarQueue queue{Duration(longest_ns)};
    for (int search = 0; search < 3; ++search) {
      expect_like_the_oracle(queue, longest_ns, draws);
      queue.rewind();
    }
  }
}

TEST(CalendarQueue, IsEmptyUntilPushedAndAfterTheLastPop) {
  CalendarQueue queue{std::chrono::seconds(7)};
  EXPECT_TRUE(queue.empty());
  queue.push({5, 1});
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ(queue.pop().station, 1U);
  EXPECT_TRUE(queue.empty());
}

// Which of several with one cost comes first is not promised, but it never depends on anything but what was pushed and
// popped.
TEST(CalendarQueue, TiesComeInTheSameOrderEveryTime) {
  std::vector<std::uint32_t> orders[2];
  CalendarQueue used{std::chrono::seconds(1)}, fresh{std::chrono::seconds(1)};
  Draws draws(1);
  expect_like_the_oracle(used, 1'000'000'000, draws);
  used.rewind();
  CalendarQueue* queues[] = {&used, &fresh};
  for (int k = 0; k < 2; ++k) {
    for (std::uint32_t s = 0; s < 20; ++s) queues[k]->push({s % 3 * 1000, s});
    while (!queues[k]->empty()) orders[k].push_back(queues[k]->pop().station);
  }
  EXPECT_EQ(orders[0].size(), 20U);
  EXPECT_EQ(orders[0], orders[1]);
  EXPECT_EQ(orders[0][0], 0U) << "of untouched ones, the first that was pushed";
}

}  // namespace
}  // namespace fleetproof::calendar_queue_test
