#include "core/engine/processor_state.hpp"

namespace fleetproof {

#if defined(__x86_64__)

// The pending exceptions of x87 go first: one that is no longer masked would end the program at the next instruction.
// A string instruction that runs backward is no rounding, but as wrong.
void set_engine_processor_state() {
  constexpr std::uint32_t kMxcsr = 0x1f80;
  constexpr std::uint16_t kX87 = 0x037f;
  asm volatile("fnclex; fldcw %0; ldmxcsr %1; cld" : : "m"(kX87), "m"(kMxcsr) : "memory", "cc");
}

#else

void set_engine_processor_state() { asm volatile("msr fpcr, xzr" : : : "memory"); }

#endif

}  // namespace fleetproof
