#include "campaign/run/agent_inspection.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <new>

#include "campaign/plan/campaign_agents.hpp"
#include "campaign/run/memory_limit.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof {
namespace {

constexpr std::chrono::seconds kInspectionPatience{60};      // CPU time is limited apart
constexpr std::size_t kSaidKept = 8192, kMostSaid = 65'536;  // bytes of standard error
constexpr int kKillsOfInspection = 3;                        // more, and the object is the reason

// The fields of a program, each with a null byte behind it. The first byte tells whether they are there or an error is.
std::string text_of(const AgentProgram& program) {
  std::string text = "y";
  for (const std::string& field :
       {program.name, program.description, std::to_string(program.flags), program.source.file, program.source.sha256,
        std::to_string(static_cast<int>(program.source.kind))})
    text.append(field).push_back('\0');
  return text;
}

void close_both(const std::array<int, 2>& ends) {
  for (const int end : ends) ::close(end);
}

void write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

[[noreturn]] void load_and_tell(const std::string& path, bool global_symbols, const LimitSetup& limits, int answer,
                                int said) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {0, 1}) ::dup2(nothing, stream);  // what the program prints while it is inspected is dropped
  ::dup2(said, 2);
  const auto cpu_s = static_cast<rlim_t>(std::ceil(limits.loading_s()));
  const rlimit cpu{cpu_s, cpu_s + 1}, core{0, 0};
  ::setrlimit(RLIMIT_CPU, &cpu);
  ::setrlimit(RLIMIT_CORE, &core);
  limit_memory(limits.memory_mb, mapped_bytes());
  try {
    AgentPrograms programs;
    const std::string name = programs.load(path, global_symbols);
    write_all(answer, text_of(programs.program(name, path)));
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemoryExit);
  } catch (const std::exception& error) {
    write_all(answer, std::string("n") + error.what());
  } catch (...) {
    write_all(answer, "n" + path + ": throws an exception while it is loaded");
  }
  ::_exit(0);
}

struct Inspection {
  std::string text;
  std::string said;       // the end of its standard error
  bool came_back = true;  // within the patience
  int status = 0;         // as of waitpid
};

