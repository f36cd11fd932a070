#include "generators/text/json_value.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "generators/text/json_writer.hpp"

namespace fleetproof::json_value_test {
namespace {

std::string refusal(std::string_view text) {
  try {
    parse_json(text, "f.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(JsonValue, RemembersTheLineOfEveryValue) {
  const auto root = parse_json("{\n \"a\": 1,\n \"b\": [\n  true,\n  2.5\n ], \"c\": \"x\"\n}\n", "f.json");
  ASSERT_EQ(root.items.size(), 3U);
  EXPECT_EQ(root.line, 1U);
  EXPECT_EQ(root.find("a")->line, 2U);
  EXPECT_EQ(root.find("b")->line, 3U);
  EXPECT_EQ(root.find("b")->items[0].line, 4U);
  EXPECT_EQ(root.find("b")->items[1].line, 5U);
  EXPECT_EQ(root.find("c")->line, 6U);
  EXPECT_EQ(root.find("d"), nullptr);
}

TEST(JsonValue, SyntaxErrorsNameLineAndColumn) {
  EXPECT_TRUE(refusal("{\n  \"a\": tru\n}").starts_with("f.json:2:11: not JSON: ")) << refusal("{\n  \"a\": tru\n}");
  EXPECT_TRUE(refusal("[1, 2").starts_with("f.json:1:6: not JSON: ")) << refusal("[1, 2");
  EXPECT_EQ(refusal(""), "f.json: is empty; expected a JSON object");
  EXPECT_TRUE(refusal("\xff{").starts_with("f.json:1: the byte 0xff is none of UTF-8; ")) << refusal("\xff{");
  for (const std::string_view text : {std::string_view("\xff\xfe{"), std::string_view("{\0}\0", 4),
                                      std::string_view("\0{\0}", 4), std::string_view("\xfe\xff\0{", 4)})
    EXPECT_EQ(refusal(text), "f.json: is in UTF-16; save it as UTF-8");
  EXPECT_NE(refusal("[1e999]").find("f.json:1:"), std::string::npos) << refusal("[1e999]");
  EXPECT_NE(refusal("[NaN]").find("f.json:1:2: not JSON: "), std::string::npos) << refusal("[NaN]");
  EXPECT_EQ(refusal(std::string("{}\n\0[", 5)), "f.json:2: has a byte 0, as no text has; save it as UTF-8");
  EXPECT_NE(refusal("{} {}").find("f.json:1:4: not JSON: "), std::string::npos) << refusal("{} {}");
}

TEST(JsonValue, ARepeatedKeyIsRefused) {
  EXPECT_EQ(refusal("{\"a\": 1,\n\"a\": 2}"), "f.json:2: key \"a\" appears twice in one object; keep one");
}

TEST(JsonValue, DeepNestingIsRefusedBeforeItHurts) {
  EXPECT_NE(refusal(std::string(1'000'000, '['))
                .find("nested deeper than 32 levels, deeper than in any file that is read here"),
            std::string::npos);
  EXPECT_EQ(refusal(std::string(32, '[') + std::string(32, ']')), "accepted");
}

TEST(JsonValue, NumbersComeBackToTheBit) {
  Draws draws(7);
  JsonWriter writer;
  std::vector<double> numbers{
      0.0, -0.0, 1.0, 0.1, 1e22, 1e-7, 5e-324, 1.7976931348623157e308, 9007199254740993.0, 123456789012345680.0};
  while (numbers.size() < 5000) {
    const auto number = std::bit_cast<double>(draws.next());
    if (std::isfinite(number)) numbers.push_back(number);
  }
  writer.open_array();
  for (const double number : numbers) writer.value(number);
  writer.close();
  const auto text = writer.take();
  const auto root = parse_json(text, "f.json");
  const auto items = JsonReader(root, "f.json").items();
  ASSERT_EQ(items.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(items[i].number()), std::bit_cast<std::uint64_t>(numbers[i] + 0.0));
}

TEST(JsonValue, WholeNumbersKeepAll64Bits) {
  const auto root = parse_json("[18446744073709551615, -9223372036854775808, 3.5, -1]", "f.json");
  const auto items = JsonReader(root, "f.json").items();
  EXPECT_EQ(items[0].natural(), 18446744073709551615ULL);
  EXPECT_EQ(items[1].integer(), INT64_MIN);
  EXPECT_THROW(items[0].integer(), InputError);
  EXPECT_THROW(items[2].integer(), InputError);
  EXPECT_THROW(items[3].natural(), InputError);
}

}  // namespace
}  // namespace fleetproof::json_value_test
