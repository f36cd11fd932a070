#include "campaign/workers/forker.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <set>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr int kGrace_ms = 200;  // for a worker that has closed its channel to be dead

struct Request {
  enum class Kind : std::int32_t { Start, Collect } kind = Kind::Start;
  std::int32_t slot = 0;
  pid_t pid = 0;
};
struct Reply {
  pid_t pid = 0;  // negative: an errno
  WorkerDeath death;
};

// A request may carry a descriptor: the worker's end of its channel.
union DescriptorSpace {
  cmsghdr header;
  std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

bool send_request(int control, Request request, int descriptor) {
  iovec content{&request, sizeof request};
  DescriptorSpace space{};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  if (descriptor >= 0) {
    message.msg_control = space.bytes.data();
    message.msg_controllen = space.bytes.size();
    cmsghdr* part = CMSG_FIRSTHDR(&message);
    part->cmsg_level = SOL_SOCKET;
    part->cmsg_type = SCM_RIGHTS;
    part->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(part), &descriptor, sizeof(int));
  }
  ssize_t sent = 0;
  do {
    sent = ::sendmsg(control, &message, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(sizeof request);
}

// -1 if the other end is gone, else the descriptor that came along, or 0.
int receive_request(int control, Request& request) {
  iovec content{&request, sizeof request};
  DescriptorSpace space{};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  message.msg_control = space.bytes.data();
  message.msg_controllen = space.bytes.size();
  ssize_t got = 0;
  do {
    got = ::recvmsg(control, &message, MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  if (got != static_cast<ssize_t>(sizeof request)) return -1;
  int descriptor = 0;
  if (const cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr && part->cmsg_type == SCM_RIGHTS)
    std::memcpy(&descriptor, CMSG_DATA(part), sizeof(int));
  return descriptor;
}

// The loop of the forker's own process.
class ForkerProcess {
 public:
  ForkerProcess(int control, const Forker::Work& work) : control_(control), work_(work) {}

  [[noreturn]] void run() {
    Request request;
    for (int descriptor = 0; (descriptor = receive_request(control_, request)) >= 0;) {
      const Reply reply = request.kind == Request::Kind::Start ? start(request.slot, descriptor) : collect(request.pid);
      if (::send(control_, &reply, sizeof reply, MSG_NOSIGNAL) != static_cast<ssize_t>(sizeof reply)) break;
    }
    for (const pid_t worker : alive_) ::kill(-worker, SIGKILL);
    for (const pid_t worker : alive_) ::waitpid(worker, nullptr, 0);
    ::_exit(0);
  }

 private:
  Reply start(int slot, int descriptor) {
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) {
      ::setpgid(0, 0);  // so that what the agent starts can be killed with it
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent) ::_exit(0);
      ::close(control_);
      work_(slot, Channel(descriptor));
      ::_exit(0);
    }
    const int error = errno;
    ::close(descriptor);
    if (child < 0) return {-error, {}};
    ::setpgid(child, child);  // the child does the same; one of both comes first
    alive_.insert(child);
    return {child, {}};
  }

  Reply collect(pid_t worker) {
    Reply reply{worker, {}};
    rusage use{};
    pid_t ended = 0;
    for (int waited_ms = 0; ended == 0 && waited_ms < kGrace_ms; ++waited_ms) {
      ended = ::wait4(worker, &reply.death.status, WNOHANG, &use);
      if (ended == 0) ::poll(nullptr, 0, 1);
    }
    ::kill(-worker, SIGKILL);
    if (ended == 0) {
      reply.death.had_to_be_killed = true;
      while (::wait4(worker, &reply.death.status, 0, &use) < 0 && errno == EINTR) {
      }
    }
    alive_.erase(worker);
    const auto in_seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
    };
    reply.death.cpu_s = in_seconds(use.ru_utime) + in_seconds(use.ru_stime);
    reply.death.max_memory_kb = use.ru_maxrss;
    return reply;
  }

  int control_;
  const Forker::Work& work_;
  std::set<pid_t> alive_;
};

[[noreturn]] void throw_gone() {
  throw MachineError(
      "the process that starts the workers is gone: somebody killed it, or memory ran out; what was finished is kept, "
      "and "
      "the same command goes on");
}

}  // namespace

Forker::Forker(const Work& work) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw MachineError(fmt::format("no channel to a worker process can be made: {}", std::strerror(errno)));
  std::fflush(nullptr);  // or the workers would print once more what waits in buffers here
  forker_ = ::fork();
  if (forker_ == 0) {
    // It ends when its socket closes, not with a signal: then it can kill what the workers have started.
    ::setpgid(0, 0);  // Ctrl-C in the terminal is for the main process, which ends the others in order
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) ::signal(number, SIG_IGN);
    ::close(ends[0]);
    ForkerProcess(ends[1], work).run();
  }
  const int error = errno;
  ::close(ends[1]);
  control_ = ends[0];
  if (forker_ < 0) {
    ::close(control_);
    throw MachineError(fmt::format("no worker process can be started: {}", std::strerror(error)));
  }
}

Forker::~Forker() {
  ::shutdown(control_, SHUT_RDWR);  // forkers that were made later hold copies of this end
  ::close(control_);
  while (::waitpid(forker_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

Forker::Worker Forker::start(int slot) {
  Channel::Pair ends = Channel::make_pair();
  const std::lock_guard lock(mutex_);
  Reply reply;
  if (!send_request(control_, {Request::Kind::Start, slot, 0}, ends.there.fd()) ||
      ::recv(control_, &reply, sizeof reply, 0) != static_cast<ssize_t>(sizeof reply))
    throw_gone();
  if (reply.pid < 0) throw MachineError(fmt::format("no worker process can be started: {}", std::strerror(-reply.pid)));
  return {reply.pid, std::move(ends.here)};
}

WorkerDeath Forker::collect(pid_t pid) {
  const std::lock_guard lock(mutex_);
  Reply reply;
  if (!send_request(control_, {Request::Kind::Collect, 0, pid}, -1) ||
      ::recv(control_, &reply, sizeof reply, 0) != static_cast<ssize_t>(sizeof reply))
    throw_gone();
  return reply.death;
}

}  // namespace fleetproof
