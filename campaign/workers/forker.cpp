#include "campaign/workers/forker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

#include "campaign/workers/process_tree.hpp"
#include "core/base/error.hpp"

namespace fleetproof {

struct ForkRequest {
  enum class Kind : std::int32_t { Start, Collect } kind = Kind::Start;
  std::int32_t slot = 0;
  pid_t pid = 0;
};
struct ForkReply {
  pid_t pid = 0;  // negative: an errno
  WorkerDeath death;
};

namespace {

constexpr int kGrace_ms = 200;  // for a worker that has closed its channel to be dead
constexpr int kLookEvery_ms = 100;
constexpr int kMostLooks = 600;            // at a forker that does not answer; then it is killed
constexpr int kMostLooksAtSession = 1000;  // at what is left of a forker that was killed
constexpr int kPatienceAtEnd_ms = 10'000;
constexpr unsigned long kAskPersonality = 0xffffffff;
// What an agent may write to one file, its log included: an agent that prints without end must not fill the disk.
constexpr rlim_t kLargestFile = rlim_t{64} << 20;

constexpr std::string_view kForkerWord = "fork-workers";  // then control, logs, descriptors, file, words
constexpr int kForkerWords = 6;
constexpr std::string_view kProgramName = "fleetproof";  // as other programs list the process

// A request may carry a descriptor: the worker's end of its channel.
union DescriptorSpace {
  cmsghdr header;
  std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

bool send_request(int control, ForkRequest request, int descriptor) {
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
int receive_request(int control, ForkRequest& request) {
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

void set_close_on_exec(int descriptor, bool on) {
  const int flags = ::fcntl(descriptor, F_GETFD);
  if (flags >= 0) ::fcntl(descriptor, F_SETFD, on ? flags | FD_CLOEXEC : flags & ~FD_CLOEXEC);
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::string text_of(const std::vector<int>& numbers) { return fmt::format("{}", fmt::join(numbers, ",")); }

std::vector<int> numbers_in(std::string_view text) {
  std::vector<int> numbers;
  while (!text.empty()) {
    const auto comma = std::min(text.find(','), text.size());
    int& number = numbers.emplace_back(-1);
    std::from_chars(text.data(), text.data() + comma, number);
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return numbers;
}

// ---- the forker's own process

[[noreturn]] void become_worker(const WorkerProgram& program, int slot, int channel) {
  const auto place = static_cast<std::size_t>(slot);
  const int log = place < program.logs.size() ? program.logs[place] : -1;
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(log >= 0 ? log : nothing, stream);
  const rlimit core{0, 0}, file{kLargestFile, kLargestFile};
  ::setrlimit(RLIMIT_CORE, &core);
  ::setrlimit(RLIMIT_FSIZE, &file);
  const int persona = ::personality(kAskPersonality);
  if (persona >= 0) ::personality(static_cast<unsigned long>(persona) & ~static_cast<unsigned long>(ADDR_NO_RANDOMIZE));
  set_close_on_exec(channel, false);
  for (const int descriptor : program.descriptors) set_close_on_exec(descriptor, false);
  std::vector<std::string> words{std::string(kProgramName)};
  words.insert(words.end(), program.words.begin(), program.words.end());
  words.push_back(std::to_string(channel));
  words.push_back(std::to_string(slot));
  ::execv(program.file.c_str(), pointers_to(words).data());
  ::_exit(kCannotStartExit);
}

class ForkerProcess {
 public:
  ForkerProcess(int control, const WorkerProgram& program) : control_(control), program_(program) {}

  [[noreturn]] void run() {
    ForkRequest request;
    for (int descriptor = 0; (descriptor = receive_request(control_, request)) >= 0;) {
      const ForkReply reply =
          request.kind == ForkRequest::Kind::Start ? start(request.slot, descriptor) : collect(request.pid);
      if (::send(control_, &reply, sizeof reply, MSG_NOSIGNAL) != static_cast<ssize_t>(sizeof reply)) break;
    }
    for (const pid_t worker : alive_) {
      ::kill(-worker, SIGKILL);
      ::kill(worker, SIGKILL);  // it may have left its group
    }
    for (const pid_t worker : alive_) ::waitpid(worker, nullptr, 0);
    alive_.clear();
    end_strays();
    ::_exit(0);
  }

 private:
  ForkReply start(int slot, int channel) {
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) {
      ::setpgid(0, 0);  // so that what the agent starts can be killed with it
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent) ::_exit(0);
      become_worker(program_, slot, channel);
    }
    const int error = errno;
    ::close(channel);
    if (child < 0) return {-error, {}};
    ::setpgid(child, child);  // the child does the same; one of both comes first
    alive_.insert(child);
    return {child, {}};
  }

  ForkReply collect(pid_t worker) {
    ForkReply reply{worker, {}};
    rusage use{};
    pid_t ended = 0;
    for (int waited_ms = 0; ended == 0 && waited_ms < kGrace_ms; ++waited_ms) {
      ended = ::wait4(worker, &reply.death.status, WNOHANG, &use);
      if (ended == 0) ::poll(nullptr, 0, 1);
    }
    ::kill(-worker, SIGKILL);
    if (ended == 0) {
      reply.death.had_to_be_killed = true;
      ::kill(worker, SIGKILL);  // it may have left its group
      while (::wait4(worker, &reply.death.status, 0, &use) < 0 && errno == EINTR) {
      }
    }
    alive_.erase(worker);
    end_strays();
    const auto in_seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
    };
    reply.death.cpu_s = in_seconds(use.ru_utime) + in_seconds(use.ru_stime);
    reply.death.max_memory_kb = use.ru_maxrss;
    return reply;
  }

  // Whatever a dead worker has started is a child of this process by now, in whichever group or session it is.
  void end_strays() const {
    for (bool found = true; found;) {
      found = false;
      for (const pid_t child : children_of(::getpid())) {
        if (alive_.contains(child)) continue;
        found = true;
        for (const pid_t other : descendants_of(child)) ::kill(other, SIGKILL);
        ::kill(child, SIGKILL);
        while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
        }
      }
    }
  }

  int control_;
  const WorkerProgram& program_;
  std::set<pid_t> alive_;
};

// ---- the process that made it

// Ends all processes of the session of a forker that was killed. Its workers die with it, but not at once, and may
// start others until then: so it looks until none is left.
void end_session(pid_t forker) {
  for (int looks = 0; looks < kMostLooksAtSession; ++looks) {
    const std::vector<pid_t> left = processes_of_session(forker);
    if (left.empty()) return;
    for (const pid_t process : left) ::kill(process, SIGKILL);
    ::poll(nullptr, 0, 1);
  }
}

[[noreturn]] void throw_not_started(int error) {
  throw MachineError(fmt::format("no worker process can be started: {}", std::strerror(error)));
}

}  // namespace

Forker::Forker(WorkerProgram program) : program_(std::move(program)) { start_process(); }

// After the fork only what a process with other threads may still do.
void Forker::start_process() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw MachineError(fmt::format("no channel to a worker process can be made: {}", std::strerror(errno)));
  std::vector<std::string> words{std::string(kProgramName), std::string(kForkerWord),      std::to_string(ends[1]),
                                 text_of(program_.logs),    text_of(program_.descriptors), program_.file};
  words.insert(words.end(), program_.words.begin(), program_.words.end());
  const std::vector<char*> arguments = pointers_to(words);
  const pid_t forker = ::fork();
  if (forker == 0) {
    // Ctrl-C in the terminal is for the main process, which ends the others in order. If this process is killed, its
    // session still names what its workers have started, in whichever groups.
    ::setsid();
    ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);  // whatever the main process has open
    set_close_on_exec(ends[1], false);
    for (const auto* list : {&program_.logs, &program_.descriptors}) {
      for (const int descriptor : *list) set_close_on_exec(descriptor, false);
    }
    ::execv(program_.file.c_str(), arguments.data());
    ::_exit(kCannotStartExit);
  }
  const int error = errno;
  ::close(ends[1]);
  if (forker < 0) {
    ::close(ends[0]);
    throw_not_started(error);
  }
  control_ = ends[0];
  forker_ = forker;
  ++number_;
}

