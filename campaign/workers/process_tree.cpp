#include "campaign/workers/process_tree.hpp"

#include <dirent.h>
#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace fleetproof {
namespace {

// The entries of a folder of /proc whose names are numbers: processes, or threads of one.
std::vector<pid_t> numbers_in_folder(const std::string& path) {
  std::vector<pid_t> numbers;
  DIR* folder = ::opendir(path.c_str());
  if (folder == nullptr) return numbers;
  while (const dirent* entry = ::readdir(folder)) {
    const std::string_view name = entry->d_name;
    pid_t number = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), number).ec == std::errc{}) numbers.push_back(number);
  }
  ::closedir(folder);
  return numbers;
}

// What stands in a stat file behind the name of the program, which is in brackets and may hold anything: state, parent
// and so on. Empty: there is no such process or thread.
std::vector<std::string> fields_of(const std::string& stat_file) {
  std::ifstream file(stat_file);
  std::string line;
  std::getline(file, line);
  const auto end_of_name = line.rfind(')');
  std::vector<std::string> fields;
  if (end_of_name == std::string::npos) return fields;
  std::istringstream rest(line.substr(end_of_name + 1));
  for (std::string field; rest >> field;) fields.push_back(field);
  return fields;
}

// Places among these fields; proc(5) counts from the process number, which is its field 1.
enum : std::size_t {
  kState = 0,
  kParent = 1,
  kSession = 3,
  kUserOfWaited = 13,
  kSystemOfWaited = 14,
  kResidentPages = 21
};

std::vector<std::string> fields_of_process(pid_t process) { return fields_of(fmt::format("/proc/{}/stat", process)); }

std::uint64_t number_at(const std::vector<std::string>& fields, std::size_t place) {
  std::uint64_t number = 0;
  if (place < fields.size()) std::from_chars(fields[place].data(), fields[place].data() + fields[place].size(), number);
  return number;
}

// Kernels may be built without the lists of children.
bool has_lists_of_children() {
  static const bool has = std::ifstream(fmt::format("/proc/self/task/{}/children", ::getpid())).good();
  return has;
}

void add_listed_children(pid_t process, std::vector<pid_t>& children) {
  const std::string tasks = fmt::format("/proc/{}/task", process);
  for (const pid_t thread : numbers_in_folder(tasks)) {
    std::ifstream list(fmt::format("{}/{}/children", tasks, thread));
    for (pid_t child = 0; list >> child;) children.push_back(child);
  }
}

void add_children_among_all(const std::vector<pid_t>& parents, std::vector<pid_t>& children) {
  for (const pid_t process : numbers_in_folder("/proc")) {
    const auto parent = static_cast<pid_t>(number_at(fields_of_process(process), kParent));
    if (std::ranges::find(parents, parent) != parents.end()) children.push_back(process);
  }
}

std::optional<double> clock_of(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return std::nullopt;
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

double of_waited_s(const std::vector<std::string>& fields) {
  static const auto ticks_per_s = static_cast<double>(::sysconf(_SC_CLK_TCK));
  return static_cast<double>(number_at(fields, kUserOfWaited) + number_at(fields, kSystemOfWaited)) / ticks_per_s;
}

bool can_run(pid_t process) {
  const std::string tasks = fmt::format("/proc/{}/task", process);
  return std::ranges::any_of(numbers_in_folder(tasks), [&](pid_t thread) {
    const auto fields = fields_of(fmt::format("{}/{}/stat", tasks, thread));
    return !fields.empty() && fields[kState] == "R";
  });
}

}  // namespace

double own_cpu_s(pid_t process) { return clock_of(process).value_or(0.0); }

char process_state(pid_t process) {
  const auto fields = fields_of_process(process);
  return fields.empty() ? 'X' : fields[kState].front();
}

std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  if (has_lists_of_children()) {
    add_listed_children(process, children);
  } else {
    add_children_among_all({process}, children);
  }
  return children;
}

std::vector<pid_t> descendants_of(pid_t process) {
  std::vector<pid_t> found, parents{process};
  while (!parents.empty()) {
    std::vector<pid_t> children;
    if (has_lists_of_children()) {
      for (const pid_t parent : parents) add_listed_children(parent, children);
    } else {
      add_children_among_all(parents, children);
    }
    found.insert(found.end(), children.begin(), children.end());
    parents = std::move(children);
  }
  return found;
}

std::vector<pid_t> processes_of_session(pid_t session) {
  std::vector<pid_t> found;
  for (const pid_t process : numbers_in_folder("/proc")) {
    const auto fields = fields_of_process(process);
    const bool is_of_it = static_cast<pid_t>(number_at(fields, kSession)) == session;
    if (is_of_it && fields[kState] != "Z" && fields[kState] != "X") found.push_back(process);
  }
  return found;
}

TreeUse use_of_tree(pid_t process) {
  static const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  TreeUse use;
  const auto own_s = clock_of(process);
  use.is_there = own_s.has_value();
  const std::vector<pid_t> below = descendants_of(process);
  use.own_s = own_s.value_or(0.0);
  use.below_s = of_waited_s(fields_of_process(process));
  for (const pid_t other : below) {
    const auto fields = fields_of_process(other);
    use.below_s += clock_of(other).value_or(0.0) + of_waited_s(fields);
    use.resident_bytes_below += number_at(fields, kResidentPages) * page_bytes;
  }
  return use;
}

bool can_run_in_tree(pid_t process) {
  return can_run(process) || std::ranges::any_of(descendants_of(process), can_run);
}

}  // namespace fleetproof
