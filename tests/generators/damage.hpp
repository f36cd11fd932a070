#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"

// What every importer must withstand: changed, cut and damaged files. The importer reads the file or refuses it with an
// InputError, and does nothing else.
namespace fleetproof::independent {

// What an importer makes of a text.
struct Import {
  Layout layout;
  std::vector<std::string> warnings;
};

template <class Parse, class Choice>
Import import_by(Parse parse, const std::string& text, const std::string& source, const Choice& choice) {
  Import result;
  result.layout = parse(text, source, result.warnings, choice);
  return result;
}

// The text with one thing in it changed.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// The message with which `parse` refuses the text, or "accepted".
template <class Parse>
std::string refusal(Parse parse, const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

template <class Parse>
void bear_cuts(Parse parse, const std::string& text, std::size_t cuts) {
  for (std::size_t i = 0; i < cuts; ++i)
    EXPECT_NO_THROW(refusal(parse, text.substr(0, text.size() * i / cuts))) << "cut " << i;
}

inline std::size_t draw_place(Draws& draws, const std::string& text) {
  return draws.below(static_cast<std::uint32_t>(text.size() + 1));
}

// One to four characters changed, added or flipped in a bit, or a few of them gone.
inline std::string damaged(Draws& draws, std::string text, std::string_view spice) {
  for (std::uint32_t k = 1 + draws.below(4); k > 0; --k) {
    const auto at = draw_place(draws, text);
    const char c = spice[draws.below(static_cast<std::uint32_t>(spice.size()))];
    switch (at == text.size() ? 0 : draws.below(4)) {
      case 0:
        text.insert(at, 1, c);
        break;
      case 1:
        text[at] = c;
        break;
      case 2:
        text[at] = static_cast<char>(text[at] ^ (1 << draws.below(8)));
        break;
      default:
        text.erase(at, 1 + draws.below(40));
        break;
    }
  }
  return text;
}

template <class Parse>
void bear_damage(Parse parse, const std::string& original, int rounds, std::string_view spice) {
  Draws draws(7);
  for (int round = 0; round < rounds; ++round) {
    const auto text = damaged(draws, original, spice);
    EXPECT_NO_THROW(refusal(parse, text)) << "round " << round;
  }
}

// The line at a place, with its end.
inline std::pair<std::size_t, std::size_t> line_around(const std::string& text, std::size_t at) {
  const auto before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const auto begin = before == std::string::npos ? 0 : before + 1,
             end = std::min(text.find('\n', at), text.size() - 1) + 1;
  return {begin, end - begin};
}

// Another number in the place of one.
inline void change_number(Draws& draws, std::string& text) {
  constexpr std::string_view kNumbers[] = {"0",      "-1",    "1e308",       "-1e308",
                                           "1e-320", "1e400", "99999999999", "9223372036854775808",
                                           "nan",    "-0.0",  "1000000000"};
  const auto begin = text.find_first_of("0123456789", draw_place(draws, text));
  if (begin == std::string::npos) return;
  const auto end = std::min(text.find_first_not_of("0123456789.eE+-", begin), text.size());
  text.replace(begin, end - begin, kNumbers[draws.below(std::size(kNumbers))]);
}

// Damage to a whole file: it is cut, or joined with a piece of itself; lines are lost and repeated; deep nesting, long
// lines, foreign bytes, impossible numbers. The file grows by at most a few thousand characters.
inline std::string mangled(Draws& draws, std::string text) {
  const auto at = draw_place(draws, text);
  switch (draws.below(9)) {
    case 0:
      return text.substr(0, at);
    case 1:
      return text.substr(0, at) + text.substr(draw_place(draws, text));
    case 2: {
      const auto [begin, length] = line_around(text, at);
      const auto line = text.substr(begin, length);
      for (std::uint32_t k = 1 + draws.below(20); k > 0; --k) text.insert(begin, line);
      return text;
    }
    case 3: {
      const auto [begin, length] = line_around(text, at);
      return text.erase(begin, length);
    }
    case 4:
      return text.insert(at, std::string(1 + draws.below(2000), "[{(<-&\"' ."[draws.below(10)]));
    case 5:
      return text.insert(at, std::string(1 + draws.below(4), '\0'));
    case 6: {
      constexpr std::string_view kForeign[] = {"\xc0\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80",
                                               "\xe2\x82", "\xef\xbb\xbf", "\x1b[31m",
                                               "\x7f",     "\xe2\x80\xae"};
      return text.insert(at, kForeign[draws.below(std::size(kForeign))]);
    }
    case 7:
      return text.insert(at, text.substr(draw_place(draws, text), draws.below(400)));
    default:
      for (std::uint32_t k = 1 + draws.below(3); k > 0; --k) change_number(draws, text);
      return text;
  }
}

}  // namespace fleetproof::independent
