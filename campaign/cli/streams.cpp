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

// Zero, or the error that stopped it. A pipe with room for PIPE_BUF bytes takes as many without keeping the writer
// waiting, so `patience_ms` holds for every such piece.
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
    // open() takes the lowest free number. Read-only: what is written to a closed standard output is lost, and said to
    // be.
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
