#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/base/outside_text.hpp"

// Standard output carries data, standard error carries talk. Only streams.cpp writes to them, and no character that
// steers a terminal gets through it: text from outside is made printable here (core/base/outside_text.hpp).
namespace fleetproof::cli {

// Call this first in main. A standard stream that is closed is opened on /dev/null, so that no file of ours gets its
// number; a write to standard output then fails. A signal for a broken pipe or a file size limit becomes a failed
// write.
void open_standard_streams();

// Standard output could not take all data, as on a full disk.
class OutputLost : public std::runtime_error {
 public:
  OutputLost(int error, const std::string& what) : std::runtime_error(what), error_(error) {}
  bool reader_left() const;  // a closed pipe, as of `fleetproof ... | head`: nobody needs to be told

 private:
  int error_;
};

// Writes a whole text with its line feeds to standard output, at once. Throws OutputLost.
void put_text(std::string_view text);

// How long talk waits for a reader that does not read. After that the rest of the text is dropped: a full pipe or a
// terminal that was halted stops no campaign.
inline constexpr int kPatience_ms = 1000, kNoPatience_ms = 0, kForever_ms = -1;

// Writes to standard error what a person may want to know. Goes on if it cannot be written.
void talk_text(std::string_view text, int patience_ms = kPatience_ms);

// The same with control characters: the one way for a sequence of ours to get to the terminal.
void steer_terminal(std::string_view text, int patience_ms = kPatience_ms);

// A text argument becomes one printable line; other arguments stay.
template <class T>
auto gated(const T& argument) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return printable(argument);
  } else {
    return argument;
  }
}

template <class... Arguments>
std::string gated_format(fmt::string_view format, const Arguments&... arguments) {
  return fmt::vformat(format, fmt::make_format_args(arguments...));
}

// put_text() and talk_text() with arguments, each of which is gated.
template <class... Arguments>
void put(fmt::format_string<const Arguments&...> format, const Arguments&... arguments) {
  put_text(gated_format(format, gated(arguments)...));
}

template <class... Arguments>
void talk(fmt::format_string<const Arguments&...> format, const Arguments&... arguments) {
  talk_text(gated_format(format, gated(arguments)...));
}

}  // namespace fleetproof::cli