Forker::~Forker() { end_process(); }

// It ends by itself, and with it the workers, unless somebody has stopped it.
void Forker::end_process() {
  if (control_ < 0) return;
  ::shutdown(control_, SHUT_RDWR);  // forkers that were made later hold copies of this end
  ::close(control_);
  control_ = -1;
  int status = 0;
  for (int waited_ms = 0; ::waitpid(forker_, &status, WNOHANG) == 0; ++waited_ms) {
    ::kill(forker_, waited_ms < kPatienceAtEnd_ms ? SIGCONT : SIGKILL);
    ::poll(nullptr, 0, 1);
  }
  if (WIFSIGNALED(status)) end_session(forker_);  // then it has not ended what its workers have started
}

// False: it is dead.
bool Forker::ask(const ForkRequest& request, int descriptor, ForkReply& reply) {
  if (!send_request(control_, request, descriptor)) return false;
  pollfd answer{control_, POLLIN, 0};
  for (int looks = 0; ::poll(&answer, 1, kLookEvery_ms) <= 0;) {
    const char state = process_state(forker_);
    if (state == 'T' || state == 't') ::kill(forker_, SIGCONT);
    if (state != 'R' && ++looks == kMostLooks) ::kill(forker_, SIGKILL);
  }
  return ::recv(control_, &reply, sizeof reply, 0) == static_cast<ssize_t>(sizeof reply);
}

