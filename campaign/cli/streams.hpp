#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/base/outside_text.hpp"

// Standard output carries data, standard error carries messages for people. Only streams.cpp writes to them. It makes
// text from outside printable (core/base/outside_text.hpp), so that no such text can control a terminal.
namespace fleetproof::cli {

// Call this first in main. If a standard stream is closed, it is opened on /dev/null, so that no file of ours gets its
// number. A write to a standard output that was closed fails. A signal for a broken pipe or a file size limit becomes a
// failed write.
void open_standard_streams();

// Standard output could not take all data, for example on a full disk.
class OutputLost : public std::runtime_error {
 public:
  OutputLost(int error, const std::string& what) : std::runtime_error(what), error_(error) {}
  bool reader_left() const;  // a closed pipe, as in `fleetproof ... | head`: no error message is needed

 private:
  int error_;
};

// Writes a whole text with its line feeds to standard output. Throws OutputLost.
void put_text(std::string_view text);

// How long a message waits for a reader that does not read. After that time the rest of the text is dropped, so that a
// full pipe or a halted terminal stops no campaign.
inline constexpr int kPatience_ms = 1000, kNoPatience_ms = 0, kForever_ms = -1;

// Writes a message for people to standard error. If the text cannot be written, the program continues.
void talk_text(std::string_view text, int patience_ms = kPatience_ms);

// The same with control characters, and without taking memory. Only this function sends escape sequences to the
// terminal.
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

// put_text() and talk_text() with arguments. Each argument is made printable.
template <class... Arguments>
void put(fmt::format_string<const Arguments&...> format, const Arguments&... arguments) {
  put_text(gated_format(format, gated(arguments)...));
}

template <class... Arguments>
void talk(fmt::format_string<const Arguments&...> format, const Arguments&... arguments) {
  talk_text(gated_format(format, gated(arguments)...));
}

}  // namespace fleetproof::cli
