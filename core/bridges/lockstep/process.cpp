#include "core/bridges/lockstep/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace fleetproof::lockstep {
namespace {

constexpr std::size_t kLongestLine = std::size_t{16} << 20U;  // bytes
constexpr std::size_t kQuoted = 100;                          // bytes of a line
constexpr std::size_t kReadAtOnce = std::size_t{64} << 10U;
constexpr int kNotStarted = 127;

using Pipe = std::array<int, 2>;

Pipe new_pipe() {
  Pipe ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Broken(std::string("no pipe can be made: ") + std::strerror(errno));
  return ends;
}

void close_both(const Pipe& ends) {
  for (const int end : ends) ::close(end);
}

// In the child: only what is allowed after a fork of a process that may have other threads. What the parent has limited
// is lifted as far as it may be: addresses that an interpreter only reserves are no memory.
[[noreturn]] void become(char* const* words, const Pipe& in, const Pipe& out, const Pipe& trouble, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kNotStarted);
  ::setpgid(0, 0);  // so that what it starts can be killed with it
  const int error = ::fcntl(trouble[1], F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  ::dup2(in[0], STDIN_FILENO);
  ::dup2(out[1], STDOUT_FILENO);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  rlimit addresses{};
  if (::getrlimit(RLIMIT_AS, &addresses) == 0) {
    addresses.rlim_cur = addresses.rlim_max;
    ::setrlimit(RLIMIT_AS, &addresses);
  }
  ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGHUP, SIGUSR1}) ::signal(number, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execvp(words[0], words);
  const int why = errno;
  (void)!::write(error, &why, sizeof why);
  ::_exit(kNotStarted);
}

}  // namespace

std::string cited(std::string_view line) {
  return "\"" + std::string(line.substr(0, kQuoted)) + (line.size() > kQuoted ? "...\"" : "\"");
}

Process::Process(std::vector<std::string> words) : room_(kReadAtOnce) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const Pipe in = new_pipe(), out = new_pipe(), trouble = new_pipe();
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become(pointers.data(), in, out, trouble, parent);
  int error = process_ < 0 ? errno : 0;
  ::close(in[0]);
  ::close(out[1]);
  ::close(trouble[1]);
  to_ = in[1];
  from_ = out[0];
  // The end of this pipe says that the program has been started.
  while (error == 0 && ::read(trouble[0], &error, sizeof error) < 0 && errno == EINTR) {
  }
  ::close(trouble[0]);
  if (error == 0) {
    handle_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0));
    return;
  }
  if (process_ > 0) ::waitpid(process_, nullptr, 0);
  close_both({to_, from_});
  throw Broken("cannot be started: " + words.front() + ": " + std::strerror(error));
}

Process::~Process() {
  end();
  close_both({to_, from_});
  if (handle_ >= 0) ::close(handle_);
}

// What a process that is ending has as its exit code stays: a signal that comes later does not change it.
int Process::end() {
  if (process_ <= 0) return status_;
  ::kill(process_, SIGKILL);
  ::kill(-process_, SIGKILL);  // until it is waited for, no other group can have this number
  while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
  return status_;
}

void Process::tell_end() {
  const int status = end();
  if (WIFEXITED(status)) throw Broken("ended with exit code " + std::to_string(WEXITSTATUS(status)));
  if (WTERMSIG(status) == SIGKILL) throw Broken("closed its standard input or output, or was killed");
  throw Broken(std::string("ended with a signal: ") + ::strsignal(WTERMSIG(status)));
}

void Process::send(std::string& line) {
  if (taken_ < bytes_.size())
    throw Broken("sent a line that nothing had asked for: " + cited(std::string_view(bytes_).substr(taken_)));
  line.push_back('\n');
  for (std::string_view rest = line; !rest.empty();) {
    const ssize_t written = ::write(to_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) tell_end();
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

// False: no more comes. A process that it has started may keep the pipe open after its end.
bool Process::read_more() {
  std::array<pollfd, 2> ready{{{from_, POLLIN, 0}, {handle_, POLLIN, 0}}};
  while (::poll(ready.data(), ready.size(), -1) < 0) {
    if (errno != EINTR) return false;
  }
  if (ready[0].revents == 0) return false;
  ssize_t count = 0;
  do {
    count = ::read(from_, room_.data(), room_.size());
  } while (count < 0 && errno == EINTR);
  if (count > 0) bytes_.append(room_.data(), static_cast<std::size_t>(count));
  return count > 0;
}

std::string_view Process::receive() {
  const std::string_view line = receive_or_end();
  if (line.data() == nullptr) tell_end();
  return line;
}

std::string_view Process::receive_or_end() {
  bytes_.erase(0, std::exchange(taken_, 0));
  for (std::size_t seen = 0;;) {
    const auto end_of_line = bytes_.find('\n', seen);
    if (end_of_line != std::string::npos) {
      taken_ = end_of_line + 1;
      return std::string_view(bytes_).substr(0, end_of_line);
    }
    seen = bytes_.size();
    if (seen > kLongestLine) throw Broken("sent more than 16 MB without a line feed: " + cited(bytes_));
    if (read_more()) continue;
    if (!bytes_.empty()) throw Broken("ended in the middle of a line: " + cited(bytes_));
    const int status = end();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    tell_end();
  }
}

}  // namespace fleetproof::lockstep
