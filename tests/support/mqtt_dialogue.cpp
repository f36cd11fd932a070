// Our broker behind a loopback socket, or our client in front of one: for clients and brokers of others.
//   mqtt_dialogue serve RECORDING          prints its port; "cut" on its input closes all connections
//   mqtt_dialogue client RECORDING PORT    a kept session of "agv" with a will; on its input: "publish QOS RETAIN
//                                             TOPIC PAYLOAD" and "cut"; prints the messages that it gets
// Both end with their input. A line of the recording: what, connection, milliseconds since the start, and bytes as hex
// digits or a reason. `hear`: bytes from the other side; `say`: ours; `open`, `lost`: connections, by the other side;
// `close`: by us; `publish`, `tick`: what our client is told.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/bridges/mqtt/broker.hpp"
#include "core/bridges/mqtt/client.hpp"

namespace fleetproof::mqtt {
namespace {

[[noreturn]] void fail(const char* what) {
  std::perror(what);
  std::exit(2);
}

std::int64_t now_ns() {
  static const auto begin = std::chrono::steady_clock::now();
  return std::chrono::nanoseconds(std::chrono::steady_clock::now() - begin).count();
}

class Recording {
 public:
  explicit Recording(const char* file) : out_(file) {}

  void note(std::string_view what, std::uint32_t connection, std::int64_t at_ns, std::string_view text) {
    out_ << what << " " << connection << " " << at_ns / 1'000'000 << " " << text << std::endl;
  }
  void bytes(std::string_view what, std::uint32_t connection, std::int64_t at_ns, std::string_view bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string hex;
    for (const char c : bytes) {
      const auto byte = static_cast<unsigned char>(c);
      hex += kDigits[byte >> 4U];
      hex += kDigits[byte & 15U];
    }
    note(what, connection, at_ns, hex);
  }

 private:
  std::ofstream out_;
};

void send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the next read says that it is gone
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

// None: the other side is gone.
std::optional<std::string> read_some(int file) {
  std::array<char, 65536> part{};
  const auto got = ::read(file, part.data(), part.size());
  if (got <= 0) return std::nullopt;
  return std::string(part.data(), static_cast<std::size_t>(got));
}

// The whole lines of what came, taken from it.
std::vector<std::string> take_lines(std::string& text) {
  std::vector<std::string> lines;
  for (auto end = text.find('\n'); end != text.npos; end = text.find('\n')) {
    lines.push_back(text.substr(0, end));
    text.erase(0, end + 1);
  }
  return lines;
}

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int waiting_ms(std::optional<std::int64_t> deadline_ns) {
  if (!deadline_ns) return -1;
  return static_cast<int>(std::max<std::int64_t>(0, (*deadline_ns - now_ns()) / 1'000'000 + 1));
}

class Server {
 public:
  explicit Server(const char* recording) : recording_(recording) {
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 16) != 0)
      fail("listen");
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    std::cout << ntohs(address.sin_port) << std::endl;
  }

  void serve() {
    for (std::string typed; true;) {
      std::vector<pollfd> files = {{STDIN_FILENO, POLLIN, 0}, {listener_, POLLIN, 0}};
      std::vector<std::uint32_t> connections;
      for (const auto& [connection, socket] : sockets_) {
        files.push_back({socket, POLLIN, 0});
        connections.push_back(connection);
      }
      ::poll(files.data(), files.size(), waiting_ms(broker_.deadline_ns()));
      if (files[0].revents != 0) {
        const auto more = read_some(STDIN_FILENO);
        if (!more) return;
        typed += *more;
        for (const auto& line : take_lines(typed)) {
          if (line == "cut") broker_.cut_all();
        }
      }
      for (std::size_t i = 0; i < connections.size(); ++i) {
        if (files[i + 2].revents != 0 && sockets_.contains(connections[i])) hear(connections[i]);
      }
      if (files[1].revents != 0) accept();
      broker_.tick(now_ns());
    }
  }

 private:
  void accept() {
    const int socket = ::accept(listener_, nullptr, nullptr);
    if (socket < 0) return;
    sockets_[++last_] = socket;
    recording_.note("open", last_, now_ns(), "");
    broker_.opened(last_, now_ns());
  }
  void hear(std::uint32_t connection) {
    const auto bytes = read_some(sockets_[connection]);
    if (bytes) {
      recording_.bytes("hear", connection, now_ns(), *bytes);
      return broker_.received(connection, *bytes, now_ns());
    }
    recording_.note("lost", connection, now_ns(), "");
    ::close(sockets_[connection]);
    sockets_.erase(connection);
    broker_.lost(connection);
  }
  void say(std::uint32_t connection, std::string_view bytes) {
    recording_.bytes("say", connection, now_ns(), bytes);
    if (sockets_.contains(connection)) send_all(sockets_[connection], bytes);
  }
  void close(std::uint32_t connection, std::string_view reason) {
    recording_.note("close", connection, now_ns(), reason);
    ::close(sockets_[connection]);
    sockets_.erase(connection);
  }

