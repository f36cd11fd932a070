#pragma once

#include <cfenv>
#include <cstdint>

namespace fleetproof {

// How this thread computes with floating-point numbers: rounding, which exceptions end the program, whether denormals
// count as zero, and the precision of x87. Flags of what happened are no part of it. The engine computes with the state
// that a program begins with; code from outside may leave another one behind.

#if defined(__x86_64__)

// Round to nearest, no exception ends the program, denormals as they are.
inline bool computes_as_engine() {
  constexpr std::uint32_t kMxcsr = 0x1f80, kFlags = 0x3f;
  std::uint32_t mxcsr = 0;
  asm volatile("stmxcsr %0" : "=m"(mxcsr));
  return (mxcsr & ~kFlags) == kMxcsr;
}

// The same, and the long precision of x87, with which the engine computes nothing.
inline bool has_engine_processor_state() {
  constexpr std::uint16_t kX87 = 0x037f;
  std::uint16_t x87 = 0;
  asm volatile("fnstcw %0" : "=m"(x87));
  return x87 == kX87 && computes_as_engine();
}

// The pending exceptions of x87 go first: one that is no longer masked would end the program at the next instruction.
// A string instruction that runs backward is no rounding, but as wrong.
inline void set_engine_processor_state() {
  constexpr std::uint32_t kMxcsr = 0x1f80;
  constexpr std::uint16_t kX87 = 0x037f;
  asm volatile("fnclex; fldcw %0; ldmxcsr %1; cld" : : "m"(kX87), "m"(kMxcsr) : "memory", "cc");
}

#elif defined(__aarch64__)

inline bool computes_as_engine() {
  std::uint64_t fpcr = 0;
  asm volatile("mrs %0, fpcr" : "=r"(fpcr));
  return fpcr == 0;
}

inline bool has_engine_processor_state() { return computes_as_engine(); }

inline void set_engine_processor_state() { asm volatile("msr fpcr, xzr" : : : "memory"); }

#else
#error "how this processor rounds is not known"
#endif

// While it lives, the thread computes as the engine does. Then it has the state again that it had before.
class EngineProcessorState {
 public:
  EngineProcessorState() {
    if (computes_as_engine()) [[likely]]
      return;
    is_other_ = true;
    std::fegetenv(&other_);
    set_engine_processor_state();
  }
  ~EngineProcessorState() {
    if (is_other_) [[unlikely]]
      std::fesetenv(&other_);
  }
  EngineProcessorState(const EngineProcessorState&) = delete;
  EngineProcessorState& operator=(const EngineProcessorState&) = delete;

 private:
  bool is_other_ = false;
  std::fenv_t other_;
};

}  // namespace fleetproof
