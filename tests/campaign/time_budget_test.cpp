#include "campaign/batch/time_budget.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fleetproof::time_budget_test {
namespace {

TEST(TimeBudget, ReadsDurations) {
  const auto seconds = [](const char* text) { return duration_of(text, "--max-time").count(); };
  EXPECT_EQ(seconds("90"), 90);
  EXPECT_EQ(seconds("90s"), 90);
  EXPECT_EQ(seconds("45m"), 2700);
  EXPECT_EQ(seconds("5h30m"), 19800);
  EXPECT_EQ(seconds("1h2m3s"), 3723);
  EXPECT_EQ(seconds("1h30"), 3630);
  for (const char* wrong : {"", "0", "h", "5x", "30m5h", "1h1h", "-1", "1.5h", "99999999999", "0h0m"})
    EXPECT_THROW(duration_of(wrong, "--max-time"), InputError) << wrong;
}

TEST(TimeBudget, WritesDurationsAsItReadsThem) {
  EXPECT_EQ(duration_text(0.2), "0s");
  EXPECT_EQ(duration_text(59.4), "59s");
  EXPECT_EQ(duration_text(59.6), "1m00s");
  EXPECT_EQ(duration_text(303), "5m03s");
  EXPECT_EQ(duration_text(3599.7), "1h00m");
  EXPECT_EQ(duration_text(7170), "2h00m");
  EXPECT_EQ(duration_text(100.0 * 3600), "100h00m");
  for (const long seconds : {1L, 59L, 60L, 61L, 3599L, 3600L, 19800L})
    EXPECT_EQ(duration_of(duration_text(static_cast<double>(seconds)), "--max-time").count(), seconds);
}

TEST(TimeBudget, WaitsForTheNextTimeOfThatName) {
  std::tm day{};
  day.tm_year = 126;
  day.tm_mon = 10;
  day.tm_mday = 22;
  day.tm_hour = 22;
  day.tm_isdst = -1;
  const std::time_t ten_in_the_evening = std::mktime(&day);
  const auto until = [&](const char* text) { return time_until(text, ten_in_the_evening, "--until").count(); };
  EXPECT_EQ(until("23:15"), 4500);
  EXPECT_EQ(until("06:00"), 8 * 3600);
  EXPECT_EQ(until("22:00"), 24 * 3600);
  EXPECT_EQ(until("22:00:01"), 1);
  for (const char* wrong : {"", "6", "24:00", "06:60", "06:00:60", "06:00:00:00", "06:", "six"})
    EXPECT_THROW(time_until(wrong, ten_in_the_evening, "--until"), InputError) << wrong;
}

}  // namespace
}  // namespace fleetproof::time_budget_test
