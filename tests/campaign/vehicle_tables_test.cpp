// [[vehicle]] tables of a campaign file: every malformed value has one error with file, line, field, value and remedy.
#include <gmock/gmock.h>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/plan_check.hpp"
#include "core/base/error.hpp"

namespace fleetproof::vehicle_tables_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kFactors = "kind = \"search\"\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\n";

std::string refusal(const std::string& text) {
  try {
    const auto read = parse_campaign_file(text, "c.toml");
    check_plan(read.plan, read.places);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}
// Of a table whose fields stand from line 6 on.
std::string with(const std::string& fields) { return refusal(kFactors + "[[vehicle]]\n" + fields + "\n"); }

struct Bad {
  const char *line, *value, *remedy;
};

TEST(VehicleTables, EachNumberOutOfItsRangeIsRefused) {
  const Bad bad[] = {{"length_m = nan", "nan", "0.001 to 100 m"},
                     {"length_m = -1", "-1", "0.001 to 100 m"},
                     {"width_m = inf", "inf", "0.001 to 100 m"},
                     {"width_m = 1e300", "1e+300", "0.001 to 100 m"},
                     {"length_m = \"2\"", "\"2\"", "0.001 to 100 m"},
                     {"length_m = true", "true", "0.001 to 100 m"},
                     {"length_m = [2]", "an array", "0.001 to 100 m"},
                     {"length_m = { a = { b = 1 } }", "a table", "0.001 to 100 m"},
                     {"length_m = 1979-05-27", "a date or a time", "0.001 to 100 m"},
                     {"speed_mps = 0", "0", "0.001 to 100 m/s"},
                     {"speed_mps = 1e-300", "1e-300", "0.001 to 100 m/s"},
                     {"turn_speed_radps = 0", "0", "0.001 to 100 rad/s"},
                     {"centre_ahead_m = -1e9", "-1000000000", "-100 to 100 m"},
                     {"loaded_speed_share = 0.05", "0.05", "0.1 to 1"},
                     {"loaded_extra_width_m = -1", "-1", "0 to 100 m"},
                     {"speed_deviation = 0.9", "0.9", "0 to 0.5"},
                     {"pick_s = 99999999", "99999999", "0 to 3600 s"},
                     {"battery_per_m = 2", "2", "0 to 1 per m"},
                     {"share = nan", "nan", "above 0"},
                     {"share = 0", "0", "above 0"},
                     {"share = 1e308", "1e+308", "above 0"}};
  for (const auto& [line, value, remedy] : bad) {
    const std::string key = std::string(line).substr(0, std::string(line).find(' '));
    EXPECT_THAT(with(line), AllOf(StartsWith("c.toml:6:"), HasSubstr("vehicle." + key + ": " + value + " is refused"),
                                  HasSubstr(remedy)))
        << line;
  }
}

TEST(VehicleTables, NamesAreCheckedAtTheirFile) {
  EXPECT_EQ(with("name = \"\""), "c.toml:5:1: vehicle.name: \"\" is refused: the name is empty");
  EXPECT_THAT(with("name = \"a\\u0007\""), AllOf(StartsWith("c.toml:5:1: vehicle.name: "), HasSubstr("UTF-8")));
  EXPECT_THAT(with("name = 3"), StartsWith("c.toml:6:8: vehicle.name: 3 is refused"));
  EXPECT_THAT(with("name = \"a\"\n[[vehicle]]\nname = \"a\""), HasSubstr("c.toml:5:1: two vehicles have one name"));
}

TEST(VehicleTables, WhatIsNoTomlIsRefusedWithItsPlace) {
  EXPECT_THAT(with("length_m = 2\nlength_m = 2"), StartsWith("c.toml:7:"));
  EXPECT_THAT(with("length_m = "), StartsWith("c.toml:6:"));
  EXPECT_THAT(with("name = \"a"), StartsWith("c.toml:6:"));
  EXPECT_THAT(with("name = \"\xff\""), StartsWith("c.toml:6:"));
  EXPECT_THAT(with("length_m = 99999999999999999999"), StartsWith("c.toml:6:"));
  EXPECT_THAT(with("lenght_m = 2"), HasSubstr("did you mean \"length_m\"?"));
  EXPECT_THAT(refusal(std::string("\xff\xfek\0", 4)), StartsWith("c.toml:1:"));
  EXPECT_THAT(refusal("vehicle = " + std::string(100'000, '[')), AllOf(StartsWith("c.toml:1:"), HasSubstr("depth")));
  for (const char* list : {"3", "[3]", "[[]]"})
    EXPECT_THAT(refusal("vehicle = " + std::string(list) + "\n" + kFactors), HasSubstr("array of tables")) << list;
  EXPECT_THAT(refusal("vehicle = []\n" + kFactors), HasSubstr("c.toml:1:11: vehicle is empty"));
  EXPECT_EQ(with("length_m = 2"), "accepted");
}

}  // namespace
}  // namespace fleetproof::vehicle_tables_test
