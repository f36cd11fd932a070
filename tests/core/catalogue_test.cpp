#include "core/base/catalogue.hpp"

#include <gtest/gtest.h>

namespace fleetproof::catalogue_test {
namespace {

TEST(NearestName, IsWithinAThirdOfTheLetters) {
  const std::string_view known[] = {"dock", "fork", "a station with a long name"};
  EXPECT_EQ(nearest_name("dok", known), "dock");
  EXPECT_EQ(nearest_name("frok", known), "fork");
  EXPECT_EQ(nearest_name("a statoin with long name", known), "a station with a long name");
  EXPECT_EQ(nearest_name("quay", known), std::nullopt);
  EXPECT_EQ(nearest_name("", known), std::nullopt);
}

TEST(NearestName, IsNotLookedForWhereNobodyMistyped) {
  const std::string longest(200, 'x'), longer(201, 'x');
  const std::string_view known[] = {longer};
  EXPECT_EQ(nearest_name(longest, known), longer);
  EXPECT_EQ(nearest_name(longer, known), std::nullopt)
      << "longer than names are: to compare millions of letters would take hours";
}

}  // namespace
}  // namespace fleetproof::catalogue_test