  Recording recording_;
  int listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
  std::map<std::uint32_t, int> sockets_;
  std::uint32_t last_ = 0;
  Broker broker_{
      {[this](std::uint32_t connection, std::string_view bytes, std::string_view) { say(connection, bytes); },
       [this](std::uint32_t connection, std::string_view reason) { close(connection, reason); }}};
};

class Caller {
 public:
  Caller(const char* recording, const char* port)
      : recording_(recording), port_(static_cast<std::uint16_t>(std::atoi(port))) {}

  void call() {
    connect();
    for (std::string typed; true;) {
      std::array<pollfd, 2> files = {pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{socket_, POLLIN, 0}};
      const int waiting = socket_ < 0 ? 200 : waiting_ms(client_.deadline_ns());
      ::poll(files.data(), socket_ < 0 ? 1 : 2, waiting);
      if (files[0].revents != 0) {
        const auto more = read_some(STDIN_FILENO);
        if (!more) return;
        typed += *more;
        for (const auto& line : take_lines(typed)) obey(line);
      }
      if (socket_ >= 0 && files[1].revents != 0) hear();
      if (socket_ < 0 && waiting == 200) connect();
      if (socket_ >= 0 && client_.deadline_ns() && *client_.deadline_ns() <= now_ns()) {
        recording_.note("tick", last_, now_ns(), "");
        client_.tick(now_ns());
      }
      for (const Publish& one : client_.take_messages()) std::cout << one.topic << " " << one.payload << std::endl;
    }
  }

 private:
  void connect() {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    const sockaddr_in address = loopback(port_);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return hang_up();
    recording_.note("open", ++last_, now_ns(), "");
    client_.opened(now_ns());
  }
  void hang_up() {
    ::close(socket_);
    socket_ = -1;
  }
  void hear() {
    const auto bytes = read_some(socket_);
    if (bytes) {
      recording_.bytes("hear", last_, now_ns(), *bytes);
      return client_.received(*bytes, now_ns());
    }
    recording_.note("lost", last_, now_ns(), "");
    hang_up();
    client_.lost();
  }
  void obey(const std::string& line) {
    std::istringstream words(line);
    std::string word;
    Publish publish;
    int qos = 0;
    words >> word;
    if (word == "cut" && socket_ >= 0) {
      recording_.note("lost", last_, now_ns(), "");
      hang_up();
      client_.lost();
    }
    if (word != "publish" || !(words >> qos >> publish.retain >> publish.topic >> publish.payload)) return;
    publish.qos = static_cast<std::uint8_t>(qos);
    recording_.note("publish", last_, now_ns(), line.substr(word.size() + 1));
    client_.publish(publish, {}, now_ns());
  }
  void say(std::string_view bytes) {
    recording_.bytes("say", last_, now_ns(), bytes);
    send_all(socket_, bytes);
  }
  void close(std::string_view reason) {
    recording_.note("close", last_, now_ns(), reason);
    hang_up();
  }

  Recording recording_;
  std::uint16_t port_;
  int socket_ = -1;
  std::uint32_t last_ = 0;
  Client client_{{[this](std::string_view bytes, std::string_view) { say(bytes); },
                  [this](std::string_view reason) { close(reason); }},
                 {.name = "agv",
                  .is_clean = false,
                  .keep_alive_s = 1,
                  .will = Will{"c/agv", "CONNECTIONBROKEN", 1, true},
                  .filters = {{"order/#", 1}, {"actions", 0}}}};
};

}  // namespace
}  // namespace fleetproof::mqtt

int main(int count, char** words) {
  const std::string_view mode = count > 1 ? words[1] : "";
  if (mode == "serve" && count == 3) {
    fleetproof::mqtt::Server(words[2]).serve();
  } else if (mode == "client" && count == 4) {
    fleetproof::mqtt::Caller(words[2], words[3]).call();
  } else {
    std::fprintf(stderr, "usage: mqtt_dialogue serve RECORDING | client RECORDING PORT\n");
    return 2;
  }
  return 0;
}
