#include "core/agents/settings.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace fleetproof::agents::settings_test {
namespace {

TEST(Settings, AreReadFromWordsAndOthersAreLeftAlone) {
  const Settings s =
      read_settings("  position_error_m=0.5\tother=x position_late_s=2 \n loud charge_below=0.2 charge_to=1");
  EXPECT_EQ(s.position_error_m, 0.5);
  EXPECT_EQ(s.position_late_s, 2.0);
  EXPECT_EQ(s.charge_below, 0.2);
  EXPECT_EQ(s.charge_to, 1.0);
  EXPECT_EQ(read_settings("").position_late_s, Settings{}.position_late_s);
}

TEST(Settings, NonsenseIsRefused) {
  for (const char* config :
       {"charge_to=1.5", "position_late_s=-1", "position_error_m=nan", "charge_below=", "charge_below=0.3x"}) {
    EXPECT_THROW(read_settings(config), std::invalid_argument) << config;
  }
}

}  // namespace
}  // namespace fleetproof::agents::settings_test
