#include "core/base/outside_text.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

namespace fleetproof::outside_text_test {
namespace {

TEST(OutsideText, StaysIfAllOfItCanBeSeen) {
  for (const char* text :
       {"", "plain", "\xc3\xa9t\xc3\xa9 \xe5\xae\x89\xe5\x85\xa8 \xf0\x9f\x9a\x9a", "back\\slash `$(x)` | <b>"})
    EXPECT_EQ(printable(text), text);
}

TEST(OutsideText, ShowsWhatWouldSteerATerminalOrHide) {
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable(std::string_view("\x1b[31m\0\x7f", 7)), "\\x1b[31m\\x00\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "1m \xc2\x85"),
            "\\u009b1m \\u0085");  // C1
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "evil\xe2\x81\xa9"),
            "\\u202eevil\\u2069");  // direction
  EXPECT_EQ(printable("a\xe2\x80\x8b"
                      "b\xef\xbb\xbf"
                      "c\xc2\xad"),
            "a\\u200bb\\ufeffc\\u00ad");                                      // no width
  EXPECT_EQ(printable("\xe2\x80\xa8"), "\\u2028");                            // line separator
  EXPECT_EQ(printable("\xf3\xa0\x81\x81\xef\xbf\xbf"), "\\u{e0041}\\uffff");  // tags; no character
}

TEST(OutsideText, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xff"
                      "a\xc3"),
            "\\xffa\\xc3");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
}

TEST(OutsideText, IsCutBetweenCharacters) {
  EXPECT_EQ(printable("\xc3\xa9\xc3\xa9\xc3\xa9", 2), "\xc3\xa9\xc3\xa9...");
  EXPECT_EQ(printable("abc", 3), "abc");
  EXPECT_EQ(printable("ab\x1b", 3), "ab...") << "an escape counts with all its characters, and is not cut";
  EXPECT_EQ(in_quotes(std::string(61, 'x')), "\"" + std::string(60, 'x') + "...\"");
  EXPECT_EQ(in_quotes("\xc3\xa9\n"), "\"\xc3\xa9\\n\"");
}

// Every character, twice through the gate: the second pass finds nothing left to do.
TEST(OutsideText, OncePrintableAlwaysPrintable) {
  for (std::uint32_t c = 0; c <= 0x10ffff; ++c) {
    std::string text;
    if (c < 0x80) {
      text = {static_cast<char>(c)};
    } else if (c < 0x800) {
      text = {static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 63))};
    } else if (c < 0x10000) {
      text = {static_cast<char>(0xe0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 63)),
              static_cast<char>(0x80 | (c & 63))};
    } else {
      text = {static_cast<char>(0xf0 | c >> 18), static_cast<char>(0x80 | (c >> 12 & 63)),
              static_cast<char>(0x80 | (c >> 6 & 63)), static_cast<char>(0x80 | (c & 63))};
    }
    const std::string once = printable(text);
    ASSERT_EQ(printable(once), once) << c;
    ASSERT_EQ(is_plain_utf8(text), !(c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0xd800 && c < 0xe000))) << c;
  }
}

TEST(OutsideText, LinesAndJsonKeepTheirLineFeeds) {
  EXPECT_EQ(printable_lines("a\x1b\n\nb\r\n"), "a\\x1b\n\nb\\r\n");
  EXPECT_EQ(printable_json("{\n  \"a\": \"\xc2\x9b\xe2\x80\xae\xf3\xa0\x81\x81\x7f\xc3\xa9\"\n}\n"),
            "{\n  \"a\": \"\\u009b\\u202e\\udb40\\udc41\\u007f\xc3\xa9\"\n}\n");
}

TEST(ShellWord, IsOneWordOfAnySpelling) {
  EXPECT_EQ(shell_word("out/night.db"), "out/night.db");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("my night.db"), "'my night.db'");
  EXPECT_EQ(shell_word("it's.db"), "'it'\\''s.db'");
  EXPECT_EQ(shell_word("-x.db"), "'./-x.db'");
  EXPECT_EQ(shell_word("$(touch x)"), "'$(touch x)'");
}

// The shell itself says what it reads.
TEST(ShellWord, GivesTheShellTheSameBytes) {
  for (const std::string word : {"$(touch x)", "`id`", "a b", "it's \"x\" \\", "\x1b[31m7", "two\nlines'",
                                 "\xc2\x9b"
                                 "0;\xe2\x80\xae",
                                 "\xff\xfe", "*?[a]~!#&;|<>", "caf\xc3\xa9", "\t\\x41'"}) {
    const std::string quoted = shell_word(word);
    EXPECT_EQ(printable(quoted), quoted);
    const std::string command = "bash -c \"$(cat <<'END_OF_WORD'\nprintf %s " + quoted + "\nEND_OF_WORD\n)\"";
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> shell(popen(command.c_str(), "r"), pclose);
    ASSERT_NE(shell, nullptr);
    std::string read;
    for (int c = std::fgetc(shell.get()); c != EOF; c = std::fgetc(shell.get())) read += static_cast<char>(c);
    EXPECT_EQ(read, word) << quoted;
  }
}

}  // namespace
}  // namespace fleetproof::outside_text_test
