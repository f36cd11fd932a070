// What the head of a page says of a message whose delivery the scenario gives.
#include "reports/replay_page/given_delivery_lines.hpp"

#include <gtest/gtest.h>

namespace fleetproof::web::given_delivery_lines_test {
namespace {

TEST(GivenDeliveryLines, CopiesStandInTheOrderOfTime) {
  Film film;
  film.focus_us = 20'000'000;
  film.end_us = 100'000'000;
  film.bodies = {{"A", BodyKind::Agv}, {"B", BodyKind::Agv}};
  Message sent;
  sent.number = 7;
  sent.receiver = 1;
  sent.kind = "ASK";
  sent.sent_us = 9'000'000;
  for (const std::int64_t after_us : {1'100'000, 99'000'000, 900'000}) {
    sent.arrivals.push_back({1, Receipt::Received, after_us});
    sent.arrivals.back().is_given = true;
  }
  film.messages = {sent};
  const auto lines = given_delivery_lines(film);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].text,
            "ASK #7 from A to B, sent 9.000 s: received 9.900 s, 10.100 s, not before the end, as the scenario says.");
}

}  // namespace
}  // namespace fleetproof::web::given_delivery_lines_test
