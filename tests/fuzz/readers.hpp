#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

// Every reader of files from outside, in the form that libFuzzer and the test of damaged files call.
namespace fleetproof::fuzz {

// How far an accepted input is checked: it passes the validator only, or it is also written and read again, which costs
// more than reading.
enum class Depth { Judged, WrittenToo };

struct Reader {
  std::string_view name;
  // Whether the bytes are accepted; if not, the reader threw an InputError. This function throws if the reader fails:
  // by another exception, by a message that cannot be printed, or by accepting an input that its validator refuses or
  // that changes when it is written and read again.
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
