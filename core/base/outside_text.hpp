#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace fleetproof {

// Text from outside: names of campaigns, layouts, agents, stations and files, and messages of agents. It may hold
// anything. Every place where such a text reaches a terminal, a page or a command line passes it through a function of
// this file. Threads: any number.

inline constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();

// `text` as one line that shows all of itself. Control characters (also C1), characters that change the direction of
// writing or that nobody sees, line separators and bytes that are no UTF-8 become \n, \t, \r, \x1b, \u202e or
// \u{e0041}. All else stays. If the line would be longer than `most_characters`, the rest becomes "...".
std::string printable(std::string_view text, std::size_t most_characters = kAnyLength);

// The same for a text of several lines: line feeds stay.
std::string printable_lines(std::string_view text);

// A JSON text with the same characters written as \u escapes, which JSON reads as the characters themselves. Line feeds
// stay. Requires: `json` is valid JSON in UTF-8.
std::string printable_json(std::string_view json);

// Whether `text` is UTF-8 without control characters: what a name in an input file must be.
bool is_plain_utf8(std::string_view text);

// A value as an error quotes it: printable, in double quotes, at most 60 characters.
std::string in_quotes(std::string_view value);

// `word` as one word of a command line that a person copies into a shell (bash, zsh, ksh): plain words stay, others
// stand in single quotes. A word with characters that cannot be printed becomes $'...'. A word that begins with "-" is
// taken for a file and gets "./" in front, so that no program reads it as an option.
std::string shell_word(std::string_view word);

}  // namespace fleetproof
