#include "reports/replay_page/message_numbers.hpp"

#include <gmock/gmock.h>

namespace fleetproof::web::message_numbers_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(MessageNumbers, StandAfterTheirWords) {
  EXPECT_THAT(numbers_asked("asks with 3.0 for C12 to C14").list, ElementsAre("3.0"));
  EXPECT_THAT(numbers_asked("asks with 3.0, 3.1 for 12 to 14").list, ElementsAre("3.0", "3.1"));
  EXPECT_THAT(numbers_asked("asks 7").list, ElementsAre("7"));
  EXPECT_THAT(numbers_asked("answers 4.0, asks nobody with 1.0 of boot 1").list, ElementsAre("1.0 of boot 1"));
  EXPECT_THAT(numbers_answered("answers 1.0 of boot 1, 2.0, holds 5").list, ElementsAre("1.0 of boot 1", "2.0"));
  EXPECT_THAT(numbers_answered("holds C2").list, IsEmpty());
  EXPECT_THAT(numbers_answered("reanswers 3").list, IsEmpty());
}

// Then nothing can be said of a number that is not there.
TEST(MessageNumbers, MayBeMoreThanAreNamed) {
  EXPECT_FALSE(numbers_answered("answers 3.0, holds C2 to C4").has_more);
  EXPECT_FALSE(numbers_answered("holds C2").has_more);
  EXPECT_TRUE(numbers_answered("answers 3.0, 4.0, ..., holds C2").has_more);
  EXPECT_TRUE(numbers_answered("answers all").has_more);
}

TEST(MessageNumbers, AttemptsAreOfOneRequest) {
  const auto request = [](const char* content) { return numbers_asked(content); };
  EXPECT_TRUE(are_of_one_request(request("asks 3.0"), request("asks 3.1")));
  EXPECT_FALSE(are_of_one_request(request("asks 3.0"), request("asks 2.0")));
  EXPECT_FALSE(are_of_one_request(request("asks 3.0"), request("asks 3.0 of boot 1")));
  EXPECT_FALSE(are_of_one_request(request("asks 13"), request("asks 3")));
}

TEST(MessageNumbers, APlaceIsComparedWithTheBeginningOfADrive) {
  EXPECT_TRUE(asks_from_beginning_of("asks with 3.0 for C12 to C14", "C12 to C13"));
  EXPECT_FALSE(asks_from_beginning_of("asks with 3.0 for C12 to C14", "C1 to C12"));
  EXPECT_FALSE(asks_from_beginning_of("asks with 3.0 for C1 to C14", "C12 to C13"));
  EXPECT_TRUE(asks_from_beginning_of("asks with 3.0 for \u2026le-12 to \u2026le-14", "aisle-12 to aisle-13, backward"));
  EXPECT_FALSE(asks_from_beginning_of("asks with 3.0 for \u2026le-12 to \u2026le-14", "aisle-11 to aisle-12"));
  EXPECT_FALSE(asks_from_beginning_of("asks with 3.0", "C12 to C13"));
}

TEST(MessageNumbers, ALaterAttemptIsOfTheSameRequest) {
  const MessageNumbers first = numbers_asked("asks with 3.1 of boot 1 for C2");
  EXPECT_TRUE(is_later_attempt(numbers_answered("answers 3.2 of boot 1"), first));
  EXPECT_TRUE(is_later_attempt(numbers_answered("answers 3.12 of boot 1"), numbers_asked("asks with 3.9 of boot 1")));
  EXPECT_FALSE(is_later_attempt(numbers_answered("answers 3.1 of boot 1"), first));
  EXPECT_FALSE(is_later_attempt(numbers_answered("answers 3.0 of boot 1"), first));
  EXPECT_FALSE(is_later_attempt(numbers_answered("answers 3.2"), first)) << "before the restart";
  EXPECT_FALSE(is_later_attempt(numbers_answered("answers 4.2 of boot 1"), first));
}

}  // namespace
}  // namespace fleetproof::web::message_numbers_test
