#include "campaign/workers/channel.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/byte_text.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kHeader = 16;
constexpr std::uint64_t kLongestFrame = std::uint64_t{1} << 30;

struct Header {
  std::uint64_t length = 0, hash = 0;
};

Header header_of(std::string_view buffer) {
  ByteSource source(buffer.substr(0, kHeader), "a frame");
  return {source.u64(), source.u64()};
}

std::string framed(std::string_view bytes) {
  ByteSink header;
  header.u64(bytes.size());
  header.u64(name_hash(bytes));
  std::string frame = header.take();
  frame += bytes;
  return frame;
}

}  // namespace

Channel::Channel(Channel&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      buffer_(std::exchange(other.buffer_, {})),
      posted_(std::exchange(other.posted_, {})),
      patience_(other.patience_) {}

Channel& Channel::operator=(Channel&& other) noexcept {
  if (this != &other) {
    close();
    fd_ = std::exchange(other.fd_, -1);
    buffer_ = std::exchange(other.buffer_, {});
    posted_ = std::exchange(other.posted_, {});
    patience_ = other.patience_;
  }
  return *this;
}

void Channel::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  buffer_.clear();
  posted_.clear();
}

bool Channel::send(std::string_view bytes) {
  const std::string frame = framed(bytes);
  for (std::string_view rest = frame; !rest.empty();) {
    const auto sent = ::send(fd_, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

void Channel::post(std::string_view bytes) {
  posted_ += framed(bytes);
  send_posted();
}

// If the other end is gone, what it has said before may still be read.
void Channel::send_posted() {
  while (!posted_.empty()) {
    const auto sent = ::send(fd_, posted_.data(), posted_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno == EAGAIN) return;
    posted_.erase(0, sent <= 0 ? posted_.size() : static_cast<std::size_t>(sent));
  }
}

Channel::Wait Channel::frame_in_buffer() const {
  if (buffer_.size() < kHeader) return Wait::NotYet;
  const auto [length, hash] = header_of(buffer_);
  if (length > kLongestFrame) return Wait::Gone;
  if (buffer_.size() < kHeader + length) return Wait::NotYet;
  return name_hash(std::string_view(buffer_).substr(kHeader, length)) == hash ? Wait::Arrived : Wait::Gone;
}

Channel::Wait Channel::wait(std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  Wait state = frame_in_buffer();
  while (state == Wait::NotYet) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (!posted_.empty() && !is_readable_within(std::max(left, left.zero()))) {
      if (left <= left.zero()) return Wait::NotYet;
      continue;
    }
    set_patience(std::clamp(left, std::chrono::milliseconds(1), patience));
    std::array<char, 65'536> chunk;
    const auto got = ::recv(fd_, chunk.data(), chunk.size(), left <= left.zero() ? MSG_DONTWAIT : 0);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) return Wait::NotYet;
    if (got <= 0) return Wait::Gone;
    buffer_.append(chunk.data(), static_cast<std::size_t>(got));
    state = frame_in_buffer();
  }
  return state;
}

// Sends meanwhile what is posted.
bool Channel::is_readable_within(std::chrono::milliseconds patience) {
  pollfd ready{fd_, POLLIN | POLLOUT, 0};
  if (::poll(&ready, 1, static_cast<int>(patience.count())) <= 0) return false;
  if ((ready.revents & POLLOUT) != 0) send_posted();
  return (ready.revents & ~POLLOUT) != 0;
}

// The kernel waits in `recv` itself, which is one call for each frame instead of two.
void Channel::set_patience(std::chrono::milliseconds patience) {
  if (patience == patience_) return;
  patience_ = patience;
  const timeval time{patience.count() / 1000, (patience.count() % 1000) * 1000};
  ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
}

std::string Channel::received() {
  ensure(frame_in_buffer() == Wait::Arrived, "a frame is taken after it has arrived");
  const std::uint64_t length = header_of(buffer_).length;
  std::string bytes = buffer_.substr(kHeader, length);
  buffer_.erase(0, kHeader + length);
  return bytes;
}

Channel::Pair Channel::make_pair() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw MachineError(fmt::format("no channel to a worker process can be made: {}", std::strerror(errno)));
  return {Channel(ends[0]), Channel(ends[1])};
}

}  // namespace fleetproof
