#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fleetproof {

// One end of a stream socket between two processes. It carries frames: length and hash (8 bytes each, little-endian),
// then the bytes. Threads: one at a time.
class Channel {
 public:
  Channel() = default;
  explicit Channel(int fd) : fd_(fd) {}  // takes the descriptor
  Channel(Channel&& other) noexcept;
  Channel& operator=(Channel&& other) noexcept;
  ~Channel() { close(); }

  // False if the other end is gone. Waits until the other end has taken all of it.
  bool send(std::string_view bytes);
  // Waits for nothing: what the other end does not take at once leaves while this end waits for its next frame.
  void post(std::string_view bytes);

  enum class Wait : std::uint8_t { Arrived, NotYet, Gone };
  // Waits for the next frame, which is then in `received()`. Gone: the other end is closed, or sent what is no frame.
  Wait wait(std::chrono::milliseconds patience);
  std::string received();

  int fd() const { return fd_; }
  void close();

  struct Pair;
  static Pair make_pair();  // throws MachineError

 private:
  Wait frame_in_buffer() const;
  void send_posted();
  bool is_readable_within(std::chrono::milliseconds patience);
  void set_patience(std::chrono::milliseconds patience);

  int fd_ = -1;
  std::string buffer_, posted_;            // received, and not sent yet
  std::chrono::milliseconds patience_{0};  // that the socket has
};

struct Channel::Pair {
  Channel here, there;
};

}  // namespace fleetproof
