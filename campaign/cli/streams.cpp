#include "campaign/cli/streams.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>

namespace fleetproof::cli {
namespace {

// Returns zero, or the error that stopped the write. A pipe with room for PIPE_BUF bytes accepts so many bytes without
// a wait. `patience_ms` therefore holds for every piece of that size.
int write_all(int descriptor, std::string_view text, int patience_ms) {
  while (!text.empty()) {
    pollfd ready{descriptor, POLLOUT, 0};
    const int count = ::poll(&ready, 1, patience_ms);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count == 0 ? EAGAIN : errno;
    const auto written = ::write(descriptor, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

void open_standard_streams() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    // open() takes the lowest free number. Read-only: a write to a closed standard output then fails, and the program
    // reports it.
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) (void)::open("/dev/null", O_RDONLY);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool OutputLost::reader_left() const { return error_ == EPIPE; }

void put_text(std::string_view text) {
  const int error = write_all(STDOUT_FILENO, printable_lines(text), kForever_ms);
  if (error != 0)
    throw OutputLost(error, fmt::format("standard output: cannot be written to its end ({})", std::strerror(error)));
}

void talk_text(std::string_view text, int patience_ms) { steer_terminal(printable_lines(text), patience_ms); }

void steer_terminal(std::string_view text, int patience_ms) { (void)write_all(STDERR_FILENO, text, patience_ms); }

}  // namespace fleetproof::cli
