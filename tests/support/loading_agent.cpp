// An agent that is hard to load: its constructor needs 0.4 s of CPU time and lets denormals count as
// zero, as objects built with -ffast-math do. Then it drives like `reckless`.
#include <ctime>
#ifdef __x86_64__
#include <xmmintrin.h>
#endif

#include "core/agents/agent_type.hpp"

namespace {

double cpu_s() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

[[gnu::constructor]] void load_slowly() {
  for (const double begin_s = cpu_s(); cpu_s() < begin_s + 0.4;) {
  }
#ifdef __x86_64__
  _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = fleetproof::agents::kReckless;
  type.name = "loading";
  type.description = "is hard to load, then drives like reckless";
  return &type;
}