// Appends what can be read at once. False: no more comes.
bool read_some(int fd, std::string& text) {
  std::array<char, 4096> buffer;
  const auto count = ::read(fd, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

// Until the answer is complete. What comes on standard error does not prolong the patience, and a process that the
// program has started may keep that open.
Inspection read_until_end(int answer, int said) {
  Inspection inspection;
  std::array<pollfd, 2> ready{{{answer, POLLIN, 0}, {said, POLLIN, 0}}};
  const auto end = std::chrono::steady_clock::now() + kInspectionPatience;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    const int events = left.count() > 0 ? ::poll(ready.data(), ready.size(), static_cast<int>(left.count())) : 0;
    if (events < 0 && errno == EINTR) continue;
    inspection.came_back = events != 0;
    if (events <= 0) break;
    if (ready[1].revents != 0 && !read_some(said, inspection.said)) ready[1].fd = -1;  // poll leaves it out
    if (inspection.said.size() > kMostSaid) inspection.said.erase(0, inspection.said.size() - kSaidKept);
    if (ready[0].revents != 0 && !read_some(answer, inspection.text)) break;
  }
  while (inspection.said.size() < kMostSaid && read_some(said, inspection.said)) {
  }
  return inspection;
}

// The last line of its standard error that speaks of an error, and begins at the margin: frames of a stack do not.
// Otherwise the last line.
std::string last_words(std::string_view said) {
  std::string_view last;
  for (bool found = false; !found && !said.empty();) {
    const std::size_t begin = said.find_last_of('\n') + 1;  // npos is one before 0
    const std::string_view line = said.substr(begin);
    said = said.substr(0, begin == 0 ? 0 : begin - 1);
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const auto speaks_of = [line](std::string_view word) { return line.find(word) != std::string_view::npos; };
    found = line[0] != ' ' && line[0] != '\t' && (speaks_of("rror") || speaks_of("xception") || speaks_of("panic"));
    if (found || last.empty()) last = line;
  }
  return printable(last.substr(0, last.find_last_not_of(" \t\r") + 1), 200);
}

std::string end_of(const Inspection& inspection, bool is_lockstep) {
  const int status = inspection.status;
  if (!inspection.came_back || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) {
    return is_lockstep ? "it does not answer \"hello\"; end each line with a line feed, and flush standard output"
                       : "it does not come back";
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemoryExit) return "it needs more memory than limits.memory_mb";
  if (!WIFSIGNALED(status)) return "it ends the process that loads it";
  return fmt::format("the process that loads it ends with signal {} ({})", WTERMSIG(status),
                     ::strsignal(WTERMSIG(status)));
}

AgentProgram program_of(std::string_view fields) {
  std::array<std::string, 6> parts;
  for (std::string& part : parts) {
    const auto end = fields.find('\0');
    ensure(end != std::string_view::npos, "an inspection answers with six fields");
    part = fields.substr(0, end);
    fields.remove_prefix(end + 1);
  }
  AgentProgram program;
  program.name = parts[0];
  program.description = parts[1];
  program.flags = static_cast<std::uint32_t>(std::stoul(parts[2]));
  program.source.file = parts[3];
  program.source.sha256 = parts[4];
  program.source.kind = static_cast<ProgramKind>(std::stoi(parts[5]));
  return program;
}

Inspection inspect_once(const std::string& path, bool global_symbols, const LimitSetup& limits) {
  std::array<int, 2> answer{}, said{};
  for (auto* ends : {&answer, &said}) {
    if (::pipe2(ends->data(), O_CLOEXEC) == 0) continue;
    const std::string why = std::strerror(errno);
    if (ends == &said) close_both(answer);
    throw MachineError("no pipe can be made: " + why);
  }
  ::fcntl(said[0], F_SETFL, O_NONBLOCK);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(answer[0]);
    ::close(said[0]);
    load_and_tell(path, global_symbols, limits, answer[1], said[1]);
  }
  const int error = errno;
  ::close(answer[1]);
  ::close(said[1]);
  Inspection inspection = child < 0 ? Inspection() : read_until_end(answer[0], said[0]);
  ::close(answer[0]);
  ::close(said[0]);
  if (child < 0) throw MachineError(fmt::format("no process can be started: {}", std::strerror(error)));
  if (!inspection.came_back) ::kill(child, SIGKILL);
  while (::waitpid(child, &inspection.status, 0) < 0 && errno == EINTR) {
  }
  return inspection;
}

bool was_killed_from_outside(const Inspection& inspection) {
  return inspection.came_back && WIFSIGNALED(inspection.status) && WTERMSIG(inspection.status) == SIGKILL;
}

}  // namespace

AgentProgram inspect_agent(const std::string& path, bool global_symbols, const LimitSetup& limits) {
  Inspection inspection = inspect_once(path, global_symbols, limits);
  for (int again = 0; again < kKillsOfInspection && was_killed_from_outside(inspection); ++again)
    inspection = inspect_once(path, global_symbols, limits);
  const std::string_view text = inspection.text;
  if (text.starts_with('y')) {
    AgentProgram program = program_of(text.substr(1));
    program.source.global_symbols = global_symbols && program.source.kind == ProgramKind::Plugin;
    return program;
  }
  const bool is_lockstep = path.starts_with(kLockstepWord);
  if (!text.starts_with('n')) throw InputError(path, "cannot be loaded: " + end_of(inspection, is_lockstep));
  std::string_view told = text.substr(1);
  const std::string place = printable(path) + ": ";
  if (told.starts_with(place)) told.remove_prefix(place.size());
  const std::string words = is_lockstep ? last_words(inspection.said) : std::string();
  throw InputError(path, words.empty() ? std::string(told) : fmt::format("{}: {}", told, words));
}

}  // namespace fleetproof
