#include "campaign/workers/left_behind.hpp"

#include <fcntl.h>
#include <locale.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <climits>
#include <clocale>
#include <csignal>
#include <cstdlib>
#include <locale>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/workers/system_calls.hpp"

namespace fleetproof {
namespace {

// Each of these looks at one kind of thing. `set_back` is cheap if nothing has changed, and false if what has changed
// cannot be set back.

class Locale {
 public:
  bool set_back() const {
    if (::uselocale(nullptr) != of_thread_) ::uselocale(of_thread_);
    if (std::locale() != global_) std::locale::global(global_);
    if (name_ == std::setlocale(LC_ALL, nullptr)) return true;
    return std::setlocale(LC_ALL, name_.c_str()) != nullptr;
  }

 private:
  std::string name_ = std::setlocale(LC_ALL, nullptr);
  std::locale global_;
  locale_t of_thread_ = ::uselocale(nullptr);
};

// The words of the system about this process: one look instead of one for each signal.
class Status {
 public:
  Status() { (void)look(); }
  ~Status() { ::close(file_); }
  Status(const Status&) = delete;
  Status& operator=(const Status&) = delete;

  // False: somebody has closed the file.
  bool look() {
    std::array<char, 4096> text;
    const ssize_t size = ::pread(file_, text.data(), text.size(), 0);
    const std::string_view lines(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    const auto signals = lines.find("\nSigBlk:"), end = lines.find("\nCapInh:");
    const auto threads = number_after("\nThreads:\t", 10, lines), umask = number_after("\nUmask:\t", 8, lines);
    if (!threads || !umask || signals == lines.npos || end == lines.npos || signals > end) return false;
    threads_ = *threads;
    umask_ = static_cast<mode_t>(*umask);
    signals_.assign(lines.substr(signals, end - signals));
    return true;
  }
  int threads() const { return threads_; }
  mode_t umask() const { return umask_; }
  const std::string& signals() const { return signals_; }  // blocked, ignored, caught

 private:
  static std::optional<int> number_after(std::string_view word, int base, std::string_view lines) {
    const auto at = lines.find(word);
    int number = 0;
    if (at == lines.npos) return std::nullopt;
    std::from_chars(lines.data() + at + word.size(), lines.data() + lines.size(), number, base);
    return number;
  }

  int file_ = ::open("/proc/self/status", O_RDONLY | O_CLOEXEC);
  int threads_ = 0;
  mode_t umask_ = 0;
  std::string signals_;
};

class Signals {
 public:
  explicit Signals(const Status& status) : signals_(status.signals()) {
    ::pthread_sigmask(SIG_BLOCK, nullptr, &mask_);
    ::sigaltstack(nullptr, &stack_);
    for (int number = 1; number < kSignals; ++number) {
      ::sigaction(number, nullptr, &handlers_[static_cast<std::size_t>(number)]);
      if (handler_of(number) != SIG_DFL && handler_of(number) != SIG_IGN) caught_.push_back(number);
    }
  }
  bool set_back(const Status& status) const {
    stack_t stack{};
    ::sigaltstack(nullptr, &stack);
    if (stack.ss_sp != stack_.ss_sp || stack.ss_size != stack_.ss_size || stack.ss_flags != stack_.ss_flags)
      ::sigaltstack(&stack_, nullptr);
    const bool same = status.signals() == signals_ && std::ranges::all_of(caught_, [&](int number) {
                        struct sigaction now {};
                        ::sigaction(number, nullptr, &now);
                        return now.sa_handler == handler_of(number);
                      });
    if (same) return true;
    ::pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
    for (int number = 1; number < kSignals; ++number)
      ::sigaction(number, &handlers_[static_cast<std::size_t>(number)], nullptr);
    return true;
  }

 private:
  static constexpr int kSignals = 65;
  sighandler_t handler_of(int number) const { return handlers_[static_cast<std::size_t>(number)].sa_handler; }

  std::string signals_;
  sigset_t mask_{};
  stack_t stack_{};
  std::array<struct sigaction, kSignals> handlers_{};
  std::vector<int> caught_;
};

class Folder {
 public:
  explicit Folder(const Status& status) : umask_(status.umask()) {}
  bool set_back(const Status& status) const {
    if (status.umask() != umask_) ::umask(umask_);
    const std::string now = path();
    return now == path_ || (!path_.empty() && ::chdir(path_.c_str()) == 0);
  }

 private:
  static std::string path() {
    std::array<char, PATH_MAX> text;
    return ::getcwd(text.data(), text.size()) == nullptr ? "" : text.data();
  }
  std::string path_ = path();
  mode_t umask_;
};

// The soft limit of addresses is set before each run.
class Limits {
 public:
  Limits() : limits_(now()) {}
  bool set_back() const {
    bool all = true;
    const auto limits = now();
    for (std::size_t i = 0; i < limits.size(); ++i) {
      const bool is_soft_same = i == RLIMIT_AS || limits[i].rlim_cur == limits_[i].rlim_cur;
      if (limits[i].rlim_max != limits_[i].rlim_max || !is_soft_same)
        all = ::setrlimit(static_cast<__rlimit_resource>(i), &limits_[i]) == 0 && all;
    }
    return all;
  }

