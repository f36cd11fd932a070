// The broker of core/bridges/mqtt behind a real socket, for clients from elsewhere. Listens on a free port of the
// loopback interface and prints it, and then each connection that it closes, with the reason. Ends with its input.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/bridges/mqtt/broker.hpp"

namespace {

std::int64_t now_ns() { return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count(); }

int listening_socket() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(socket, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(socket, 16) != 0) return -1;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  std::printf("port %d\n", ntohs(address.sin_port));
  std::fflush(stdout);
  return socket;
}

class SocketBroker {
 public:
  void serve(int listener) {
    while (true) {
      std::vector<pollfd> waits{{STDIN_FILENO, POLLIN, 0}, {listener, POLLIN, 0}};
      for (const auto& [socket, is_open] : open_) waits.push_back({socket, POLLIN, 0});
      ::poll(waits.data(), waits.size(), 100);
      char byte = 0;
      if (waits[0].revents != 0 && ::read(STDIN_FILENO, &byte, 1) <= 0) return;
      if (waits[1].revents != 0) take(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC));
      for (std::size_t i = 2; i < waits.size(); ++i) {
        if (waits[i].revents != 0) receive(waits[i].fd);
      }
      broker_.tick(now_ns());
      close_ended();
    }
  }

 private:
  void take(int socket) {
    open_[socket] = true;
    broker_.opened(static_cast<std::uint32_t>(socket), now_ns());
  }
  void receive(int socket) {
    std::string bytes(65536, '\0');
    const auto size = ::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size > 0) {
      std::printf("%d ", socket);
      for (const char byte : bytes.substr(0, static_cast<std::size_t>(size)))
        std::printf("%02x", static_cast<unsigned>(static_cast<unsigned char>(byte)));
      std::printf("\n");
      broker_.received(static_cast<std::uint32_t>(socket), {bytes.data(), static_cast<std::size_t>(size)}, now_ns());
    } else {
      broker_.lost(static_cast<std::uint32_t>(socket));
      open_[socket] = false;
    }
  }
  void close_ended() {
    std::erase_if(open_, [](const auto& one) {
      if (!one.second) ::close(one.first);
      return !one.second;
    });
  }

  std::map<int, bool> open_;  // false: to be closed
  fleetproof::mqtt::Broker broker_{{[](std::uint32_t connection, std::string_view bytes, std::string_view) {
                                      (void)!::send(static_cast<int>(connection), bytes.data(), bytes.size(),
                                                    MSG_NOSIGNAL);
                                    },
                                    [this](std::uint32_t connection, std::string_view reason) {
                                      std::printf("closed: %.*s\n", static_cast<int>(reason.size()), reason.data());
                                      std::fflush(stdout);
                                      open_[static_cast<int>(connection)] = false;
                                    }}};
};

}  // namespace

int main() {
  const int listener = listening_socket();
  if (listener < 0) return 2;
  SocketBroker().serve(listener);
}
