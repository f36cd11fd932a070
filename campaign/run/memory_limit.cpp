#include "campaign/run/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace fleetproof {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // shadow memory takes terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

}  // namespace

std::uint64_t mapped_bytes() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit_memory(std::uint64_t memory_mb, std::uint64_t own_bytes) {
  rlimit memory{};
  if (kSanitized || ::getrlimit(RLIMIT_AS, &memory) != 0) return;
  memory.rlim_cur = memory_mb > 0 ? std::min<rlim_t>(own_bytes + (memory_mb << 20), memory.rlim_max) : memory.rlim_max;
  ::setrlimit(RLIMIT_AS, &memory);
}

}  // namespace fleetproof
