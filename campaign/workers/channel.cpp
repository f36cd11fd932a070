#include "campaign/workers/channel.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

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

}  // namespace

Channel::Channel(Channel&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), buffer_(std::exchange(other.buffer_, {})) {}

Channel& Channel::operator=(Channel&& other) noexcept {
  if (this != &other) {
    close();
    fd_ = std::exchange(other.fd_, -1);
    buffer_ = std::exchange(other.buffer_, {});
  }
  return *this;
}

void Channel::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  buffer_.clear();
}

bool Channel::send(std::string_view bytes) {
  ByteSink header;
  header.u64(bytes.size());
  header.u64(name_hash(bytes));
  std::string frame = header.take();
  frame += bytes;
  for (std::string_view rest = frame; !rest.empty();) {
    const auto sent = ::send(fd_, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
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
    pollfd ready{fd_, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(0, left.count())));
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) return Wait::NotYet;
    std::array<char, 65'536> chunk;
    const auto got = ::recv(fd_, chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got <= 0) return Wait::Gone;
    buffer_.append(chunk.data(), static_cast<std::size_t>(got));
    state = frame_in_buffer();
  }
  return state;
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