Forker::Worker Forker::start(int slot) {
  Channel::Pair ends = Channel::make_pair();
  const std::lock_guard lock(mutex_);
  ForkReply reply;
  const ForkRequest request{ForkRequest::Kind::Start, slot, 0};
  if (!ask(request, ends.there.fd(), reply)) {
    end_process();
    start_process();
    if (!ask(request, ends.there.fd(), reply))
      throw MachineError(fmt::format("the process that starts the workers cannot be started: {}", program_.file));
  }
  if (reply.pid < 0) throw_not_started(-reply.pid);
  return {reply.pid, std::move(ends.here), number_};
}

WorkerDeath Forker::collect(const Worker& worker) {
  const std::lock_guard lock(mutex_);
  ForkReply reply;
  if (worker.forker == number_ && ask({ForkRequest::Kind::Collect, 0, worker.pid}, -1, reply)) return reply.death;
  ::kill(-worker.pid, SIGKILL);
  reply.death.with_forker = true;
  return reply.death;
}

namespace {

[[noreturn]] void serve_forker(int control, const std::vector<std::string>& words) {
  // It ends when its socket closes, not with a signal: then it can kill what the workers have started.
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) ::signal(number, SIG_IGN);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  ::signal(SIGCHLD, SIG_DFL);  // ignored, as a caller may have left it, it would hide how workers end
  WorkerProgram program;
  program.logs = numbers_in(words[3]);
  program.descriptors = numbers_in(words[4]);
  program.file = words[5];
  program.words.assign(words.begin() + kForkerWords, words.end());
  set_close_on_exec(control, true);
  for (const auto* list : {&program.logs, &program.descriptors}) {
    for (const int descriptor : *list) set_close_on_exec(descriptor, true);
  }
  ForkerProcess(control, program).run();
}

}  // namespace

void serve_forker_if_called(int argc, const char* const* argv) {
  if (argc < kForkerWords || argv[1] != kForkerWord) return;
  const std::vector<int> control = numbers_in(argv[2]);
  if (control.size() == 1 && ::fcntl(control.front(), F_GETFD) >= 0) serve_forker(control.front(), {argv, argv + argc});
}

}  // namespace fleetproof
