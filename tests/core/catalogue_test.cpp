#include "core/base/catalogue.hpp"

#include <gtest/gtest.h>

#include <array>

namespace fleetproof::catalogue_test {
namespace {

TEST(NearestName, IsWithinAThirdOfTheLetters) {
  const std::string_view known[] = {"dock", "fork", "a station with a long name"};
  EXPECT_EQ(nearest_name("dok", known), "dock");
  EXPECT_EQ(nearest_name("frok", known), "fork");
  EXPECT_EQ(nearest_name("a statoin with long name", known), "a station with a long name");
  EXPECT_EQ(nearest_name("quay", known), std::nullopt);
  EXPECT_EQ(nearest_name("", known), std::nullopt);
  EXPECT_EQ(nearest_name("xy", std::array<std::string_view, 2>{"a", "ab"}), std::nullopt) << "no letter is right";
  EXPECT_EQ(nearest_name("xb", std::array<std::string_view, 2>{"a", "ab"}), "ab");
}

TEST(NearestName, IsNotLookedForWhereNobodyMistyped) {
  for (const char* number : {"77", "0", "1001"})
    EXPECT_EQ(nearest_name(number, std::array<std::string_view, 3>{"7", "78", "1000"}), std::nullopt);
  const std::string longest(200, 'x'), longer(201, 'x');
  const std::string_view known[] = {longer};
  EXPECT_EQ(nearest_name(longest, known), longer);
  EXPECT_EQ(nearest_name(longer, known), std::nullopt)
      << "longer than names are: to compare millions of letters would take hours";
}

}  // namespace
}  // namespace fleetproof::catalogue_test
