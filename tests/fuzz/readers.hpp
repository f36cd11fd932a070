#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

// Every reader of files that come from elsewhere, as libFuzzer and the test of damaged files drive it.
namespace fleetproof::fuzz {

// How far an accepted input is followed: it passes the validator, or is written and read again besides, which costs
// more than reading it.
enum class Depth { Judged, WrittenToo };

struct Reader {
  std::string_view name;
  // Whether the bytes are accepted; if not, an InputError said why. Throws, whatever it is, where the reader fails:
  // with any other exception, with a message nobody could print, by accepting what its validator refuses, or what is
  // not the same again after writing and reading.
  bool (*accepts)(std::string_view bytes, Depth depth);
  // Files that are accepted, to begin with.
  std::vector<std::string> (*seeds)();
  std::string_view spice;                   // characters that mean something in the format
  std::span<const std::string_view> words;  // and words
};

std::span<const Reader> readers();

// The reader of this name; ends the program if there is none.
const Reader& reader(std::string_view name);

}  // namespace fleetproof::fuzz