 private:
  static std::array<rlimit, RLIM_NLIMITS> now() {
    std::array<rlimit, RLIM_NLIMITS> limits{};
    for (std::size_t i = 0; i < limits.size(); ++i) ::getrlimit(static_cast<__rlimit_resource>(i), &limits[i]);
    return limits;
  }
  std::array<rlimit, RLIM_NLIMITS> limits_;
};

class Timers {
 public:
  Timers() : others_(count_of_others()) {}
  ~Timers() { ::close(file_); }
  Timers(const Timers&) = delete;
  Timers& operator=(const Timers&) = delete;

  bool set_back() const {
    for (const auto which : {ITIMER_REAL, ITIMER_VIRTUAL, ITIMER_PROF}) {
      itimerval now{};
      ::getitimer(which, &now);
      const itimerval none{};
      if (now.it_value.tv_sec != 0 || now.it_value.tv_usec != 0) ::setitimer(which, &none, nullptr);
    }
    return count_of_others() == others_;
  }

 private:
  ssize_t count_of_others() const {  // of timer_create; their bytes in the list stand for them
    std::array<char, 512> text;
    return ::pread(file_, text.data(), text.size(), 0);
  }
  int file_ = ::open("/proc/self/timers", O_RDONLY | O_CLOEXEC);
  ssize_t others_;
};

class Environment {
 public:
  Environment() : entries_(now()) {}
  bool set_back() const {
    std::size_t same = 0;
    if (environ != nullptr) {
      while (same < entries_.size() && environ[same] != nullptr && entries_[same] == environ[same]) ++same;
    }
    const bool has_more = environ != nullptr && same == entries_.size() && environ[same] != nullptr;
    if (same == entries_.size() && !has_more) return true;
    ::clearenv();
    for (const std::string& entry : entries_) {
      const auto mark = entry.find('=');
      if (mark != entry.npos) ::setenv(entry.substr(0, mark).c_str(), entry.c_str() + mark + 1, 1);
    }
    return true;
  }

 private:
  static std::vector<std::string> now() {
    std::vector<std::string> entries;
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) entries.emplace_back(*entry);
    return entries;
  }
  std::vector<std::string> entries_;
};

// Descriptors and threads cannot be taken away from the software that may still use them.
struct Holdings {
  int threads = 0, first_free = 0;
  off_t descriptors = 0;  // not every kernel tells their number; the first that is free moves in any case

  static Holdings now(const Status& status, int descriptors_file) {
    Holdings holdings;
    holdings.threads = status.threads();
    holdings.first_free = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
    if (holdings.first_free >= 0) ::close(holdings.first_free);
    struct stat folder {};
    if (::fstat(descriptors_file, &folder) == 0) holdings.descriptors = folder.st_size;
    return holdings;
  }
  bool fit_into(const Holdings& first) const {
    return threads <= first.threads && first_free == first.first_free && descriptors == first.descriptors;
  }
};

}  // namespace

struct LeftBehind::State {
  SystemCalls calls;
  bool has_called = true;
  Status status;
  Locale locale;
  Signals signals{status};
  Folder folder{status};
  Limits limits;
  Timers timers;
  Environment environment;
  int descriptors = ::open("/proc/self/fd", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  std::optional<Holdings> after_first_run;

  State() = default;
  ~State() { ::close(descriptors); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

LeftBehind::LeftBehind() : state_(std::make_unique<State>()) {}
LeftBehind::~LeftBehind() = default;

void LeftBehind::run_begins() { state_->calls.begin(); }

bool LeftBehind::has_called_yet() const { return state_->calls.any_yet(); }

void LeftBehind::run_ended() { state_->has_called = state_->calls.any(); }

bool LeftBehind::set_back() {
  State& was = *state_;
  bool all = was.locale.set_back();
  all = was.environment.set_back() && all;
  // Other threads may call at any time.
  const bool is_alone = was.after_first_run && was.after_first_run->threads == 1;
  if (!was.has_called && is_alone) return all;
  if (!was.status.look()) return false;
  all = was.signals.set_back(was.status) && all;
  all = was.folder.set_back(was.status) && all;
  all = was.limits.set_back() && all;
  all = was.timers.set_back() && all;
  const Holdings now = Holdings::now(was.status, was.descriptors);
  if (!was.after_first_run) was.after_first_run = now;
  return all && now.fit_into(*was.after_first_run);
}

}  // namespace fleetproof
