#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

namespace fleetproof {

// An enumeration that files and pages name has one table of words: a constexpr function name_of(value) that is a
// switch without a default. A value without a word then does not compile (-Wswitch). What stands here goes the other
// way, from the words to the values, so that no second list of the values can miss one.

// What name_of returns for a number that is no value.
inline constexpr const char* kNoWord = "?";

template <class Enum>
concept HasWords = std::is_enum_v<Enum> && requires(Enum value) {
  std::string_view(name_of(value));
};

namespace words_detail {
// The underlying numbers are small: 0 .. 255 are all that an enumeration of this project uses.
inline constexpr int kNumbers = 256;

template <HasWords Enum>
constexpr bool is_value(int number) {
  return std::string_view(name_of(static_cast<Enum>(number))) != kNoWord;
}

template <HasWords Enum>
consteval std::size_t count() {
  std::size_t values = 0;
  for (int number = 0; number < kNumbers; ++number) values += is_value<Enum>(number) ? 1 : 0;
  return values;
}
}  // namespace words_detail

// All values, in the order of their numbers.
template <HasWords Enum>
inline constexpr auto kValuesOf = [] {
  std::array<Enum, words_detail::count<Enum>()> values{};
  std::size_t next = 0;
  for (int number = 0; number < words_detail::kNumbers; ++number) {
    if (words_detail::is_value<Enum>(number)) values[next++] = static_cast<Enum>(number);
  }
  return values;
}();

// Their words, in the same order.
template <HasWords Enum>
inline constexpr auto kWordsOf = [] {
  std::array<std::string_view, kValuesOf<Enum>.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = name_of(kValuesOf<Enum>[i]);
  return words;
}();

// The value that a word names; none if there is no such word.
template <HasWords Enum>
constexpr std::optional<Enum> value_of(std::string_view word) {
  for (const Enum value : kValuesOf<Enum>) {
    if (word == name_of(value)) return value;
  }
  return std::nullopt;
}

}  // namespace fleetproof
