#include "core/base/words.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/scenario/scenario.hpp"

namespace fleetproof::words_test {
namespace {

enum class Colour : std::uint8_t { Red = 1, Blue = 4 };
constexpr const char* name_of(Colour colour) {
  switch (colour) {
    case Colour::Red:
      return "red";
    case Colour::Blue:
      return "blue";
  }
  return kNoWord;
}

TEST(Words, ValuesAndWordsComeFromTheOneTable) {
  static_assert(kValuesOf<Colour>.size() == 2);
  EXPECT_EQ(kValuesOf<Colour>[1], Colour::Blue);
  EXPECT_EQ(kWordsOf<Colour>[0], "red");
  EXPECT_EQ(value_of<Colour>("blue"), Colour::Blue);
  EXPECT_FALSE(value_of<Colour>("green"));
  EXPECT_FALSE(value_of<Colour>(kNoWord));
}

template <class Enum>
void expect_round_trip() {
  EXPECT_GE(kValuesOf<Enum>.size(), 2U);
  std::set<std::string_view> words;
  for (const Enum value : kValuesOf<Enum>) {
    EXPECT_TRUE(words.insert(name_of(value)).second) << name_of(value) << " names two values";
    EXPECT_EQ(value_of<Enum>(name_of(value)), value);
  }
}

TEST(Words, OfAScenarioAreDifferentAndComeBack) {
  expect_round_trip<Fault::Kind>();
  expect_round_trip<RadioSetup::DelayModel>();
  expect_round_trip<OutageSetup::Model>();
  expect_round_trip<OutageSetup::Scope>();
  expect_round_trip<ScriptedCall::Action>();
  expect_round_trip<Purpose>();
}

}  // namespace
}  // namespace fleetproof::words_test
