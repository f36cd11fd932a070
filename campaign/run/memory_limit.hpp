#pragma once

#include <cstdint>

namespace fleetproof {

// With this exit code a process says that it needed more.
inline constexpr int kOutOfMemoryExit = 96;

// The addresses that this process has mapped, in bytes.
std::uint64_t mapped_bytes();

// From now on this process may map so many megabytes beyond `own_bytes`; 0: no limit. A lower limit can be lifted
// again. Under a sanitizer there is no limit.
void limit_memory(std::uint64_t memory_mb, std::uint64_t own_bytes);

}  // namespace fleetproof
