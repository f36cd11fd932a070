#include "laws/sent_messages.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/support/at_seconds.hpp"

namespace fleetproof::sent_messages_test {
namespace {

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
}  // namespace fleetproof::sent_messages_test
