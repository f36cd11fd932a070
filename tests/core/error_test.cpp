#include "core/base/error.hpp"

#include <gtest/gtest.h>

namespace fleetproof::error_test {
namespace {

TEST(InputErrorText, IsOnePrintableLine) {
  EXPECT_STREQ(InputError("a\nb.csv:1", "name is \"\x1b[31m\x7f\"").what(), "a\\nb.csv:1: name is \"\\x1b[31m\\x7f\"");
  EXPECT_STREQ(InputError("", "\xc3\xa9").what(), "\xc3\xa9");
}

TEST(InputErrorText, KeepsBeginningAndEndOfWhatIsTooLong) {
  const std::string name(5000, 'x');
  const std::string text = InputError("f.toml:3", "agent is \"" + name + "\"; name another").what();
  EXPECT_LT(text.size(), 1500U);
  EXPECT_TRUE(text.starts_with("f.toml:3: agent is \"xxx"));
  EXPECT_TRUE(text.ends_with("xxx\"; name another"));
  std::string accents;
  for (int i = 0; i < 2000; ++i) accents += "\xc3\xa9";
  for (const auto* where : {"f", "ff"}) {
    const std::string cut = InputError(where, accents).what();
    const auto gap = cut.find(" ... ");
    ASSERT_NE(gap, std::string::npos);
    EXPECT_EQ(cut[gap - 1], '\xa9') << "no sequence is cut in two";
    EXPECT_EQ(cut[gap + 5], '\xc3');
  }
}

}  // namespace
}  // namespace fleetproof::error_test
