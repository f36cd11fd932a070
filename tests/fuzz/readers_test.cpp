// Every reader before thousands of damaged files: what `tests/fuzz/run` does for hours, for seconds and the same each
// time.
#include "readers.hpp"

#include <gtest/gtest.h>

#include "../generators/damage.hpp"
#include "core/base/error.hpp"
#include "generators/text/text_file.hpp"
#include "verdict.hpp"

namespace fleetproof::fuzz::readers_test {

void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }

namespace {

constexpr std::size_t kFilesPerReader = 3000, kBytesPerReader = 24'000'000;

class EveryReader : public testing::TestWithParam<Reader> {};

INSTANTIATE_TEST_SUITE_P(All, EveryReader, testing::ValuesIn(readers().begin(), readers().end()), [](const auto& test) {
  std::string name(test.param.name);
  std::erase(name, '-');
  return name;
});

TEST_P(EveryReader, AcceptsItsSeeds) {
  for (const auto& seed : GetParam().seeds())
    EXPECT_TRUE(GetParam().accepts(seed, Depth::WrittenToo)) << seed.substr(0, 200);
}

TEST_P(EveryReader, ReadsOrRefusesEveryDamagedFile) {
  const auto& reader = GetParam();
  const auto seeds = reader.seeds();
  Draws draws(11);
  std::size_t accepted = 0, bytes = 0, files = 0;
  for (; files < kFilesPerReader && bytes < kBytesPerReader; ++files) {
    auto text = seeds[files % seeds.size()];
    for (std::uint32_t k = 1 + draws.below(2); k > 0; --k) {
      if (draws.below(8) == 0)
        text.insert(independent::draw_place(draws, text),
                    reader.words[draws.below(static_cast<std::uint32_t>(reader.words.size()))]);
      text = draws.below(2) == 0 ? independent::damaged(draws, text, reader.spice) : independent::mangled(draws, text);
    }
    bytes += text.size();
    try {
      accepted += reader.accepts(text, Depth::WrittenToo) ? 1 : 0;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "file " << files << ": " << error.what() << "\n" << in_quotes(text);
    }
  }
  EXPECT_GT(accepted, 0U) << "no damage was light enough to be judged by more than a refusal";
  EXPECT_LT(accepted, files);
}

// The judges themselves: what they are there to notice they notice.
TEST(Verdict, NoticesMessagesThatCannotBeShown) {
  EXPECT_NO_THROW(require_sentence("f.csv:1: a sentence", "f.csv"));
  EXPECT_THROW(require_sentence("a sentence", "f.csv"), std::logic_error);
  EXPECT_THROW(require_sentence("f.csv:1: a \x1b[31m sentence", "f.csv"), std::logic_error);
  EXPECT_THROW(require_sentence("f.csv:1: " + std::string(5000, 'x'), "f.csv"), std::logic_error);
  EXPECT_THROW(accepted([]() -> int { throw EngineError("damage"); }, "f.csv"), EngineError);
  EXPECT_EQ(accepted([]() -> int { throw InputError("f.csv", "refused"); }, "f.csv"), std::nullopt);
}

TEST(Verdict, NoticesLayoutsThatCannotBeDrivenOn) {
  Layout layout;
  layout.stations = {{"a", Vec2(0.0, 0.0), Purpose::Routing}, {"b", Vec2(0.0, 0.0), Purpose::Routing}};
  layout.segments = {{"ab", StationId{0U}, StationId{1U}, true, {}}};
  EXPECT_THROW(require_sound(layout, {}, "f.csv"), std::logic_error) << "no length";
  layout.stations[1].position_m.x() = 1.0;
  EXPECT_NO_THROW(require_sound(layout, {}, "f.csv"));
  layout.segments.clear();
  EXPECT_NO_THROW(require_sound(layout, {}, "f.json")) << "one may stand on it";
  EXPECT_THROW(require_sound(layout, {"m.csv: another file"}, "f.csv"), std::logic_error);
}

}  // namespace
}  // namespace fleetproof::fuzz::readers_test
