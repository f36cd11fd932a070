// A library for LD_PRELOAD: the clock on the wall is set while the program runs. FLEETPROOF_TEST_CLOCK says how: "back"
// or "forward" by a year at each reading, or "frozen". The monotonic clock and CPU time stay as they are.
#include <dlfcn.h>
#include <sys/time.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace {

constexpr std::time_t kYear_s = 365 * 86'400;
constexpr std::time_t kStart_s = 1'700'000'000;

std::atomic<int> readings{0};

std::time_t false_time_s() {
  const char* how = std::getenv("FLEETPROOF_TEST_CLOCK");
  const std::time_t years = ++readings;
  if (how != nullptr && std::strcmp(how, "back") == 0) return kStart_s - years * kYear_s;
  if (how != nullptr && std::strcmp(how, "forward") == 0) return kStart_s + years * kYear_s;
  return kStart_s;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE) {
    *time = {false_time_s(), 0};
    return 0;
  }
  using Function = int (*)(clockid_t, timespec*);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
  return real(clock, time);
}

int gettimeofday(timeval* time, void*) noexcept {
  *time = {false_time_s(), 0};
  return 0;
}

std::time_t time(std::time_t* result) noexcept {
  const std::time_t now = false_time_s();
  if (result != nullptr) *result = now;
  return now;
}

}  // extern "C"
